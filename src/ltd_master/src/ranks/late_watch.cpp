#include "ltd_master/ranks/late_watch.h"

#include <fmt/format.h>
#include <ros/console.h>

#include <algorithm>
#include <chrono>
#include <thread>

namespace ltd_master {
namespace {

constexpr int kNamed = 5;  // ranks that one message names
constexpr std::chrono::milliseconds kGrace(1000);

/// "/train/wagon_007 (vehicles 7-12), exchange 17: closed the connection"
std::string FailureText(const train_dynamics::Rank& rank, const std::string& when, const std::string& what) {
  return fmt::format("{} ({}), {}: {}", rank.name, VehiclesText(rank), when, what);
}

}  // namespace

RankFailure::RankFailure(const train_dynamics::Rank& rank, const std::string& when, const std::string& what)
    : RankFailure(FailureText(rank, when, what)) {}

std::string NamesOf(const std::vector<train_dynamics::Rank>& ranks, const std::vector<bool>& chosen) {
  std::string names;
  int count = 0;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    if (!chosen[i] || ++count > kNamed) continue;
    names += fmt::format("{}{} ({})", count > 1 ? ", " : "", ranks[i].name, VehiclesText(ranks[i]));
  }
  if (count > kNamed) names += fmt::format(" and {} more", count - kNamed);
  return names;
}

LateWatch::LateWatch(const std::vector<train_dynamics::Rank>& ranks, std::string when, double deadline_s,
                     const std::function<bool()>& interrupted)
    : ranks_(ranks), when_(std::move(when)), interrupted_(interrupted), patience_(deadline_s, interrupted) {}

bool LateWatch::Look(const std::vector<bool>& pending) {
  return patience_.Look([&](double waited_s) {
    ROS_WARN("%s: waiting for %.0f s already for %ld of %zu wagon nodes: %s", when_.c_str(), waited_s,
             std::count(pending.begin(), pending.end(), true), ranks_.size(), NamesOf(ranks_, pending).c_str());
  });
}

std::string LateWatch::NoReply() const { return fmt::format("no reply within {:g} s", patience_.deadline_s()); }

void LateWatch::GiveUp(const std::vector<LostRank>& lost) const {
  using Clock = std::chrono::steady_clock;
  for (const Clock::time_point end = Clock::now() + kGrace; Clock::now() < end;) {
    if (interrupted_()) throw WaitInterrupted();
    std::this_thread::sleep_for(kGrace / 50);
  }
  std::vector<std::string> texts;
  std::vector<bool> late(ranks_.size(), false);
  for (const LostRank& one : lost) {
    if (one.why == NoReply()) {
      late[one.rank] = true;
    } else {
      texts.push_back(FailureText(ranks_[one.rank], when_, one.why));
    }
  }
  if (texts.size() > kNamed) {
    texts[kNamed - 1] += fmt::format("; and {} more", texts.size() - kNamed);
    texts.resize(kNamed);
  }
  if (const std::string names = NamesOf(ranks_, late); !names.empty()) {
    texts.push_back(fmt::format("{}: {} from {}", when_, NoReply(), names));
  }
  throw RankFailure(fmt::format("{}", fmt::join(texts, "; ")));
}

}  // namespace ltd_master
