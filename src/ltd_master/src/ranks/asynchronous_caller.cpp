#include <ros/console.h>
#include <ros/service_manager.h>
#include <ros/service_traits.h>

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "ltd_master/ranks/rank_caller.h"
#include "ltd_master/ranks/service_link.h"
#include "ltd_master/ranks/shared_slots.h"

namespace ltd_master {
namespace {

using train_brake_msgs::Configure;
using train_brake_msgs::Step;
using train_dynamics::Rank;

constexpr double kHandshake = 1.0;  // [s] for a node that has advertised to accept a connection

using Links = std::vector<std::unique_ptr<ServiceLink>>;  // [rank] null: not connected

/// One call of all ranks: through shared memory for ranks that have a slot, through links for the others.
template <class Service>
class CallOfAll {
 public:
  CallOfAll(Links& links, std::vector<Service>& calls, LateWatch& watch)
      : links_(links), calls_(calls), watch_(watch), pending_(calls.size(), true) {}

  CallOutcome Run() {
    for (int rank = 0; rank < ranks(); ++rank) SendByLink(rank);
    while (!on_links_.empty()) AwaitLink();
    return outcome_;
  }

  CallOutcome Run(SharedSlots& slots) {
    for (int rank = 0; rank < ranks(); ++rank) {
      if (slots.Has(rank)) {
        in_slots_.push_back(rank);
      } else {
        SendByLink(rank);
      }
    }
    if (!in_slots_.empty()) CallSlots(slots);
    while (!on_links_.empty()) AwaitLink();
    return outcome_;
  }

 private:
  using Clock = std::chrono::steady_clock;

  int ranks() const { return static_cast<int>(calls_.size()); }

  void SendByLink(int rank) {
    Attempt(rank, [&] {
      if (links_[rank] == nullptr) throw LinkError("is not connected");
      links_[rank]->Send(calls_[rank].request);
      on_links_.push_back(rank);
    });
  }

  void CallSlots(SharedSlots& slots) {
    slots.Send(calls_);
    while (!in_slots_.empty()) {
      slots.Wait(LateWatch::kCheckPeriod);
      const auto is_over = [&](int rank) { return pending_[rank] ? ReadSlot(slots, rank) : true; };
      in_slots_.erase(std::remove_if(in_slots_.begin(), in_slots_.end(), is_over), in_slots_.end());
      CheckOthers();
    }
    const int last_rank = slots.last_rank();
    if (last_rank >= 0) outcome_.last_rank = last_rank;  // else the last reply came from a process given up
  }

  /// @return whether nothing more is to be expected there
  bool ReadSlot(const SharedSlots& slots, int rank) {
    SharedSlots::Reply reply = SharedSlots::Reply::kNone;
    Attempt(rank, [&] { reply = slots.Read(rank, calls_[rank].response); });
    if (reply == SharedSlots::Reply::kRead) pending_[rank] = false;
    if (reply == SharedSlots::Reply::kTooLarge) SendByLink(rank);  // which gives the same reply
    return !pending_[rank] || reply == SharedSlots::Reply::kTooLarge;
  }

  /// Waits for the last rank of those that are left: they finish about in the order in which they were asked, so
  /// most of the others have replied by then, and the master is not woken once for each.
  void AwaitLink() {
    const int rank = on_links_.back();
    on_links_.pop_back();
    ReadLink(rank);
    while (pending_[rank]) {
      links_[rank]->Wait(LateWatch::kCheckPeriod);
      ReadLink(rank);
      outcome_.last_rank = rank;
      CheckOthers();
    }
  }

  void ReadLink(int rank) {
    if (!pending_[rank]) return;
    Attempt(rank, [&] { pending_[rank] = !links_[rank]->Receive(calls_[rank].response); });
  }

  /// Ten times a second of waiting: looks at all links, and at the watch.
  void CheckOthers() {
    const Clock::time_point now = Clock::now();
    if (now < next_check_) return;
    next_check_ = now + kCheckPeriod;
    for (const int rank : on_links_) ReadLink(rank);
    for (const int rank : in_slots_) Attempt(rank, [&] { links_[rank]->ExpectSilence(); });
    if (watch_.Look(pending_)) return;
    for (int rank = 0; rank < ranks(); ++rank) {
      if (pending_[rank]) Lose(rank, watch_.NoReply());
    }
  }

  /// Executes an action on a rank; the rank is lost if it fails.
  template <class Action>
  void Attempt(int rank, Action action) {
    try {
      action();
    } catch (const std::exception& e) {  // of the link, or of a reply that cannot be read
      Lose(rank, e.what());
    }
  }

  void Lose(int rank, const std::string& why) {
    links_[rank].reset();
    pending_[rank] = false;
    outcome_.lost.push_back({rank, why});
  }

  static constexpr auto kCheckPeriod =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(LateWatch::kCheckPeriod));

  Links& links_;
  std::vector<Service>& calls_;
  LateWatch& watch_;
  std::vector<bool> pending_;             ///< [rank] whether it has yet to reply
  std::vector<int> in_slots_, on_links_;  ///< ranks whose replies are expected there
  Clock::time_point next_check_ = Clock::now() + kCheckPeriod;
  CallOutcome outcome_;
};

class AsynchronousCaller : public RankCaller {
 public:
  AsynchronousCaller(const std::vector<Rank>& ranks, std::unique_ptr<SharedSlots> slots)
      : ranks_(ranks), configure_(ranks.size()), step_(ranks.size()), slots_(std::move(slots)) {}

  std::string Connect(int rank) override {
    const std::string& name = ranks_[rank].name;
    const std::string why = Connect<Configure>(rank, name + "/configure", configure_[rank]);
    return !why.empty() ? why : Connect<Step>(rank, name + "/step", step_[rank]);
  }
  void Disconnect(int rank) override {
    configure_[rank].reset();
    step_[rank].reset();
    if (slots_ != nullptr) slots_->Drop(rank);
  }

  CallOutcome Call(std::vector<Configure>& calls, LateWatch& watch) override {
    for (int rank = 0; rank < static_cast<int>(calls.size()); ++rank) Offer(rank, calls[rank]);
    CallOutcome outcome = DisconnectLost(CallOfAll<Configure>(configure_, calls, watch).Run());
    for (int rank = 0; rank < static_cast<int>(calls.size()); ++rank) Settle(rank, calls[rank]);
    return outcome;
  }
  CallOutcome Call(std::vector<Step>& calls, LateWatch& watch) override {
    CallOfAll<Step> call(step_, calls, watch);
    return DisconnectLost(slots_ != nullptr ? call.Run(*slots_) : call.Run());
  }
  void CallOne(int rank, Configure& call, LateWatch& watch) override {
    Offer(rank, call);
    CallByLink(configure_, rank, call, watch);
    Settle(rank, call);
  }
  void CallOne(int rank, Step& call, LateWatch& watch) override { CallByLink(step_, rank, call, watch); }

 private:
  template <class Service>
  std::string Connect(int rank, const std::string& service, std::unique_ptr<ServiceLink>& link) const {
    if (link != nullptr) return "";
    std::string host;
    std::uint32_t port = 0;
    if (!ros::ServiceManager::instance()->lookupService(service, host, port)) return WhyNotFound();
    try {
      link = std::make_unique<ServiceLink>(service, host, port, ros::service_traits::md5sum<Service>(), kHandshake);
    } catch (const LinkRefused& e) {
      throw RankFailure(ranks_[rank], "connection", e.what());
    } catch (const LinkError& e) {
      return e.what();
    }
    return "";
  }

  CallOutcome DisconnectLost(CallOutcome outcome) {
    for (const LostRank& lost : outcome.lost) Disconnect(lost.rank);
    return outcome;
  }

  template <class Service>
  void CallByLink(const Links& links, int rank, Service& call, LateWatch& watch) {
    try {
      if (links[rank] == nullptr) throw LinkError("is not connected");
      ServiceLink& link = *links[rank];
      std::vector<bool> pending(ranks_.size(), false);
      pending[rank] = true;
      link.Send(call.request);
      while (!link.Receive(call.response)) {
        if (!link.Wait(LateWatch::kCheckPeriod) && !watch.Look(pending)) throw LinkError(watch.NoReply());
      }
    } catch (const WaitInterrupted&) {
      Disconnect(rank);
      throw;
    } catch (const std::exception& e) {
      Disconnect(rank);
      throw RankLost(ranks_[rank], watch.when(), e.what());
    }
  }

  void Offer(int rank, Configure& call) {
    if (slots_ != nullptr) slots_->Offer(rank, call.request);
  }
  void Settle(int rank, const Configure& call) {
    if (slots_ != nullptr) slots_->Settle(rank, call.response);
  }

  const std::vector<Rank> ranks_;
  Links configure_, step_;
  const std::unique_ptr<SharedSlots> slots_;  ///< null: all calls go through links
};

}  // namespace

std::unique_ptr<RankCaller> MakeAsynchronousCaller(const std::vector<Rank>& ranks, std::uint64_t run_id) {
  std::unique_ptr<SharedSlots> slots;
  if (run_id != 0) {
    try {
      slots = std::make_unique<SharedSlots>(ranks, run_id);
    } catch (const std::exception& e) {
      ROS_DEBUG("no memory can be shared with wagon nodes: %s", e.what());
    }
  }
  return std::make_unique<AsynchronousCaller>(ranks, std::move(slots));
}

}  // namespace ltd_master
