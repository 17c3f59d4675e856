#pragma once

#include <algorithm>
#include <array>

namespace train_dynamics {

/// Selects the faster of two ways to do a repeated task. Both are measured, again and again, because the other load of
/// the machine changes.
///
/// Way 0 is taken first. The other way is tried when it has not been for a while, and at once when the present one has
/// become slower than the other one was. A trial ends early where the other way is slower; as long as it stays slower,
/// each interval between trials is twice the one before. Means are compared, not medians: where a thread has to wait
/// for its core, most rounds are fast and few take a hundred times as long.
class FasterWay {
 public:
  static constexpr double kShortest = 5e-3, kTrial = 20e-3;  ///< of work that a judgement is based on [s]
  static constexpr double kFirstWhile = 0.25, kLongestWhile = 4.0;

  /// The way to take next: 0 or 1.
  int way() const { return way_; }

  /// How long the round took that way [s].
  void Took(double seconds) {
    sum_s_ += seconds;
    since_trial_s_ += seconds;
    rounds_ += 1.0;
    if (sum_s_ < kShortest) return;
    const double mean_s = sum_s_ / rounds_, other_s = mean_s_[1 - way_];
    if (is_trial_ && mean_s > other_s) {
      mean_s_[way_] = mean_s;
      while_s_ = std::min(2.0 * while_s_, kLongestWhile);
      Take(1 - way_, false);
      return;
    }
    if (sum_s_ < kTrial) return;
    mean_s_[way_] = mean_s;
    if (is_trial_) {
      while_s_ = kFirstWhile;
      Take(way_, false);
    } else if (mean_s > other_s || since_trial_s_ > while_s_) {
      Take(1 - way_, true);
    } else {
      sum_s_ = rounds_ = 0.0;
    }
  }

 private:
  void Take(int way, bool is_trial) {
    way_ = way;
    is_trial_ = is_trial;
    sum_s_ = rounds_ = since_trial_s_ = 0.0;
  }

  int way_ = 0;
  bool is_trial_ = false;
  double while_s_ = kFirstWhile;
  double sum_s_ = 0.0, rounds_ = 0.0, since_trial_s_ = 0.0;
  /// Of a round, as last measured; way 1 is tried as soon as way 0 has been.
  std::array<double, 2> mean_s_{0.0, 0.0};
};

}  // namespace train_dynamics
