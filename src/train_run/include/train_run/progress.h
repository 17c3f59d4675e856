#pragma once

#include <chrono>

namespace train_run {

/// Shows the progress of a run: a line that is updated on a terminal, a few lines elsewhere. Writes to stderr.
class Progress {
 public:
  /// @param start_s  simulated time at which the run begins, later than 0 if it was resumed
  explicit Progress(double duration_s, double start_s = 0.0);
  ~Progress() { Finish(); }

  /// Cheap enough for every record.
  void Show(double simulated_s, double mean_speed_mps);

  /// Ends the line on a terminal, so that other output starts on one of its own.
  void Finish();

  double WallSeconds() const;

 private:
  void Print(double simulated_s, double mean_speed_mps, double wall_s);

  using Clock = std::chrono::steady_clock;
  double duration_s_, start_s_;
  bool on_terminal_;
  bool line_open_ = false;
  double next_s_ = 0.0;  ///< terminal: wall time, else simulated time, of the next line
  Clock::time_point start_ = Clock::now();
};

}  // namespace train_run
