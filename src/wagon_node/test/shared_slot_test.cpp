#include "wagon_node/shared_slot.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace wagon_node {
namespace {

using train_brake_msgs::ConfigureRequest;
using train_brake_msgs::ExchangeLayout;
using train_brake_msgs::ExchangeMemory;
using train_brake_msgs::StepRequest;
using train_brake_msgs::StepResponse;

constexpr std::uint64_t kRun = 17;
constexpr double kBriefly = 0.01, kLong = 60.0;  // [s]

/// Memory as a master makes it, or a stranger.
class File {
 public:
  explicit File(const ExchangeLayout& layout, std::size_t size, int seals = F_SEAL_SHRINK | F_SEAL_GROW)
      : descriptor_(memfd_create("test", MFD_CLOEXEC | MFD_ALLOW_SEALING)) {
    EXPECT_EQ(pwrite(descriptor_, &layout, sizeof layout, 0), static_cast<ssize_t>(sizeof layout));
    EXPECT_EQ(ftruncate(descriptor_, static_cast<off_t>(size)), 0);
    EXPECT_EQ(fcntl(descriptor_, F_ADD_SEALS, seals), 0);
  }
  explicit File(const ExchangeLayout& layout) : File(layout, layout.Size()) {}
  ~File() { close(descriptor_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  ConfigureRequest Offer(std::uint32_t slot = 0) const {
    ConfigureRequest offer;
    offer.run_id = kRun;
    offer.memory_pid = static_cast<std::uint32_t>(getpid());
    offer.memory_descriptor = static_cast<std::uint32_t>(descriptor_);
    offer.memory_slot = slot;
    return offer;
  }

 private:
  const int descriptor_;
};

ExchangeLayout Layout() {
  ExchangeLayout layout;
  layout.run_id = kRun;
  layout.slots = 3;
  layout.request_room = 200;
  layout.reply_room = 300;
  return layout;
}

void ExpectDeclined(const ConfigureRequest& offer, const std::string& text) {
  try {
    const SharedSlot slot(offer);
    FAIL() << "has taken what is " << text;
  } catch (const std::exception& e) {
    EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << e.what();
  }
}

TEST(SharedSlot, DeclinesWhatIsNotTheMemoryOfItsRun) {
  const File file(Layout());
  EXPECT_NO_THROW(SharedSlot(file.Offer(2)));
  ExpectDeclined(file.Offer(3), "no such slot");
  ConfigureRequest offer = file.Offer();
  offer.run_id = kRun + 1;
  ExpectDeclined(offer, "not the memory of run 18");
  offer = file.Offer();
  offer.memory_descriptor = 1000000;
  EXPECT_THROW(SharedSlot{offer}, std::exception);
  offer = file.Offer();
  offer.memory_pid = std::numeric_limits<std::uint32_t>::max();
  EXPECT_THROW(SharedSlot{offer}, std::exception);
}

TEST(SharedSlot, DeclinesMemoryThatMayGoAway) {
  const File unsealed(Layout(), Layout().Size(), 0);
  ExpectDeclined(unsealed.Offer(), "not sealed");
  // A file of the disk cannot be sealed at all.
  const std::string path = testing::TempDir() + "/shared_slot_test";
  const int descriptor = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  ConfigureRequest offer = unsealed.Offer();
  offer.memory_descriptor = static_cast<std::uint32_t>(descriptor);
  ExpectDeclined(offer, "not sealed");
  close(descriptor);
  unlink(path.c_str());
}

TEST(SharedSlot, DeclinesALayoutThatIsLargerThanTheMemory) {
  const std::uint32_t huge = std::numeric_limits<std::uint32_t>::max();
  for (const auto spoil : {+[](ExchangeLayout& l) { l.slots = 4; }, +[](ExchangeLayout& l) { l.slots = huge; },
                           +[](ExchangeLayout& l) { l.request_room += 64; },
                           +[](ExchangeLayout& l) { l.slots = l.request_room = l.reply_room = huge; },
                           +[](ExchangeLayout& l) { l.magic += 1; }}) {
    ExchangeLayout layout = Layout();
    spoil(layout);
    const File file(layout, Layout().Size());
    ExpectDeclined(file.Offer(), "not the memory of run 17");
  }
  const File empty(Layout(), sizeof(ExchangeLayout));
  ExpectDeclined(empty.Offer(), "not the memory of run 17");
}

class SharedSlotTest : public testing::Test {
 protected:
  void Call(std::uint64_t call) {
    StepRequest request;
    request.exchange = call;
    master_.head().unreplied = 1;
    master_.request(1).Write(call, request, Layout().request_room);
    master_.head().requests.Notify();
  }

  const File file_{Layout()};
  ExchangeMemory master_{file_.Offer().memory_pid, file_.Offer().memory_descriptor, kRun};
  SharedSlot slot_{file_.Offer(1)};
  StepRequest request_;
  StepResponse response_;
};

TEST_F(SharedSlotTest, ServesEachCallOnce) {
  EXPECT_FALSE(slot_.Wait(kBriefly));
  for (std::uint64_t call = 5; call < 8; ++call) {
    Call(call);
    ASSERT_TRUE(slot_.Wait(kLong));
    slot_.Read(request_);
    EXPECT_EQ(request_.exchange, call);
    const std::uint32_t seen = master_.head().replies.count();
    response_.exchange = 100 + call;
    slot_.Reply(response_);
    EXPECT_EQ(master_.head().replies.count(), seen + 1);
    EXPECT_EQ(master_.head().last_slot, 1u);
    EXPECT_EQ(master_.reply(1).call(), call);
    StepResponse read;
    EXPECT_TRUE(master_.reply(1).Read(read, Layout().reply_room));
    EXPECT_EQ(read.exchange, 100 + call);
    EXPECT_FALSE(slot_.Wait(kBriefly));
  }
}

TEST_F(SharedSlotTest, SharesItsCoreInTurnsButSleepsInTheEnd) {
  constexpr std::uint32_t kMany = std::numeric_limits<std::uint32_t>::max();
  master_.head().threads = kMany;  // more than there are cores
  std::uint64_t call = 0;
  for (const std::uint32_t yields : {0u, 1u, 50u, kMany}) {  // the last would take hours
    master_.head().yields = yields;
    EXPECT_FALSE(slot_.Wait(kBriefly)) << yields;
    Call(++call);
    ASSERT_TRUE(slot_.Wait(kLong)) << yields;
    slot_.Read(request_);
    std::thread master([this, next = ++call] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      Call(next);
    });
    EXPECT_TRUE(slot_.Wait(kLong)) << yields;
    slot_.Read(request_);
    EXPECT_EQ(request_.exchange, call);
    master.join();
  }
}

TEST_F(SharedSlotTest, OnlyTheLastOneWakesTheMaster) {
  Call(1);
  master_.head().unreplied = 2;
  const std::uint32_t seen = master_.head().replies.count();
  ASSERT_TRUE(slot_.Wait(kLong));
  slot_.Read(request_);
  slot_.Reply(response_);
  EXPECT_EQ(master_.head().replies.count(), seen);
  EXPECT_EQ(master_.head().unreplied, 1);
}

TEST_F(SharedSlotTest, WakesUpForACall) {
  for (std::uint64_t call = 1; call < 200; ++call) {
    std::thread later([&] { Call(call); });
    while (!slot_.Wait(kLong)) {
    }
    later.join();
    slot_.Read(request_);
    EXPECT_EQ(request_.exchange, call);
  }
}

TEST_F(SharedSlotTest, CanBeWokenWithoutACall) {
  std::atomic<bool> is_awake = false;
  std::thread later([&] {
    while (!is_awake) slot_.Wake();
  });
  EXPECT_FALSE(slot_.Wait(kLong));
  is_awake = true;
  later.join();
}

TEST_F(SharedSlotTest, ARequestThatCannotBeReadIsServedAllTheSame) {
  master_.request(1).Write(3, std::string("no request"), Layout().request_room);
  ASSERT_TRUE(slot_.Wait(kLong));
  EXPECT_THROW(slot_.Read(request_), std::exception);
  slot_.Reply(response_);
  EXPECT_EQ(master_.reply(1).call(), 3u);
  EXPECT_FALSE(slot_.Wait(kBriefly));
}

TEST_F(SharedSlotTest, SaysWhenAReplyDoesNotFit) {
  Call(1);
  ASSERT_TRUE(slot_.Wait(kLong));
  slot_.Read(request_);
  response_.message.assign(Layout().reply_room, 'x');
  slot_.Reply(response_);
  EXPECT_EQ(master_.reply(1).call(), 1u);
  EXPECT_FALSE(master_.reply(1).Read(response_, Layout().reply_room));
}

}  // namespace
}  // namespace wagon_node
