#pragma once

#include <train_brake_msgs/Drive.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "ltd_master/ranks/service_link.h"

namespace ltd_master {

/// What happens to a train whose driver is lost.
enum class OnLostDriver {
  kEmergency,  ///< the emergency brake is applied, traction and dynamic brake are off
  kHold,       ///< everything stays as the driver has left it
  kStop,       ///< the run ends
};

struct LockstepDriverOptions {
  std::string node;               ///< node whose service ~drive is called; empty: no driver in lockstep
  double control_period_s = 0.1;  ///< simulated; a multiple of the exchange interval
  double start_timeout_s = 60.0;  ///< [wall time] for the driver to start; 0: no limit
  double deadline_s = 30.0;       ///< [wall time] for each answer; 0: no limit
  OnLostDriver on_lost = OnLostDriver::kEmergency;
  double sight_m = 5000.0;                                   ///< how far the driver sees and knows the line
  bool sees_couplers = false;                                ///< the driver is shown the forces in all couplers
  std::function<bool()> interrupted = [] { return false; };  ///< polled ten times a second while waiting
};

/// A failure of the driver that ends the run: its node did not start, has another protocol version, or was lost while
/// on_lost_driver is `stop`.
class DriverFailure : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A driver in another node, in lockstep with the train: called at the start of every control period, and waited for
/// (Drive.srv). A late driver is reported after 1, 3 and 10 s, and counts as lost at the deadline, when its connection
/// breaks, or when its answer is invalid. A lost driver is not called again.
class LockstepDriver {
 public:
  using Commands = std::vector<train_brake_msgs::DriverCommand>;

  /// @param exchange_interval_s  of the run
  /// @throws std::invalid_argument if the control period is not a multiple of it
  LockstepDriver(LockstepDriverOptions options, std::uint64_t run_id, double exchange_interval_s);

  /// Whether the driver is due before that exchange.
  bool IsDue(std::uint64_t exchange) const { return lost_.empty() && exchange % exchanges_ == 0; }
  /// Waits until the driver's service can be called; logs its name every 5 s.
  /// @throws DriverFailure, WaitInterrupted
  void Connect();
  /// The driver's commands; none if the driver is lost in the call, which is logged as a warning. See IsLost.
  /// @throws DriverFailure, WaitInterrupted
  Commands Ask(const train_brake_msgs::DriverView& view);
  /// Reports to the driver, with the next request, what the train could not obey.
  void Refuse(const std::string& sentence);

  bool IsLost() const { return !lost_.empty(); }
  const std::string& lost() const { return lost_; }  ///< why the driver is lost; empty: it is not
  const std::string& name() const { return options_.node; }
  const LockstepDriverOptions& options() const { return options_; }
  unsigned late_answers() const { return late_answers_; }  ///< answers that took a second or longer

 private:
  void Call(std::uint64_t exchange);
  void Lose(std::uint64_t exchange, const std::string& why);

  LockstepDriverOptions options_;
  std::uint64_t exchanges_ = 1;  ///< in a control period
  train_brake_msgs::Drive call_;
  std::unique_ptr<ServiceLink> link_;
  std::string lost_;
  unsigned late_answers_ = 0;
};

}  // namespace ltd_master
