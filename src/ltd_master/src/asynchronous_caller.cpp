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

  template <class Service>
  int Call(std::vector<Service>& calls, LateWatch& watch) {
    pending_.assign(calls.size(), true);
    int rank = 0, last = 0;
    try {
      for (; rank < static_cast<int>(calls.size()); ++rank) {
        if (!links_[rank]->Send(calls[rank].request)) Watch(rank, EPOLL_CTL_MOD, EPOLLIN | EPOLLOUT);
      }
      std::array<epoll_event, 64> events;
      std::size_t left = calls.size();
      for (int wakes = 1; left > 0; ++wakes) {
        const int count = epoll_wait(epoll_, events.data(), events.size(), kGlanceMs);
        if (count == 0 || wakes % kWakesPerLook == 0) watch.Look(pending_);
        for (int i = 0; i < count; ++i) {
          rank = static_cast<int>(events[i].data.u32);
          if (!Serve(rank, events[i].events, calls[rank].response)) continue;
          --left;
          last = rank;
        }
      }
    } catch (const WaitInterrupted&) {
      throw;
    } catch (const RankFailure&) {
      throw;
    } catch (const std::exception& e) {  // of a link, or of a reply that cannot be unpacked
      watch.GiveUp(rank, e.what());
    }
    return last;
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

  /// Moves bytes as far as they go. @return whether the rank's reply has become complete
  template <class Response>
  bool Serve(int rank, std::uint32_t events, Response& response) {
    ServiceLink& link = *links_[rank];
    if ((events & EPOLLOUT) != 0 && link.Flush()) Watch(rank, EPOLL_CTL_MOD, EPOLLIN);
    if ((events & ~static_cast<std::uint32_t>(EPOLLOUT)) == 0) return false;
    if (!pending_[rank]) {
      link.ExpectSilence();
      return false;
    }
    if (!link.Receive(response)) return false;
    pending_[rank] = false;
    return true;
  }

  std::vector<std::unique_ptr<ServiceLink>> links_;  ///< [rank]
  std::vector<bool> pending_;
  const int epoll_;
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

  int Call(std::vector<train_brake_msgs::Configure>& calls, LateWatch& watch) override {
    return configure_.Call(calls, watch);
  }
  int Call(std::vector<train_brake_msgs::Step>& calls, LateWatch& watch) override {
    return step_.Call(calls, watch);
  }

 private:
  const std::vector<Rank> ranks_;
  FanOut configure_, step_;
};

}  // namespace

std::unique_ptr<RankCaller> MakeAsynchronousCaller(const std::vector<Rank>& ranks) {
  return std::make_unique<AsynchronousCaller>(ranks);
}

}  // namespace ltd_master
