#include "train_results/recorder_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <vector>

namespace train_results {
namespace {

using train_dynamics::TrainRecord;

/// Shows records 0, 1, 2 ... of a train of three vehicles; their arrays are overwritten from one to the next, as a
/// run does.
class Train {
 public:
  template <class Recorder>
  void Record(Recorder& recorder) {
    const double number = static_cast<double>(next_);
    const std::vector<double> values = {number, -number, 0.0, 7.0};
    record_.time_s = 0.01 * number;
    record_.exchange = record_.state_digest = next_;
    record_.mean_speed_mps = record_.mean_position_m = number;
    record_.vehicles.position_m = {number, number + 1.0, number + 2.0};
    record_.vehicles.details[0].position.z[0] = number;
    Fill(values);
    record_.ledger.reset();
    if (next_ % 5 == 0) record_.ledger.emplace().kinetic_j = number;
    recorder.Record(record_);
    ++next_;
    Fill(std::vector<double>(4, -1.0));
  }

 private:
  void Fill(const std::vector<double>& values) {
    for (std::vector<double>* array :
         {&record_.acceleration_mps2, &record_.held.coupler_force_n, &record_.held.cylinder_pressure_pa,
          &record_.coupler_extension_m, &record_.cylinder_pressure_pa}) {
      *array = values;
    }
  }

  std::uint64_t next_ = 0;
  TrainRecord record_ = [] {
    TrainRecord record;
    record.vehicles = train_dynamics::VehicleRecords(3, {1});
    return record;
  }();
};

TEST(RecorderThread, RecordsEverythingInOrder) {
  std::vector<std::uint64_t> seen;
  RecorderThread recorder([&](const TrainRecord& record) {
    const double number = static_cast<double>(record.exchange);
    EXPECT_EQ(0.01 * number, record.time_s);
    EXPECT_EQ(number, record.mean_speed_mps);
    EXPECT_EQ((std::vector<double>{number, number + 1.0, number + 2.0}), record.vehicles.position_m);
    EXPECT_EQ(number, record.vehicles.details.at(0).position.z[0]);
    for (const auto* values : {&record.acceleration_mps2, &record.held.coupler_force_n, &record.coupler_extension_m,
                               &record.cylinder_pressure_pa, &record.held.cylinder_pressure_pa}) {
      EXPECT_EQ((std::vector<double>{number, -number, 0.0, 7.0}), *values);
    }
    EXPECT_EQ(record.exchange, record.state_digest);
    ASSERT_EQ(record.exchange % 5 == 0, record.ledger.has_value());
    if (record.ledger) {
      EXPECT_EQ(number, record.ledger->kinetic_j);
    }
    seen.push_back(record.exchange);
  });
  Train train;
  for (int i = 0; i < 10000; ++i) train.Record(recorder);
  recorder.Finish();
  ASSERT_EQ(10000u, seen.size());
  for (std::uint64_t i = 0; i < seen.size(); ++i) EXPECT_EQ(i, seen[i]);
}

TEST(RecorderThread, SlowRecorderHoldsTheRunBack) {
  std::atomic<int> recorded{0};
  RecorderThread recorder([&](const TrainRecord&) {
    std::this_thread::sleep_for(std::chrono::microseconds(100));
    ++recorded;
  });
  Train train;
  int largest_backlog = 0;
  for (int i = 1; i <= 1000; ++i) {
    train.Record(recorder);
    largest_backlog = std::max(largest_backlog, i - recorded);
  }
  recorder.Finish();
  EXPECT_EQ(1000, recorded);
  EXPECT_GT(largest_backlog, 1);
  EXPECT_LT(largest_backlog, 200);  // whatever the queue's length: it has one
}

TEST(RecorderThread, FewRecordsDoNotWaitForMore) {
  std::atomic<int> recorded{0};
  RecorderThread recorder([&](const TrainRecord&) { ++recorded; });
  Train train;
  train.Record(recorder);
  for (int i = 0; i < 6000 && recorded == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(1, recorded);
}

TEST(RecorderThread, TasksAreDoneBetweenTheirRecords) {
  int recorded = 0;
  std::vector<int> recorded_before;
  RecorderThread recorder([&](const TrainRecord&) { ++recorded; });
  Train train;
  for (int i = 1; i <= 1000; ++i) {
    train.Record(recorder);
    if (i % 100 == 0) recorder.Do([&] { recorded_before.push_back(recorded); });
  }
  recorder.Finish();
  EXPECT_EQ(1000, recorded);
  EXPECT_EQ((std::vector<int>{100, 200, 300, 400, 500, 600, 700, 800, 900, 1000}), recorded_before);
}

TEST(RecorderThread, ErrorOfATaskReachesTheRun) {
  int recorded = 0;
  RecorderThread recorder([&](const TrainRecord&) { ++recorded; });
  Train train;
  train.Record(recorder);
  recorder.Do([] { throw std::runtime_error("the disk is full"); });
  const auto fill = [&] {
    for (int i = 0; i < 100000; ++i) train.Record(recorder);
  };
  EXPECT_THROW(fill(), std::runtime_error);
  EXPECT_THROW(recorder.Do([] {}), std::runtime_error);
  EXPECT_THROW(recorder.Finish(), std::runtime_error);
  EXPECT_EQ(1, recorded);
}

TEST(RecorderThread, DestructorRecordsWhatIsQueued) {
  int recorded = 0;
  {
    RecorderThread recorder([&](const TrainRecord&) { ++recorded; });
    Train train;
    for (int i = 0; i < 7; ++i) train.Record(recorder);
  }
  EXPECT_EQ(7, recorded);
}

TEST(RecorderThread, ErrorReachesTheRun) {
  int recorded = 0;
  RecorderThread recorder([&](const TrainRecord& record) {
    if (record.exchange == 100) throw std::runtime_error("the disk is full");
    ++recorded;
  });
  Train train;
  const auto fill = [&] {
    for (int i = 0; i < 100000; ++i) train.Record(recorder);
  };
  EXPECT_THROW(fill(), std::runtime_error);
  EXPECT_THROW(train.Record(recorder), std::runtime_error);
  EXPECT_THROW(recorder.Finish(), std::runtime_error);
  EXPECT_EQ(100, recorded);  // nothing behind a hole
}

TEST(RecorderThread, ErrorAtTheLastRecordReachesFinish) {
  RecorderThread recorder([](const TrainRecord&) { throw std::runtime_error("the disk is full"); });
  Train train;
  train.Record(recorder);
  EXPECT_THROW(recorder.Finish(), std::runtime_error);
}

}  // namespace
}  // namespace train_results
