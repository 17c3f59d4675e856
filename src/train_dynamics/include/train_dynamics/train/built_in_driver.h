#pragma once

#include <optional>
#include <vector>

#include "train_dynamics/brake/brake_system.h"
#include "train_dynamics/traction/locomotive.h"
#include "train_dynamics/train/consist.h"
#include "train_dynamics/train/driver_command.h"
#include "train_dynamics/train/driver_params.h"
#include "train_dynamics/train/driver_view.h"

namespace train_dynamics {

/// What the driver knows of the train before the start: its consist, and how its brake responds.
struct DriversTrain {
  struct Locomotives {
    TractionParams traction;
    double driven_weight_n;
    int count;
  };
  double mass_kg = 0.0, moving_mass_kg = 0.0;  ///< the second with what rotates
  std::vector<Locomotives> locomotives;
  int throttle_notches = 0,
      dynamic_brake_notches = 0;    ///< that all of them have, or all that have a dynamic brake
  std::vector<int> dynamic_brakes;  ///< vehicles that have one, from 1; empty: all locomotives have
  bool graduated_release = false;
  /// Force of all shoes [N] at 0, 10 ... 120 km/h with the first and with the largest reduction.
  std::vector<double> first_brake_n, largest_brake_n;
  std::vector<double> application_share;  ///< of the first reduction's force, after 0, 1 ... 60 s
  double release_time_s = 0.0;            ///< until 1/e of the force is left

  /// Steady effort of all locomotives [N]: traction positive. @param lever  notch; negative: of the dynamic brake
  double Effort(int lever, double speed_mps) const;
  /// Steady force of all shoes [N] with a reduction; linear between the two that are known, 0 without.
  double BrakeForce(const BuiltInDriverParams& p, double reduction_kpa, double speed_mps) const;
  double ApplicationShare(double time_s) const;
};

/// Collects this knowledge. The brake's responses are those of the scenario's brake on a train at rest.
DriversTrain MakeDriversTrain(const BuiltInDriverParams& p, const BrakeSystemParams& brake, const Consist& consist);

/// What the built-in driver remembers from one period to the next.
struct BuiltInDriverState {
  double lever = 0.0;            ///< notch that is set; negative: of the dynamic brake
  double lever_s = -1e9;         ///< time of the last notch up
  double handle_s = -1e9;        ///< time of the last movement of the brake handle
  double released_s = -1e9;      ///< time of the last release
  double air_n = 0.0;            ///< force of the shoes, as estimated
  double resistance_mps2 = 0.0;  ///< learnt resistance of the train, as a deceleration
  double stop = 0.0;             ///< index of the next stop
  double is_stopping = 0.0;      ///< 1: the last application before a stop is made
  double standing_s = -1.0;      ///< since when the train has stood at the stop; < 0: it does not

  template <class Function>
  void ForEachField(Function&& function) {
    function(lever), function(lever_s), function(handle_s), function(released_s), function(air_n);
    function(resistance_mps2), function(stop), function(is_stopping), function(standing_s);
  }
};

/// The highest speed [m/s] that a driver holds at this place, and the deceleration [m/s2] (<= 0) that it asks for.
///
/// The lowest of: the speed to hold; the limit under the train, less the margin; and, for each lower limit v_l ahead at
/// a distance s, less the distance covered in `lead_s`, sqrt(v_l^2 + 2 b s) with b = deceleration_mps2; likewise
/// towards the stop, with the creep speed. b counts where one of the last two is the lowest.
struct SpeedGoal {
  double speed_mps;
  double acceleration_mps2;
};
SpeedGoal GoalAt(const BuiltInDriverParams& p, const DriverView& view, const std::optional<double>& stop_m,
                 double lead_s);

/// Distance [m] to standstill when the reduction is made now: one mass, v' = -(A share(t) + M g i + M r) / M_moving.
double StoppingDistance(const BuiltInDriverParams& p, const DriversTrain& train, double reduction_kpa,
                        double resistance_mps2, const DriverView& view, double air_n);

/// The driver's commands of this period.
///
///   force = M_moving (b c + (goal - v) / T) + M (g i + r)      c = 2 v / goal - 1 in [0, 1]; r learnt, i the mean
///   grade
///
/// The force is given by these rules: traction and brakes never work together, except to start uphill; the dynamic
/// brake comes first, and the air brake takes what it cannot give; on a falling demand the air brake goes first. The
/// lever goes up a notch when the demand exceeds 0.7 of the step to it. The air brake: a first reduction, steps to what
/// is needed, at most the largest; a graduated-release brake is reduced in steps, a direct-release one is released once
/// the dynamic brake alone is more than enough; after a release the driver waits recharge_time_s, and re-applies one
/// step deeper if the speed does not allow that. A stop: creep, then the reduction whose predicted distance fits, then
/// the largest at rest. After an emergency it closes the throttle, and does nothing more before a release.
///
/// Left out: driving backwards, several controls of distributed power, slack.
///
/// @param stops_m  [stop] first vehicle's centre
std::vector<DriverCommand> Drive(const BuiltInDriverParams& p, const DriversTrain& train,
                                 const std::vector<double>& stops_m, const DriverView& view, BuiltInDriverState& state);

/// Positions of the stops. Stations must be known to the route.
std::vector<double> StopPositions(const BuiltInDriverParams& p, const TrackParams& track);

}  // namespace train_dynamics
