#include "train_run/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "train_console/console.h"

namespace train_run {
namespace {

constexpr double kTerminalPeriod = 0.2;  // [s] of wall time
constexpr double kQuietShare = 0.25;     // of the run

}  // namespace

Progress::Progress(double duration_s, double start_s)
    : duration_s_(duration_s), start_s_(start_s), on_terminal_(isatty(STDERR_FILENO) != 0) {
  next_s_ = on_terminal_ ? kTerminalPeriod : start_s_ + kQuietShare * (duration_s_ - start_s_);
}

void Progress::Finish() {
  if (line_open_) train_console::Tell("\n");
  line_open_ = false;
}

double Progress::WallSeconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

void Progress::Show(double simulated_s, double mean_speed_mps) {
  const double wall_s = WallSeconds();
  if (on_terminal_ ? wall_s < next_s_ && simulated_s < duration_s_ : simulated_s < next_s_) return;
  next_s_ = on_terminal_ ? wall_s + kTerminalPeriod : next_s_ + kQuietShare * (duration_s_ - start_s_);
  Print(simulated_s, mean_speed_mps, wall_s);
}

void Progress::Print(double simulated_s, double mean_speed_mps, double wall_s) {
  const double factor = (simulated_s - start_s_) / wall_s;
  const double left_s = std::max(0.0, (duration_s_ - simulated_s) / factor);
  train_console::WriteMessage(fmt::format("{}{:7.2f} of {:g} s   {:6.2f} km/h   {:6.1f} x real time   {:5.1f} s left{}",
                                          on_terminal_ ? "\r" : "", simulated_s, duration_s_,
                                          3.6 * mean_speed_mps + 0.0, factor, left_s, on_terminal_ ? "\x1b[K" : "\n"));
  line_open_ = on_terminal_;
}

}  // namespace train_run
