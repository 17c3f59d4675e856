#include "ltd_master/ranks/ros_transport.h"

#include <fmt/format.h>
#include <ros/console.h>
#include <ros/names.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "ltd_master/ranks/rank_caller.h"
#include "ltd_master/ranks/rank_messages.h"

namespace ltd_master {
namespace {

constexpr double kSecondsPerReport = 5.0;  // on ranks that have not started yet
constexpr std::chrono::milliseconds kRetry(100);
constexpr std::chrono::milliseconds kRetryAfterFailure(500);  // of a node that has answered
constexpr rlim_t kDescriptorsPerRank = 2;
constexpr rlim_t kOtherDescriptors = 256;  // of roscpp, bag, logs

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Lets this process open enough sockets, as far as it may.
void RaiseDescriptorLimit(std::size_t ranks) {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  const rlim_t needed = kDescriptorsPerRank * ranks + kOtherDescriptors;
  if (limit.rlim_cur >= needed) return;
  limit.rlim_cur = std::min(needed, limit.rlim_max);
  setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace

RosTransport::RosTransport(std::vector<train_dynamics::Rank> ranks, std::uint64_t run_id,
                           const train_dynamics::ScenarioParams& scenario, RosTransportOptions options)
    : ranks_(std::move(ranks)), options_(std::move(options)) {
  for (train_dynamics::Rank& rank : ranks_) rank.name = ros::names::resolve(rank.name);
  RaiseDescriptorLimit(ranks_.size());
  messages_ = std::make_unique<RankMessages>(ranks_, run_id, scenario);
  caller_ = MakeAsynchronousCaller(ranks_, options_.shared_memory ? run_id : 0);
}

RosTransport::~RosTransport() = default;

void RosTransport::Start(train_dynamics::ExchangeReply& reply) { Resume(0, {}, reply); }

void RosTransport::Resume(std::uint64_t exchange, const std::vector<train_dynamics::StateRow>& snapshot,
                          train_dynamics::ExchangeReply& reply) {
  messages_->BeginAt(exchange, snapshot);
  std::vector<RecoveryLog::Snapshot> snapshots;
  for (const train_brake_msgs::Configure& call : messages_->configure) {
    snapshots.push_back(call.request.snapshot);
  }
  log_.Begin(exchange, std::move(snapshots));
  WaitForRanks();
  LateWatch watch(ranks_, kConfiguration, options_.start_timeout_s, options_.interrupted);
  const CallOutcome outcome = caller_->Call(messages_->configure, watch);
  Recover(outcome.lost, watch, [this](int rank) { Reconfigure(rank); });
  messages_->Unpack(reply);
  for (int rank = 0; options_.recover && rank < static_cast<int>(ranks_.size()); ++rank) {
    if (messages_->GivesSnapshots(rank)) continue;
    ROS_WARN(
        "%s (%s) gives no snapshots: it cannot be brought back if it is lost, and the run leaves no "
        "checkpoints",
        ranks_[rank].name.c_str(), VehiclesText(ranks_[rank]).c_str());
  }
}

bool RosTransport::GivesSnapshots() const {
  bool all = true;
  for (int rank = 0; rank < static_cast<int>(ranks_.size()); ++rank) all = all && messages_->GivesSnapshots(rank);
  return all;
}

void RosTransport::Exchange(const train_dynamics::ExchangeRequest& request, train_dynamics::ExchangeReply& reply) {
  const Clock::time_point start = Clock::now();
  request_ = request;
  if (options_.recover && (request.exchange + 1) % options_.snapshot_exchanges == 0) request_.snapshot = true;
  messages_->Pack(request_);
  LateWatch watch(ranks_, ExchangeText(request.exchange), options_.exchange_deadline_s, options_.interrupted);
  const CallOutcome outcome = caller_->Call(messages_->step, watch);
  Recover(outcome.lost, watch, [this](int rank) {
    Reconfigure(rank);
    Replay(rank);
  });
  messages_->Unpack(request_, reply);
  KeepForRecovery();
  timing_.wall_s = SecondsSince(start);
  timing_.last_rank = outcome.last_rank;
  timing_.was_late = watch.was_late();
}

void RosTransport::KeepForRecovery() {
  if (!options_.recover) return;
  if (!request_.snapshot) {
    log_.Add(request_);
    return;
  }
  std::vector<RecoveryLog::Snapshot> snapshots;
  for (const train_brake_msgs::Step& call : messages_->step) snapshots.push_back(call.response.snapshot);
  log_.Begin(request_.exchange + 1, std::move(snapshots));
}

void RosTransport::Recover(const std::vector<LostRank>& lost, const LateWatch& watch,
                           const std::function<void(int rank)>& catch_up) {
  if (lost.empty()) return;
  const bool can_recover = std::all_of(lost.begin(), lost.end(),
                                       [this](const LostRank& one) { return messages_->GivesSnapshots(one.rank); });
  if (!options_.recover || !can_recover) watch.GiveUp(lost);
  for (const LostRank& one : lost) {
    const RankFailure what(ranks_[one.rank], watch.when(), one.why);
    ROS_WARN("%s. The train waits until a node of that name is there again.", what.what());
  }
  const Clock::time_point start = Clock::now();
  for (const LostRank& one : lost) {
    BringBack(one, watch.when(), [&] { catch_up(one.rank); });
    ++recoveries_;
    ROS_WARN("%s (%s) is back after %.1f s, with %lu exchanges replayed", ranks_[one.rank].name.c_str(),
             VehiclesText(ranks_[one.rank]).c_str(), SecondsSince(start), log_.size());
  }
}

void RosTransport::BringBack(const LostRank& lost, const std::string& when, const std::function<void()>& catch_up) {
  const Clock::time_point start = Clock::now();
  double next_report_s = kSecondsPerReport;
  std::string tried;  // why the last node that was tried was rejected
  while (true) {
    std::string why_not;
    try {
      why_not = caller_->Connect(lost.rank);
      if (why_not.empty()) return catch_up();
    } catch (const RankFailure& e) {
      caller_->Disconnect(lost.rank);
      why_not = e.what();
      if (why_not != tried) ROS_WARN("%s: not taken in its place", e.what());
      tried = why_not;
      std::this_thread::sleep_for(kRetryAfterFailure);
    }
    if (options_.interrupted()) throw WaitInterrupted();
    const double waited_s = SecondsSince(start);
    if (options_.recovery_timeout_s > 0.0 && waited_s > options_.recovery_timeout_s) {
      throw RankFailure(ranks_[lost.rank], when,
                        fmt::format("{}; no node has taken its place within {:g} s: {}", lost.why,
                                    options_.recovery_timeout_s, tried.empty() ? why_not : tried));
    }
    if (waited_s > next_report_s) {
      ROS_WARN("%s: waiting for %.0f s already for a node in the place of %s (%s): %s", when.c_str(), waited_s,
               ranks_[lost.rank].name.c_str(), VehiclesText(ranks_[lost.rank]).c_str(), why_not.c_str());
      next_report_s += kSecondsPerReport;
    }
    std::this_thread::sleep_for(kRetry);
  }
}

void RosTransport::Reconfigure(int rank) {
  train_brake_msgs::Configure& call = messages_->configure[rank];
  call.request.exchange = log_.exchange();
  call.request.snapshot = log_.snapshot(rank);
  call.request.again = true;
  LateWatch watch(ranks_, kConfiguration, options_.recovery_timeout_s, options_.interrupted);
  caller_->CallOne(rank, call, watch);
  if (!call.response.ok) throw RankFailure(ranks_[rank], kConfiguration, call.response.message);
}

void RosTransport::Replay(int rank) {
  train_dynamics::ExchangeRequest request = request_;
  train_brake_msgs::Step past;
  past.request.run_id = messages_->step[rank].request.run_id;
  for (std::uint64_t i = 0; i < log_.size(); ++i) {
    request.friction_patches = request_.friction_patches;
    log_.Get(i, request);
    messages_->Pack(request, rank, past.request);
    StepOne(rank, past);
  }
  StepOne(rank, messages_->step[rank]);
}

void RosTransport::StepOne(int rank, train_brake_msgs::Step& call) {
  LateWatch watch(ranks_, ExchangeText(call.request.exchange), options_.exchange_deadline_s, options_.interrupted);
  caller_->CallOne(rank, call, watch);
  if (!call.response.ok) throw RankFailure(ranks_[rank], watch.when(), call.response.message);
}

void RosTransport::WaitForRanks() {
  std::vector<bool> missing(ranks_.size(), true);
  const auto why_not = [&](std::size_t rank) {
    std::string why = missing[rank] ? caller_->Connect(static_cast<int>(rank)) : "";
    missing[rank] = !why.empty();
    return why;
  };
  const Clock::time_point start = Clock::now();
  double next_report_s = kSecondsPerReport;
  // Only the first missing rank is looked up until all of them are to be named, to spare the ROS master.
  for (std::size_t rank = 0; rank < ranks_.size();) {
    const std::string why = why_not(rank);
    if (why.empty()) {
      ++rank;
      continue;
    }
    if (options_.interrupted()) throw WaitInterrupted();
    const double waited_s = SecondsSince(start);
    const bool in_vain = options_.start_timeout_s > 0.0 && waited_s > options_.start_timeout_s;
    if (in_vain || waited_s > next_report_s) {
      for (std::size_t other = rank + 1; other < ranks_.size(); ++other) why_not(other);
      const std::string text = fmt::format("{} of {} wagon nodes are missing after {:.0f} s: {}; {}: {}",
                                           std::count(missing.begin(), missing.end(), true), ranks_.size(), waited_s,
                                           NamesOf(ranks_, missing), ranks_[rank].name, why);
      if (in_vain) throw RankFailure(text);
      ROS_WARN("%s", text.c_str());
      next_report_s += kSecondsPerReport;
    }
    std::this_thread::sleep_for(kRetry);
  }
}

}  // namespace ltd_master
