// The wire between master and wagon nodes: RosTransport against wagon_node processes.

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <signal.h>
#include <sys/wait.h>
#include <train_brake_msgs/exchange_memory.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "ltd_master/ranks/rank_caller.h"
#include "ltd_master/ranks/rank_messages.h"
#include "ltd_master/ranks/ros_transport.h"
#include "train_dynamics/config/load_scenario.h"
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

/// How calls reach the ranks.
enum class Path { kMemory, kTcp };
std::string PathName(const testing::TestParamInfo<Path>& test) {
  return test.param == Path::kMemory ? "Memory" : "Tcp";
}
void Choose(Path path, RosTransportOptions& options) { options.shared_memory = path == Path::kMemory; }
constexpr Path kPaths[] = {Path::kMemory, Path::kTcp};

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
    const train_dynamics::VehicleRecords& vehicles = record.vehicles;
    train_dynamics::Digest digest;
    digest.Add(record.state_digest);
    train_dynamics::ForEachRecordField(
        [&digest](const train_dynamics::RecordInfo&, const std::vector<double>& array) {
          for (const double value : array) digest.Add(value);
        },
        vehicles);
    if (record.ledger.has_value()) {
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
class LostRank : public testing::TestWithParam<Path> {
 protected:
  void Start(const RosTransportOptions& base) {
    RosTransportOptions options = base;
    Choose(GetParam(), options);
    options.recover = false;  // what a loss looks like when it ends the run
    std::vector<Rank> ranks = train_dynamics::SplitRanks(kVehicles, 2);
    ranks[0].name = "/own/" + name_;
    ranks[1].name = "/shared/" + ranks[1].name;
    transport_ = std::make_unique<RosTransport>(ranks, NextRun(), scenario_.params, options);
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

INSTANTIATE_TEST_SUITE_P(Paths, LostRank, testing::ValuesIn(kPaths), PathName);

/// A train of six ranks, the first three of which are processes of our own.
class LostAndFound : public testing::TestWithParam<Path> {
 protected:
  void SetUp() override {
    for (int rank = 0; rank < kOwn; ++rank) {
      ranks_[rank].name = "/own/wagon_" + std::to_string(NextRun());
      StartProcess(rank);
    }
    caller_ = ltd_master::MakeAsynchronousCaller(ranks_, GetParam() == Path::kMemory ? run_ : 0);
    messages_ = std::make_unique<ltd_master::RankMessages>(ranks_, run_, scenario_.params);
    for (int rank = 0; rank < kVehicles; ++rank) Connect(rank);
    ltd_master::LateWatch watch = Watch(kSoon);
    ASSERT_TRUE(caller_->Call(messages_->configure, watch).lost.empty());
    ASSERT_TRUE(Exchange(0).empty());
  }

  void StartProcess(int rank) {
    const std::string& name = ranks_[rank].name;
    process_[rank] = std::make_unique<WagonProcess>(name.substr(name.rfind('/') + 1));
  }
  void Connect(int rank) {
    const Clock::time_point end = Clock::now() + std::chrono::seconds(60);
    for (std::string why = caller_->Connect(rank); !why.empty(); why = caller_->Connect(rank)) {
      ASSERT_LT(Clock::now(), end) << why;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
  ltd_master::LateWatch Watch(double deadline_s) { return {ranks_, "test", deadline_s, interrupted_}; }

  /// Lets all ranks do an exchange. @return who was lost, and why, in the order of the ranks
  std::map<int, std::string> Exchange(std::uint64_t exchange, double deadline_s = kSoon) {
    train_dynamics::ExchangeRequest request;
    request.exchange = exchange;
    request.dt_s = scenario_.params.dt_s;
    request.steps = scenario_.params.StepsPerExchange();
    request.coupler_force_n.assign(kVehicles + 1, 0.0);
    request.cylinder_pressure_pa.assign(kVehicles, 0.0);
    messages_->Pack(request);
    ltd_master::LateWatch watch = Watch(deadline_s);
    std::map<int, std::string> lost;
    for (const ltd_master::LostRank& one : caller_->Call(messages_->step, watch).lost) {
      EXPECT_TRUE(lost.emplace(one.rank, one.why).second) << "rank " << one.rank << " was lost twice";
    }
    for (int rank = 0; rank < kVehicles; ++rank) {
      if (lost.count(rank) != 0) continue;
      EXPECT_TRUE(messages_->step[rank].response.ok) << messages_->step[rank].response.message;
      EXPECT_EQ(messages_->step[rank].response.exchange, exchange);
    }
    return lost;
  }

  static constexpr int kOwn = 3;
  const LoadedScenario scenario_ = Load();
  const std::uint64_t run_ = NextRun();
  const std::function<bool()> interrupted_ = [] { return false; };
  std::vector<Rank> ranks_ = RanksIn("/ranks_6", kVehicles);
  std::array<std::unique_ptr<WagonProcess>, kOwn> process_;
  std::unique_ptr<ltd_master::RankCaller> caller_;
  std::unique_ptr<ltd_master::RankMessages> messages_;
};

TEST_P(LostAndFound, TheOthersReplyAndReplacementsTakeOver) {
  process_[0]->Signal(SIGKILL);
  process_[1]->Stop();
  constexpr double kDeadline = 1.5;
  const std::map<int, std::string> lost = Exchange(1, kDeadline);
  ASSERT_EQ(lost.size(), 2u);
  EXPECT_NE(lost.at(0), "");
  EXPECT_EQ(lost.at(1), "no reply within 1.5 s");

  // The stopped one wakes up, and its reply goes nowhere.
  process_[1]->Signal(SIGCONT);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(Exchange(2).size(), 2u);  // those who are not connected stay lost

  ltd_master::LateWatch watch = Watch(kSoon);
  for (const int rank : {0, 1}) {
    process_[rank].reset();
    StartProcess(rank);
    Connect(rank);
    caller_->CallOne(rank, messages_->configure[rank], watch);
    ASSERT_TRUE(messages_->configure[rank].response.ok);
    for (const int exchange : {0, 1, 2}) {
      messages_->step[rank].request.exchange = exchange;
      caller_->CallOne(rank, messages_->step[rank], watch);
      ASSERT_TRUE(messages_->step[rank].response.ok);
    }
  }
  EXPECT_TRUE(Exchange(3).empty());
  // Nothing has acted on any vehicle, so each one rolls on as its neighbours of the same kind do: the repeated
  // exchanges have moved the replacements as far as the others.
  EXPECT_EQ(messages_->step[1].response.head_displacement_m, messages_->step[4].response.head_displacement_m);
}

TEST_P(LostAndFound, OneThatIsCalledAloneMayBeLostAlone) {
  process_[2]->Stop();
  ltd_master::LateWatch watch = Watch(0.5);
  messages_->step[2].request.exchange = 1;
  try {
    caller_->CallOne(2, messages_->step[2], watch);
    FAIL() << "a process that stands still has replied";
  } catch (const RankFailure& e) {
    EXPECT_EQ(e.what(), ranks_[2].name + " (vehicle 3), test: no reply within 0.5 s");
  }
  EXPECT_EQ(Exchange(1).size(), 1u);
  caller_->Disconnect(3);
  EXPECT_EQ(Exchange(2).size(), 2u);
}

INSTANTIATE_TEST_SUITE_P(Paths, LostAndFound, testing::ValuesIn(kPaths), PathName);

/// A rank that does in its slot what no wagon node would.
class OddRank : public testing::Test {
 protected:
  void SetUp() override {
    services_ = {node_.advertiseService(name_ + "/configure", &OddRank::Configure, this),
                 node_.advertiseService(name_ + "/step", &OddRank::Step, this)};
    spinner_.start();
    const std::uint64_t run = NextRun();
    ranks_[0].name = name_;
    caller_ = ltd_master::MakeAsynchronousCaller(ranks_, run);
    for (std::size_t rank = 0; rank < ranks_.size(); ++rank) {
      while (!caller_->Connect(static_cast<int>(rank)).empty()) {
      }
    }
    messages_ = std::make_unique<ltd_master::RankMessages>(ranks_, run, scenario_.params);
    ltd_master::LateWatch watch(ranks_, "test", kSoon, interrupted_);
    ASSERT_TRUE(caller_->Call(messages_->configure, watch).lost.empty());
  }
  ~OddRank() override { spinner_.stop(); }

  bool Configure(train_brake_msgs::ConfigureRequest& request, train_brake_msgs::ConfigureResponse& response) {
    memory_ = std::make_unique<train_brake_msgs::ExchangeMemory>(request.memory_pid,
                                                                 request.memory_descriptor, request.run_id);
    slot_ = request.memory_slot;
    response.ok = response.memory_used = true;
    return true;
  }
  bool Step(train_brake_msgs::StepRequest& request, train_brake_msgs::StepResponse& response) {
    response.ok = true;
    response.exchange = request.exchange;
    response.message = "by TCP";
    return true;
  }

  /// One exchange, in which the odd rank does something to its reply.
  template <class Action>
  ltd_master::CallOutcome Exchange(Action action) {
    train_dynamics::ExchangeRequest request;
    request.dt_s = scenario_.params.dt_s;
    request.steps = scenario_.params.StepsPerExchange();
    request.coupler_force_n.assign(kVehicles + 1, 0.0);
    request.cylinder_pressure_pa.assign(kVehicles, 0.0);
    messages_->Pack(request);
    train_brake_msgs::ExchangeHead& head = memory_->head();
    std::thread rank([&] {
      for (std::uint32_t seen = head.requests.count(); memory_->request(slot_).call() == 0;) {
        head.requests.Wait(seen, 0.1);
      }
      action(memory_->reply(slot_), memory_->request(slot_).call(), memory_->layout().reply_room);
      head.unreplied.fetch_sub(1);
      head.replies.Notify();
    });
    ltd_master::LateWatch watch(ranks_, "test", kSoon, interrupted_);
    const ltd_master::CallOutcome outcome = caller_->Call(messages_->step, watch);
    rank.join();
    return outcome;
  }

  const LoadedScenario scenario_ = Load();
  const std::function<bool()> interrupted_ = [] { return false; };
  const std::string name_ = "/odd/wagon_" + std::to_string(NextRun());
  ros::NodeHandle node_;
  ros::AsyncSpinner spinner_{2};
  std::vector<ros::ServiceServer> services_;
  std::vector<Rank> ranks_ = RanksIn("/ranks_3", 3);
  std::unique_ptr<ltd_master::RankCaller> caller_;
  std::unique_ptr<ltd_master::RankMessages> messages_;
  std::unique_ptr<train_brake_msgs::ExchangeMemory> memory_;
  std::uint32_t slot_ = 0;
};

TEST_F(OddRank, WhoseReplyDoesNotFitIsAskedByTcp) {
  const auto outcome =
      Exchange([](train_brake_msgs::MessageBuffer& buffer, std::uint64_t call, std::uint32_t room) {
        train_brake_msgs::StepResponse reply;
        reply.message.assign(room, 'x');
        EXPECT_FALSE(buffer.Write(call, reply, room));
      });
  EXPECT_TRUE(outcome.lost.empty());
  EXPECT_EQ(messages_->step[0].response.message, "by TCP");
  for (const int rank : {1, 2}) EXPECT_TRUE(messages_->step[rank].response.ok);
}

TEST_F(OddRank, WhoseReplyCannotBeReadIsLost) {
  const auto outcome =
      Exchange([](train_brake_msgs::MessageBuffer& buffer, std::uint64_t call, std::uint32_t room) {
        buffer.Write(call, std::string("no reply"), room);
      });
  ASSERT_EQ(outcome.lost.size(), 1u);
  EXPECT_EQ(outcome.lost[0].rank, 0);
  for (const int rank : {1, 2}) EXPECT_TRUE(messages_->step[rank].response.ok);
  EXPECT_EQ(caller_->Connect(0), "");  // anew
}

TEST_F(OddRank, WhoseReplyIsToAnotherCallIsWaitedFor) {
  const auto outcome =
      Exchange([](train_brake_msgs::MessageBuffer& buffer, std::uint64_t call, std::uint32_t room) {
        train_brake_msgs::StepResponse reply;
        buffer.Write(call + 1, reply, room);
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        reply.message = "at last";
        buffer.Write(call, reply, room);
      });
  EXPECT_TRUE(outcome.lost.empty());
  EXPECT_EQ(messages_->step[0].response.message, "at last");
}

TEST(Wire, CarriesTheBitsOfTheTrainInOneProcess) {
  for (const std::string model : {"model=2d", "model=ltd", "train.consist[1].model=ltd"}) {
    const LoadedScenario scenario = Load({model});
    train_dynamics::InProcessTransport in_process(scenario.params, scenario.consist, 1);
    const std::vector<std::uint64_t> expected = Fingerprint(scenario, in_process);
    for (const int ranks : {1, 3, kVehicles}) {
      for (const Path path : kPaths) {
        SCOPED_TRACE(model + ", ranks: " + std::to_string(ranks) + ", " + PathName({path, 0}));
        RosTransportOptions options;
        Choose(path, options);
        RosTransport transport(RanksIn("/ranks_" + std::to_string(ranks), ranks), NextRun(), scenario.params,
                               options);
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
  RosTransport transport(ranks, NextRun(), scenario.params, options);
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
  RosTransport transport(ranks, NextRun(), scenario.params, {});
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

TEST(Wire, EachLostRankIsGivenItsTime) {
  const LoadedScenario scenario = Load();
  std::vector<Rank> ranks = train_dynamics::SplitRanks(kVehicles, 2);
  std::array<std::unique_ptr<WagonProcess>, 2> processes;
  std::array<std::string, 2> names;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    names[i] = "wagon_" + std::to_string(NextRun());
    ranks[i].name = "/own/" + names[i];
    processes[i] = std::make_unique<WagonProcess>(names[i]);
  }
  RosTransportOptions options;
  options.recovery_timeout_s = 10.0;
  RosTransport transport(ranks, NextRun(), scenario.params, options);
  TrainMaster master(scenario.params, scenario.consist, transport, scenario.pressures);
  master.Start();
  master.Exchange();
  for (const auto& process : processes) process->Signal(SIGKILL);
  std::thread later([&] {  // the second one after more than the time-out of the first
    for (std::size_t i = 0; i < ranks.size(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5500));
      processes[i] = std::make_unique<WagonProcess>(names[i]);
    }
  });
  EXPECT_NO_THROW(master.Exchange());
  later.join();
  EXPECT_EQ(transport.recoveries(), 2u);
}

TEST(Wire, WagonsStayWhileTheMasterPausesAndLeaveWhenItHasGone) {
  const LoadedScenario scenario = Load();
  WagonProcess process("wagon_001", "_master_timeout_s:=1");
  auto transport = std::make_unique<RosTransport>(std::vector<Rank>{{"/own/wagon_001", 0, kVehicles}},
                                                  NextRun(), scenario.params, RosTransportOptions());
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
