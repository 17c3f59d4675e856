#include <ros/node_handle.h>
#include <ros/service.h>
#include <ros/service_client.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <numeric>
#include <system_error>
#include <thread>

#include "ltd_master/ranks/rank_caller.h"

namespace ltd_master {
namespace {

using train_dynamics::Rank;

class BlockingCaller : public RankCaller {
 public:
  BlockingCaller(const std::vector<Rank>& ranks, int threads)
      : ranks_(ranks), configure_(ranks.size()), step_(ranks.size()) {
    const int size = std::clamp(threads, 1, static_cast<int>(ranks.size()));
    try {
      for (int i = 0; i < size; ++i) threads_.emplace_back(&BlockingCaller::Work, this);
    } catch (const std::system_error&) {
      End();
      throw;
    }
  }

  ~BlockingCaller() override { End(); }

  std::string Connect(int rank) override {
    const std::string& name = ranks_[rank].name;
    const bool is_connected = Connect<train_brake_msgs::Configure>(name + "/configure", configure_[rank]) &&
                              Connect<train_brake_msgs::Step>(name + "/step", step_[rank]);
    return is_connected ? "" : WhyNotFound();
  }
  void Disconnect(int rank) override {
    BreakOff(rank);
    configure_[rank] = step_[rank] = ros::ServiceClient();
  }

  CallOutcome Call(std::vector<train_brake_msgs::Configure>& calls, LateWatch& watch) override {
    return CallAll([&](int rank) { return Ask(configure_[rank], calls[rank]); }, watch);
  }
  CallOutcome Call(std::vector<train_brake_msgs::Step>& calls, LateWatch& watch) override {
    return CallAll([&](int rank) { return Ask(step_[rank], calls[rank]); }, watch);
  }
  void CallOne(int rank, train_brake_msgs::Configure& call, LateWatch& watch) override {
    CallOne(
        rank, [&](int /*rank*/) { return Ask(configure_[rank], call); }, watch);
  }
  void CallOne(int rank, train_brake_msgs::Step& call, LateWatch& watch) override {
    CallOne(
        rank, [&](int /*rank*/) { return Ask(step_[rank], call); }, watch);
  }

 private:
  using RankCall = std::function<bool(int rank)>;

  void End() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
    }
    start_.notify_all();
    for (int rank = 0; rank < static_cast<int>(ranks_.size()); ++rank) BreakOff(rank);
    for (std::thread& thread : threads_) thread.join();
  }

  template <class Service>
  bool Connect(const std::string& service, ros::ServiceClient& client) {
    // A process that was killed stays advertised: whether there is one is asked first.
    if (!client.isValid() && ros::service::exists(service, false)) {
      client = node_.serviceClient<Service>(service, true);
    }
    return client.isValid();
  }

  template <class Service>
  static bool Ask(ros::ServiceClient& client, Service& call) {
    return client.isValid() && client.call(call);
  }

  /// Ends a call that is still waiting: it knows no deadline.
  void BreakOff(int rank) {
    configure_[rank].shutdown();
    step_[rank].shutdown();
  }

  CallOutcome CallAll(const RankCall& call, LateWatch& watch) {
    std::deque<int> all(ranks_.size());
    std::iota(all.begin(), all.end(), 0);
    return CallThese(std::move(all), call, watch);
  }

  void CallOne(int rank, const RankCall& call, LateWatch& watch) {
    const CallOutcome outcome = CallThese({rank}, call, watch);
    if (!outcome.lost.empty()) throw RankLost(ranks_[rank], watch.when(), outcome.lost.front().why);
  }

  CallOutcome CallThese(std::deque<int> ranks, const RankCall& call, LateWatch& watch) {
    std::unique_lock<std::mutex> lock(mutex_);
    call_ = &call;
    outcome_ = {};
    pending_.assign(ranks_.size(), false);
    for (const int rank : ranks) pending_[rank] = true;
    queue_ = std::move(ranks);
    left_ = queue_.size();
    start_.notify_all();
    const std::chrono::duration<double> glance(LateWatch::kGlance);
    while (!finish_.wait_for(lock, glance, [this] { return left_ == 0; })) {
      const std::vector<bool> pending = pending_;
      lock.unlock();
      bool in_time = false;
      try {
        in_time = watch.Look(pending);
      } catch (const WaitInterrupted&) {
        lock.lock();
        BreakOffPending(lock);
        throw;
      }
      lock.lock();
      if (in_time) continue;
      why_ = watch.NoReply();
      BreakOffPending(lock);
      why_ = kFailed;
    }
    for (const LostRank& lost : outcome_.lost) Disconnect(lost.rank);
    return outcome_;
  }

  /// Ends the calls that have not been replied to.
  void BreakOffPending(std::unique_lock<std::mutex>& lock) {
    for (const int rank : queue_) Finish(rank, false);
    queue_.clear();
    for (int rank = 0; rank < static_cast<int>(ranks_.size()); ++rank) {
      if (pending_[rank]) BreakOff(rank);
    }
    finish_.wait(lock, [this] { return left_ == 0; });
  }

  void Finish(int rank, bool replied) {
    pending_[rank] = false;
    --left_;
    if (replied) {
      outcome_.last_rank = rank;
    } else {
      outcome_.lost.push_back({rank, why_});
    }
  }

  void Work() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      start_.wait(lock, [this] { return ending_ || !queue_.empty(); });
      if (ending_) return;
      const int rank = queue_.front();
      queue_.pop_front();
      lock.unlock();
      const bool replied = (*call_)(rank);
      lock.lock();
      Finish(rank, replied);
      if (left_ == 0) finish_.notify_one();
    }
  }

  static constexpr const char* kFailed = "the call failed; roscpp logs why, if it knows";

  ros::NodeHandle node_;
  const std::vector<Rank> ranks_;
  std::vector<ros::ServiceClient> configure_, step_;  ///< [rank]

  std::mutex mutex_;  ///< of all below
  std::condition_variable start_, finish_;
  const RankCall* call_ = nullptr;  ///< the present call
  std::deque<int> queue_;           ///< ranks that it has not begun with
  std::vector<bool> pending_;       ///< [rank] whether it has yet to reply
  std::size_t left_ = 0;            ///< how many have
  std::string why_ = kFailed;       ///< a call that fails does so
  CallOutcome outcome_;
  bool ending_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace

std::unique_ptr<RankCaller> MakeBlockingCaller(const std::vector<Rank>& ranks, int threads) {
  return std::make_unique<BlockingCaller>(ranks, threads);
}

}  // namespace ltd_master
