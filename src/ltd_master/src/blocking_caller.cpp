#include <ros/node_handle.h>
#include <ros/service_client.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "ltd_master/rank_caller.h"

namespace ltd_master {
namespace {

using train_dynamics::Rank;

class BlockingCaller : public RankCaller {
 public:
  BlockingCaller(const std::vector<Rank>& ranks, int threads)
      : ranks_(ranks), configure_(ranks.size()), step_(ranks.size()), next_(static_cast<int>(ranks.size())) {
    const int size = std::clamp(threads, 1, static_cast<int>(ranks.size()));
    for (int i = 0; i < size; ++i) threads_.emplace_back(&BlockingCaller::Work, this);
  }

  ~BlockingCaller() override {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
    }
    start_.notify_all();
    // Ends the calls that are still waiting: they know no deadline.
    for (ros::ServiceClient& client : configure_) client.shutdown();
    for (ros::ServiceClient& client : step_) client.shutdown();
    for (std::thread& thread : threads_) thread.join();
  }

  std::string Connect(int rank) override {
    const std::string& name = ranks_[rank].name;
    const bool is_connected = Connect<train_brake_msgs::Configure>(name + "/configure", configure_[rank]) &&
                              Connect<train_brake_msgs::Step>(name + "/step", step_[rank]);
    return is_connected ? "" : "has not advertised";
  }

  int Call(std::vector<train_brake_msgs::Configure>& calls, LateWatch& watch) override {
    return CallAll([&](int rank) { return configure_[rank].call(calls[rank]); }, watch);
  }
  int Call(std::vector<train_brake_msgs::Step>& calls, LateWatch& watch) override {
    return CallAll([&](int rank) { return step_[rank].call(calls[rank]); }, watch);
  }

 private:
  template <class Service>
  bool Connect(const std::string& service, ros::ServiceClient& client) {
    if (!client.isValid()) client = node_.serviceClient<Service>(service, true);
    return client.isValid();
  }

  int CallAll(const std::function<bool(int)>& call, LateWatch& watch) {
    std::unique_lock<std::mutex> lock(mutex_);
    call_ = call;
    pending_.assign(ranks_.size(), true);
    left_ = ranks_.size();
    next_ = 0;
    start_.notify_all();
    const std::chrono::duration<double> glance(LateWatch::kGlance);
    while (!finish_.wait_for(lock, glance, [this] { return left_ == 0 || failed_ >= 0; })) {
      const std::vector<bool> pending = pending_;
      lock.unlock();
      watch.Look(pending);
      lock.lock();
    }
    const int failed = failed_;
    lock.unlock();
    if (failed >= 0) watch.GiveUp(failed, "the call failed; roscpp logs why, if it knows");
    return last_;
  }

  void Work() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      start_.wait(lock, [this] { return ending_ || next_ < static_cast<int>(ranks_.size()); });
      if (ending_) return;
      const int rank = next_++;
      lock.unlock();
      const bool done = call_(rank);
      lock.lock();
      if (done) {
        pending_[rank] = false;
        --left_;
        last_ = rank;
      } else {
        failed_ = rank;
      }
      if (left_ == 0 || failed_ >= 0) finish_.notify_one();
    }
  }

  ros::NodeHandle node_;
  const std::vector<Rank> ranks_;
  std::vector<ros::ServiceClient> configure_, step_;  ///< [rank]

  std::mutex mutex_;  ///< of all below
  std::condition_variable start_, finish_;
  std::function<bool(int)> call_;  ///< of one rank
  int next_;                       ///< rank to be called next
  std::vector<bool> pending_;      ///< [rank]
  std::size_t left_ = 0;           ///< ranks that have not replied
  int last_ = 0;                   ///< rank that replied last
  int failed_ = -1;                ///< rank whose call failed
  bool ending_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace

std::unique_ptr<RankCaller> MakeBlockingCaller(const std::vector<Rank>& ranks, int threads) {
  return std::make_unique<BlockingCaller>(ranks, threads);
}

}  // namespace ltd_master
