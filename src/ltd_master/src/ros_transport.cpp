#include "ltd_master/ros_transport.h"

#include <fmt/format.h>
#include <ros/console.h>
#include <ros/names.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "ltd_master/rank_caller.h"
#include "ltd_master/rank_messages.h"

namespace ltd_master {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kSecondsPerReport = 5.0;  // on who has not come up yet
constexpr std::chrono::milliseconds kRetry(100);
constexpr rlim_t kDescriptorsPerRank = 2;
constexpr rlim_t kOtherDescriptors = 256;  // of roscpp, bag, logs

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
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
                           const std::string& scenario_text, RosTransportOptions options)
    : ranks_(std::move(ranks)), options_(std::move(options)) {
  for (train_dynamics::Rank& rank : ranks_) rank.name = ros::names::resolve(rank.name);
  RaiseDescriptorLimit(ranks_.size());
  messages_ = std::make_unique<RankMessages>(ranks_, run_id, scenario_text);
  caller_ = options_.blocking_threads > 0 ? MakeBlockingCaller(ranks_, options_.blocking_threads)
                                          : MakeAsynchronousCaller(ranks_);
}

RosTransport::~RosTransport() = default;

void RosTransport::Start(train_dynamics::ExchangeReply& reply) {
  WaitForRanks();
  LateWatch watch(ranks_, kConfiguration, options_.start_timeout_s, options_.interrupted);
  const CallOutcome outcome = caller_->Call(messages_->configure, watch);
  if (!outcome.lost.empty()) watch.GiveUp(outcome.lost);
  messages_->Unpack(reply);
}

void RosTransport::Exchange(const train_dynamics::ExchangeRequest& request,
                            train_dynamics::ExchangeReply& reply) {
  const Clock::time_point start = Clock::now();
  messages_->Pack(request);
  LateWatch watch(ranks_, ExchangeText(request.exchange), options_.exchange_deadline_s, options_.interrupted);
  const CallOutcome outcome = caller_->Call(messages_->step, watch);
  if (!outcome.lost.empty()) watch.GiveUp(outcome.lost);
  messages_->Unpack(request, reply);
  timing_.wall_s = SecondsSince(start);
  timing_.last_rank = outcome.last_rank;
  timing_.was_late = watch.was_late();
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
  // Asking for the first that is missing is enough until they are to be named: it spares the ROS master.
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
                                           std::count(missing.begin(), missing.end(), true), ranks_.size(),
                                           waited_s, NamesOf(ranks_, missing), ranks_[rank].name, why);
      if (in_vain) throw RankFailure(text);
      ROS_WARN("%s", text.c_str());
      next_report_s += kSecondsPerReport;
    }
    std::this_thread::sleep_for(kRetry);
  }
}

}  // namespace ltd_master
