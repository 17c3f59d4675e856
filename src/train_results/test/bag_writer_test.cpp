#include "train_results/bag_writer.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sys/resource.h>
#include <train_brake_msgs/BrakePressures.h>
#include <train_brake_msgs/EnergyLedger.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace train_results {
namespace {

namespace fs = std::filesystem;

class BagWriterTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "bag_writer_test_XXXXXX";
    ASSERT_NE(nullptr, mkdtemp(pattern.data()));
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string File(const std::string& name) const { return (folder_ / name).string(); }

  static std::string Content(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

 private:
  fs::path folder_;
};

/// Message `number` of a run: pressures of as many vehicles that a chunk holds about 200 of them.
train_brake_msgs::BrakePressures Pressures(unsigned number) {
  train_brake_msgs::BrakePressures message;
  message.header.stamp = ros::Time(0.01 * number);
  message.exchange = number;
  message.cylinder_pressure_pa.assign(1000, static_cast<float>(number));
  return message;
}

train_brake_msgs::EnergyLedger Ledger(unsigned number) {
  train_brake_msgs::EnergyLedger message;
  message.exchange = number;
  message.element = {"brake_shoes", "draft_gears"};
  message.dissipated_j = {1.0 * number, 2.0 * number};
  return message;
}

ros::Time TimeOf(unsigned number) { return ros::TIME_MIN + ros::Duration(0.01 * number); }

unsigned Readable(const std::string& file) {
  rosbag::Bag bag(file);
  rosbag::View view(bag);
  unsigned next = 0;
  for (const rosbag::MessageInstance& instance : view) {
    const auto message = instance.instantiate<train_brake_msgs::BrakePressures>();
    if (message == nullptr) continue;
    EXPECT_EQ(next, message->exchange);
    EXPECT_EQ(std::vector<float>(1000, static_cast<float>(next)), message->cylinder_pressure_pa);
    ++next;
  }
  return next;
}

TEST_F(BagWriterTest, WritesTheBytesOfRosbag) {
  // Several chunks; a topic that starts late, in the second; one with few messages; one without any.
  BagWriter ours(File("ours.bag"));
  rosbag::Bag theirs(File("theirs.bag"), rosbag::bagmode::Write);
  const int pressures = ours.AddTopic<train_brake_msgs::BrakePressures>("/train/brake_pressures");
  const int ledger = ours.AddTopic<train_brake_msgs::EnergyLedger>("/train/energy_ledger");
  const int late = ours.AddTopic<train_brake_msgs::BrakePressures>("/late");
  ours.AddTopic<train_brake_msgs::BrakePressures>("/never");
  for (unsigned i = 0; i < 1000; ++i) {
    ours.Write(pressures, TimeOf(i), Pressures(i));
    theirs.write("/train/brake_pressures", TimeOf(i), Pressures(i));
    if (i % 300 == 0) {
      ours.Write(ledger, TimeOf(i), Ledger(i));
      theirs.write("/train/energy_ledger", TimeOf(i), Ledger(i));
    }
    if (i >= 500) {
      ours.Write(late, TimeOf(i), Pressures(i));
      theirs.write("/late", TimeOf(i), Pressures(i));
    }
  }
  ours.Close();
  theirs.close();
  EXPECT_GT(fs::file_size(File("ours.bag")), 4u * 768 * 1024);
  EXPECT_TRUE(Content(File("theirs.bag")) == Content(File("ours.bag")));
  EXPECT_FALSE(fs::exists(File("ours.bag.active")));
}

TEST_F(BagWriterTest, ABagWithoutMessagesIsOne) {
  BagWriter(File("empty.bag")).Close();
  EXPECT_EQ(0u, Readable(File("empty.bag")));
}

TEST_F(BagWriterTest, UnfinishedBagIsNotMistakenForAWholeOne) {
  BagWriter bag(File("run.bag"));
  EXPECT_FALSE(fs::exists(File("run.bag")));
  EXPECT_THROW(rosbag::Bag(File("run.bag.active")), rosbag::BagUnindexedException);
}

TEST_F(BagWriterTest, NamesTheFileThatCannotBeMade) {
  try {
    BagWriter bag(File("missing/run.bag"));
    FAIL() << "made a file in a folder that does not exist";
  } catch (const std::system_error& e) {
    EXPECT_NE(std::string::npos, std::string(e.what()).find("missing/run.bag"));
    EXPECT_NE(std::string::npos, std::string(e.what()).find("No such file"));
  }
}

/// No file of this process may grow beyond a size: a full disk that needs no root.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t size) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{size, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_;
};

TEST_F(BagWriterTest, FullDiskGetsTheWholeChunksThatFit) {
  constexpr std::size_t kDisk = 2000000, kChunk = 800000;
  unsigned written = 0;
  {
    const SmallDisk disk(kDisk);
    BagWriter bag(File("run.bag"));
    const int topic = bag.AddTopic<train_brake_msgs::BrakePressures>("/train/brake_pressures");
    const auto fill = [&] {
      for (; written < 10000; ++written) bag.Write(topic, TimeOf(written), Pressures(written));
    };
    EXPECT_THROW(fill(), std::system_error);
    EXPECT_THROW(bag.Close(), std::system_error);
  }
  const unsigned readable = Readable(File("run.bag"));
  EXPECT_LT(readable, written);
  EXPECT_GT(readable * sizeof(float) * 1000, kDisk - kChunk);
}

TEST_F(BagWriterTest, LastChunkMakesRoomForTheIndex) {
  constexpr unsigned kMessages = 500;
  const auto write = [&](const std::string& name) {
    BagWriter bag(File(name));
    const int topic = bag.AddTopic<train_brake_msgs::BrakePressures>("/train/brake_pressures");
    for (unsigned i = 0; i < kMessages; ++i) bag.Write(topic, TimeOf(i), Pressures(i));
    bag.Close();
  };
  write("whole.bag");
  {
    const SmallDisk disk(fs::file_size(File("whole.bag")) - 1);
    EXPECT_THROW(write("run.bag"), std::system_error);
  }
  EXPECT_EQ(kMessages, Readable(File("whole.bag")));
  const unsigned readable = Readable(File("run.bag"));
  EXPECT_LT(readable, kMessages);
  EXPECT_GT(readable, 0u);
}

TEST_F(BagWriterTest, WhatACheckpointIsOfMakesRoomForNothing) {
  constexpr unsigned kMessages = 500;
  std::size_t size = 0;
  train_dynamics::Bytes checkpoint;
  {
    BagWriter bag(File("run.bag"));
    const int topic = bag.AddTopic<train_brake_msgs::BrakePressures>("/train/brake_pressures");
    for (unsigned i = 0; i < kMessages; ++i) bag.Write(topic, TimeOf(i), Pressures(i));
    checkpoint = bag.Checkpoint();
    size = fs::file_size(File("run.bag.active"));
    const SmallDisk disk(size + 1);
    EXPECT_THROW(bag.Close(), std::system_error);
  }
  EXPECT_FALSE(fs::exists(File("run.bag")));
  EXPECT_EQ(size, fs::file_size(File("run.bag.active")));
  BagWriter bag(File("run.bag"), checkpoint);
  bag.GoOn();
  bag.Close();  // there is room again
  EXPECT_EQ(kMessages, Readable(File("run.bag")));
}

TEST_F(BagWriterTest, NoRoomForAnyMessage) {
  {
    const SmallDisk disk(5000);
    BagWriter bag(File("run.bag"));
    bag.Write(bag.AddTopic<train_brake_msgs::BrakePressures>("/p"), TimeOf(0), Pressures(0));
    EXPECT_THROW(bag.Close(), std::system_error);
  }
  EXPECT_EQ(0u, Readable(File("run.bag")));
}

}  // namespace
}  // namespace train_results
