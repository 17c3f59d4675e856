// The wire between master and wagon nodes: RosTransport against wagon_node processes.

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "ltd_master/ros_transport.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/config/writer.h"
#include "train_dynamics/train/in_process_train.h"

namespace {

using Clock = std::chrono::steady_clock;
using ltd_master::RankFailure;
using ltd_master::RosTransport;
using ltd_master::RosTransportOptions;
using train_dynamics::Rank;
using train_dynamics::TrainMaster;
using train_dynamics::config::LoadedScenario;

constexpr int kVehicles = 6;
constexpr int kBlockingThreads = 2;
// Wall times of events that need none: processes start, die and answer; the machine may be busy.
constexpr double kSoon = 10.0;

LoadedScenario Load(const std::vector<std::string>& overrides = {}) {
  return train_dynamics::config::LoadScenario(ros::param::param<std::string>("~scenario", ""), overrides);
}

/// Unlike those of other tests and of earlier runs on the same nodes.
std::uint64_t NextRun() {
  static std::uint64_t run = 1000;
  return ++run;
}

std::vector<Rank> RanksIn(const std::string& name_space, int ranks) {
  std::vector<Rank> split = train_dynamics::SplitRanks(kVehicles, ranks);
  for (Rank& rank : split) rank.name = name_space + "/" + rank.name;
  return split;
}

/// Everything in a train's records, bit by bit.
std::vector<std::uint64_t> Fingerprint(const LoadedScenario& scenario, train_dynamics::Transport& transport) {
  std::vector<std::uint64_t> prints;
  TrainMaster master(scenario.params, scenario.consist, transport, scenario.pressures);
  master.AddObserver([&](const train_dynamics::TrainRecord& record) {
    const train_dynamics::ExchangeReply& vehicles = record.vehicles;
    train_dynamics::Digest digest;
    digest.Add(record.state_digest);
    for (const auto* array : {&vehicles.position_m, &vehicles.speed_mps, &vehicles.shoe_force_n,
                              &vehicles.wheel_force_n, &vehicles.creepage}) {
      for (const double value : *array) digest.Add(value);
    }
    if (record.ledger != nullptr) {
      digest.Add(record.ledger->Stored());
      digest.Add(record.ledger->Dissipated());
    }
    for (const train_dynamics::WagonDetail& detail : vehicles.details) {
      digest.Add(static_cast<std::uint64_t>(detail.vehicle));
      for (const double value : detail.position.pitch) digest.Add(value);
      for (const double value : detail.velocity.z) digest.Add(value);
    }
    prints.push_back(digest.value());
  });
  master.Start();
  while (!master.Done()) master.Exchange();
  return prints;
}

/// A wagon node of our own, to be killed.
class WagonProcess {
 public:
  explicit WagonProcess(const std::string& name, const std::string& argument = "_threads:=1") : pid_(fork()) {
    if (pid_ != 0) return;
    execlp("rosrun", "rosrun", "wagon_node", "wagon_node", ("__name:=" + name).c_str(), "__ns:=/own",
           argument.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  ~WagonProcess() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  WagonProcess(const WagonProcess&) = delete;
  WagonProcess& operator=(const WagonProcess&) = delete;

  void Signal(int signal) const { kill(pid_, signal); }
  void Stop() const {
    Signal(SIGSTOP);
    waitpid(pid_, nullptr, WUNTRACED);  // its threads do not stop at once
  }
  /// Whether it ends by itself in this time.
  bool EndsWithin(double wall_s) {
    const Clock::time_point end =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(wall_s));
    while (Clock::now() < end) {
      if (waitpid(pid_, nullptr, WNOHANG) == pid_) {
        pid_ = -1;
        return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
  }

 private:
  pid_t pid_;
};

/// A train whose first rank is a process of our own, and the second one of the launch file's.
class LostRank : public testing::TestWithParam<int> {
 protected:
  void Start(const RosTransportOptions& base) {
    RosTransportOptions options = base;
    options.blocking_threads = GetParam();
    std::vector<Rank> ranks = train_dynamics::SplitRanks(kVehicles, 2);
    ranks[0].name = "/own/" + name_;
    ranks[1].name = "/shared/" + ranks[1].name;
    transport_ = std::make_unique<RosTransport>(ranks, NextRun(),
                                                train_dynamics::config::Write(scenario_.params), options);
    master_ =
        std::make_unique<TrainMaster>(scenario_.params, scenario_.consist, *transport_, scenario_.pressures);
    master_->Start();
    for (int i = 0; i < 3; ++i) master_->Exchange();
  }

  /// The text of the failure that the next exchange ends in.
  std::string Failure() {
    const Clock::time_point start = Clock::now();
    try {
      master_->Exchange();
    } catch (const RankFailure& e) {
      waited_s_ = std::chrono::duration<double>(Clock::now() - start).count();
      return e.what();
    }
    return "none";
  }

  const LoadedScenario scenario_ = Load();
  const std::string name_ = "wagon_" + std::to_string(NextRun());
  WagonProcess process_{name_};
  std::unique_ptr<RosTransport> transport_;
  std::unique_ptr<TrainMaster> master_;
  double waited_s_ = 0.0;
};

TEST_P(LostRank, KilledIsNamedAtOnce) {
  Start({});
  process_.Signal(SIGKILL);
  const std::string failure = Failure();
  EXPECT_EQ(failure.rfind("/own/" + name_ + " (vehicles 1-3), exchange 3: ", 0), 0u) << failure;
  EXPECT_LT(waited_s_, kSoon);
}

TEST_P(LostRank, StoppedIsNamedAtTheDeadline) {
  RosTransportOptions options;
  options.exchange_deadline_s = 1.5;
  Start(options);
  process_.Stop();
  EXPECT_EQ(Failure(), "exchange 3: no reply within 1.5 s from /own/" + name_ + " (vehicles 1-3)");
  EXPECT_GE(waited_s_, options.exchange_deadline_s);
  EXPECT_LT(waited_s_, options.exchange_deadline_s + kSoon);
}

TEST_P(LostRank, WaitingCanBeInterrupted) {
  bool interrupted = false;
  RosTransportOptions options;
  options.exchange_deadline_s = 0.0;  // for ever
  options.interrupted = [&interrupted] { return interrupted; };
  Start(options);
  process_.Stop();
  interrupted = true;
  EXPECT_THROW(master_->Exchange(), ltd_master::WaitInterrupted);
}

TEST_P(LostRank, LateIsMentionedAndThenGoesOn) {
  Start({});
  process_.Stop();
  std::thread later([this] {
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    process_.Signal(SIGCONT);
  });
  EXPECT_EQ(Failure(), "none");
  later.join();
  EXPECT_TRUE(transport_->timing().was_late);
  EXPECT_EQ(transport_->timing().last_rank, 0);
  EXPECT_EQ(Failure(), "none");
  EXPECT_FALSE(transport_->timing().was_late);
}

INSTANTIATE_TEST_SUITE_P(Callers, LostRank, testing::Values(0, kBlockingThreads),
                         [](const auto& test) { return test.param == 0 ? "Asynchronous" : "Blocking"; });

TEST(Wire, CarriesTheBitsOfTheTrainInOneProcess) {
  for (const char* model : {"2d", "ltd"}) {
    const LoadedScenario scenario = Load({std::string("model=") + model});
    train_dynamics::InProcessTransport in_process(scenario.params, scenario.consist, 1);
    const std::vector<std::uint64_t> expected = Fingerprint(scenario, in_process);
    const std::string text = train_dynamics::config::Write(scenario.params);
    for (const int ranks : {1, 3, kVehicles}) {
      for (const int blocking_threads : {0, kBlockingThreads}) {
        SCOPED_TRACE(std::string(model) + ", ranks: " + std::to_string(ranks) +
                     ", blocking threads: " + std::to_string(blocking_threads));
        RosTransportOptions options;
        options.blocking_threads = blocking_threads;
        RosTransport transport(RanksIn("/ranks_" + std::to_string(ranks), ranks), NextRun(), text, options);
        EXPECT_EQ(Fingerprint(scenario, transport), expected);
      }
    }
  }
}

TEST(Wire, NamesTheRanksThatAreMissingAtTheStart) {
  const LoadedScenario scenario = Load();
  std::vector<Rank> ranks = RanksIn("/ranks_3", 3);
  ranks[1].name = "/nowhere/wagon_003";
  RosTransportOptions options;
  options.start_timeout_s = 0.5;
  RosTransport transport(ranks, NextRun(), train_dynamics::config::Write(scenario.params), options);
  TrainMaster master(scenario.params, scenario.consist, transport, scenario.pressures);
  try {
    master.Start();
    FAIL() << "started without a rank";
  } catch (const RankFailure& e) {
    const std::string text = e.what();
    EXPECT_NE(text.find("1 of 3 wagon nodes are missing"), std::string::npos) << text;
    EXPECT_NE(text.find("/nowhere/wagon_003 (vehicles 3-4)"), std::string::npos) << text;
    EXPECT_EQ(text.find("wagon_001"), std::string::npos) << text;
  }
}

TEST(Wire, PassesOnWhyARankRefuses) {
  const LoadedScenario scenario = Load();
  std::vector<Rank> ranks = RanksIn("/ranks_3", 3);
  ranks[2].count = 3;  // one more than the train has
  RosTransport transport(ranks, NextRun(), train_dynamics::config::Write(scenario.params), {});
  train_dynamics::ExchangeReply reply(kVehicles + 1, {});
  try {
    transport.Start(reply);
    FAIL() << "started with vehicles that do not exist";
  } catch (const RankFailure& e) {
    EXPECT_STREQ(
        e.what(),
        "/ranks_3/wagon_005 (vehicles 5-7), configuration: first_vehicle 5 and vehicle_count 3 are not in "
        "a train of 6 vehicles");
  }
}

TEST(Wire, WagonsStayWhileTheMasterPausesAndLeaveWhenItHasGone) {
  const LoadedScenario scenario = Load();
  WagonProcess process("wagon_001", "_master_timeout_s:=1");
  auto transport =
      std::make_unique<RosTransport>(std::vector<Rank>{{"/own/wagon_001", 0, kVehicles}}, NextRun(),
                                     train_dynamics::config::Write(scenario.params), RosTransportOptions());
  TrainMaster master(scenario.params, scenario.consist, *transport, scenario.pressures);
  master.Start();
  master.Exchange();
  EXPECT_FALSE(process.EndsWithin(3.0));  // three times its patience
  master.Exchange();
  transport.reset();
  EXPECT_TRUE(process.EndsWithin(kSoon));
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "wire_test");
  const ros::NodeHandle node;
  return RUN_ALL_TESTS();
}
