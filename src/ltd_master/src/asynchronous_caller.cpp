#include <poll.h>
#include <ros/service_manager.h>
#include <ros/service_traits.h>
#include <sys/epoll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <system_error>

#include "ltd_master/rank_caller.h"
#include "ltd_master/service_link.h"

namespace ltd_master {
namespace {

using train_dynamics::Rank;

constexpr double kHandshake = 1.0;  // [s] for a node that has advertised to accept a connection
constexpr int kWakesPerLook = 256;  // so that a trickle of bytes cannot outlast the deadline

/// Links to one service of all ranks, waited for together.
class FanOut {
 public:
  explicit FanOut(std::size_t ranks) : links_(ranks), epoll_(epoll_create1(EPOLL_CLOEXEC)) {
    if (epoll_ < 0) throw std::system_error(errno, std::generic_category(), "epoll_create1");
  }
  ~FanOut() { close(epoll_); }
  FanOut(const FanOut&) = delete;
  FanOut& operator=(const FanOut&) = delete;

  /// @return why the service cannot be reached yet; empty: it is linked
  template <class Service>
  std::string Connect(int rank, const std::string& service) {
    if (links_[rank] != nullptr) return "";
    std::string host;
    std::uint32_t port = 0;
    if (!ros::ServiceManager::instance()->lookupService(service, host, port)) return "has not advertised";
    try {
      links_[rank] = std::make_unique<ServiceLink>(service, host, port,
                                                   ros::service_traits::md5sum<Service>(), kHandshake);
    } catch (const LinkRefused&) {
      throw;
    } catch (const LinkError& e) {
      return e.what();
    }
    Watch(rank, EPOLL_CTL_ADD, EPOLLIN);
    return "";
  }

  void Disconnect(int rank) { links_[rank].reset(); }

  template <class Service>
  CallOutcome Call(std::vector<Service>& calls, LateWatch& watch) {
    pending_.assign(calls.size(), true);
    outcome_ = {};
    left_ = calls.size();
    for (int rank = 0; rank < static_cast<int>(calls.size()); ++rank) {
      Attempt(rank, [&] {
        if (links_[rank] == nullptr) throw LinkError("is not connected");
        if (!links_[rank]->Send(calls[rank].request)) Watch(rank, EPOLL_CTL_MOD, EPOLLIN | EPOLLOUT);
      });
    }
    std::array<epoll_event, 64> events;
    for (int wakes = 1; left_ > 0; ++wakes) {
      const int count = epoll_wait(epoll_, events.data(), events.size(), kGlanceMs);
      if ((count == 0 || wakes % kWakesPerLook == 0) && !watch.Look(pending_)) {
        for (int rank = 0; rank < static_cast<int>(calls.size()); ++rank) {
          if (pending_[rank]) Lose(rank, watch.NoReply());
        }
        break;
      }
      for (int i = 0; i < count; ++i) {
        const int rank = static_cast<int>(events[i].data.u32);
        Attempt(rank, [&] { Serve(rank, events[i].events, calls[rank].response); });
      }
    }
    return outcome_;
  }

  template <class Service>
  void CallOne(int rank, Service& call, LateWatch& watch) {
    if (links_[rank] == nullptr) throw LinkError("is not connected");
    ServiceLink& link = *links_[rank];
    std::vector<bool> pending(links_.size(), false);
    pending[rank] = true;
    bool is_sent = link.Send(call.request);
    while (!is_sent || !link.Receive(call.response)) {
      if (!link.Wait(is_sent ? POLLIN : POLLOUT, LateWatch::kGlance) && !watch.Look(pending)) {
        throw LinkError(watch.NoReply());
      }
      if (!is_sent) is_sent = link.Flush();
    }
  }

 private:
  static constexpr int kGlanceMs = static_cast<int>(1e3 * LateWatch::kGlance);

  void Watch(int rank, int operation, std::uint32_t events) {
    epoll_event event{};
    event.events = events;
    event.data.u32 = static_cast<std::uint32_t>(rank);
    if (epoll_ctl(epoll_, operation, links_[rank]->descriptor(), &event) != 0) {
      throw std::system_error(errno, std::generic_category(), "epoll_ctl");
    }
  }

  /// Does something with a rank's link; who fails in it is lost.
  template <class Action>
  void Attempt(int rank, Action action) {
    try {
      action();
    } catch (const std::exception& e) {  // of the link, or of a reply that cannot be unpacked
      Lose(rank, e.what());
    }
  }

  void Lose(int rank, const std::string& why) {
    Disconnect(rank);
    outcome_.lost.push_back({rank, why});
    if (pending_[rank]) --left_;
    pending_[rank] = false;
  }

  /// Moves bytes as far as they go.
  template <class Response>
  void Serve(int rank, std::uint32_t events, Response& response) {
    ServiceLink& link = *links_[rank];
    if ((events & EPOLLOUT) != 0 && link.Flush()) Watch(rank, EPOLL_CTL_MOD, EPOLLIN);
    if ((events & ~static_cast<std::uint32_t>(EPOLLOUT)) == 0) return;
    if (!pending_[rank]) {
      link.ExpectSilence();
    } else if (link.Receive(response)) {
      pending_[rank] = false;
      --left_;
      outcome_.last_rank = rank;
    }
  }

  std::vector<std::unique_ptr<ServiceLink>> links_;  ///< [rank] null: not connected
  const int epoll_;
  // Of the present call:
  std::vector<bool> pending_;  ///< [rank] whether it has yet to reply
  std::size_t left_ = 0;       ///< how many have
  CallOutcome outcome_;
};

class AsynchronousCaller : public RankCaller {
 public:
  explicit AsynchronousCaller(const std::vector<Rank>& ranks)
      : ranks_(ranks), configure_(ranks.size()), step_(ranks.size()) {}

  std::string Connect(int rank) override {
    const std::string& name = ranks_[rank].name;
    try {
      const std::string why = configure_.Connect<train_brake_msgs::Configure>(rank, name + "/configure");
      return !why.empty() ? why : step_.Connect<train_brake_msgs::Step>(rank, name + "/step");
    } catch (const LinkRefused& e) {
      throw RankFailure(ranks_[rank], "connection", e.what());
    }
  }

  void Disconnect(int rank) override {
    configure_.Disconnect(rank);
    step_.Disconnect(rank);
  }

  CallOutcome Call(std::vector<train_brake_msgs::Configure>& calls, LateWatch& watch) override {
    return CallAll(configure_, calls, watch);
  }
  CallOutcome Call(std::vector<train_brake_msgs::Step>& calls, LateWatch& watch) override {
    return CallAll(step_, calls, watch);
  }
  void CallOne(int rank, train_brake_msgs::Configure& call, LateWatch& watch) override {
    CallOne(configure_, rank, call, watch);
  }
  void CallOne(int rank, train_brake_msgs::Step& call, LateWatch& watch) override {
    CallOne(step_, rank, call, watch);
  }

 private:
  template <class Service>
  CallOutcome CallAll(FanOut& links, std::vector<Service>& calls, LateWatch& watch) {
    const CallOutcome outcome = links.Call(calls, watch);
    for (const LostRank& lost : outcome.lost) Disconnect(lost.rank);
    return outcome;
  }

  template <class Service>
  void CallOne(FanOut& links, int rank, Service& call, LateWatch& watch) {
    try {
      links.CallOne(rank, call, watch);
    } catch (const WaitInterrupted&) {
      Disconnect(rank);
      throw;
    } catch (const std::exception& e) {
      Disconnect(rank);
      throw RankLost(ranks_[rank], watch.when(), e.what());
    }
  }

  const std::vector<Rank> ranks_;
  FanOut configure_, step_;
};

}  // namespace

std::unique_ptr<RankCaller> MakeAsynchronousCaller(const std::vector<Rank>& ranks) {
  return std::make_unique<AsynchronousCaller>(ranks);
}

}  // namespace ltd_master
