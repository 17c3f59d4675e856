#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <variant>

#include "train_dynamics/parameters.h"
#include "train_dynamics/slide_protection/creep_control.h"
#include "train_dynamics/slide_protection/cylinder_valve.h"
#include "train_dynamics/slide_protection/threshold_3state.h"
#include "train_dynamics/slide_protection/wheel_reading.h"

/// Wheel-slide protection of a vehicle's brake: keeps braked wheels from locking on slippery rail.
///
/// The brake system supplies the vehicle; a valve lets the supply into the cylinder of each wheelset, holds it or vents
/// the cylinder, as a controller says every sampling period. Deterministic: a function of its own state and of the
/// number of the step.
namespace train_dynamics {

/// The closed set of controllers. Each has
///
///   ValveState Decide(const WheelReading& wheel) const
///
/// A new one: a header of this folder, an entry here, in SlideController and in SlideProtectionParams.
using SlideControllerLaw = std::variant<Threshold3State, CreepControl>;

enum class SlideController { kThreshold3State, kCreepControl };

struct SlideProtectionParams {
  std::string name;
  SlideController controller = SlideController::kThreshold3State;
  double sampling_period_s = 0.020;
  ReferenceSpeed reference_speed = ReferenceSpeed::kTrue;
  double largest_deceleration_mps2 = 1.5;
  double least_speed_kmh = 3.0;
  double longest_vent_s = 10.0;
  CylinderValveParams valve;
  Threshold3StateParams threshold_3state;
  CreepControlParams creep_control;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Text("name", name, "name of the wheel-slide protection, for people");
    v.Choice(
        "controller", controller,
        {{"threshold_3state", SlideController::kThreshold3State}, {"creep_control", SlideController::kCreepControl}},
        "threshold_3state: thresholds of slip and deceleration; creep_control: aims at a slip");
    v.Number("sampling_period_s", sampling_period_s, kPositive, "T_s, a multiple of dt_s");
    v.Choice("reference_speed", reference_speed,
             {{"true", ReferenceSpeed::kTrue}, {"estimated", ReferenceSpeed::kEstimated}},
             "true: the vehicle's own speed; estimated: from its wheels");
    v.Number("largest_deceleration_mps2", largest_deceleration_mps2, kPositive,
             "a_max, bound of the estimated reference speed's fall [A]");
    v.Number("least_speed_kmh", least_speed_kmh, kNonNegative, "reference speed below which all valves fill");
    v.Number("longest_vent_s", longest_vent_s, kPositive,
             "longest uninterrupted vent; then the valve fills until the vent demand ends [M]");
    v.Group("valve", valve, "valve and cylinder behind it");
    if (controller == SlideController::kThreshold3State)
      v.Group("threshold_3state", threshold_3state, "thresholds of that controller");
    if (controller == SlideController::kCreepControl)
      v.Group("creep_control", creep_control, "parameters of that controller");
    v.Check(valve.delay_s <= kLongestDelay * sampling_period_s, "valve.delay_s",
            "must be at most three times sampling_period_s", {"valve", "sampling_period_s"});
  }

  SlideControllerLaw Law() const {
    if (controller == SlideController::kCreepControl) return CreepControl{creep_control};
    return Threshold3State{threshold_3state};
  }

  static constexpr int kLongestDelay = 3;  ///< of the valve, in sampling periods
};

/// The state of one wheelset's valve and cylinder. A row of numbers; states of valves are those of ValveState.
struct ProtectedWheelset {
  double pressure_pa = -1.0;  ///< of the cylinder; below 0: the first step takes that of the supply
  double valve = 0.0;         ///< state, after the delay
  /// What was decided at the sample k, at k modulo their number.
  std::array<double, SlideProtectionParams::kLongestDelay + 1> decided{};
  double speed_mps = 0.0;  ///< u at the last sample
  double vented_s = 0.0;   ///< duration of the present uninterrupted demand to vent
  double vents = 0.0;      ///< how often the valve has begun to vent since the start
};

/// That of a vehicle. A row of numbers.
template <int kWheelsets>
struct ProtectionState {
  double reference_speed_mps = -1.0;  ///< at the last sample; below 0: there was none
  std::array<ProtectedWheelset, kWheelsets> wheelset;
};

/// Wheel-slide protection of vehicles of one kind, for steps of dt.
class SlideProtection {
 public:
  /// @param params  its period a multiple of dt
  SlideProtection(const SlideProtectionParams& params, double dt);

  /// Whether the controller samples at the start of a step, counted from the start of the run.
  bool Samples(long step) const { return step % period_steps_ == 0; }

  /// A sample at the start of a step.
  /// @param speed_mps       of the vehicle, forward positive
  /// @param wheel_speed_mps r omega of each wheelset, forward positive
  template <std::size_t kWheelsets>
  void Sample(long step, double speed_mps, const std::array<double, kWheelsets>& wheel_speed_mps,
              ProtectionState<static_cast<int>(kWheelsets)>& state) const;

  /// Moves valves and cylinders on by a step. @param supply_pa  held over the step, >= 0
  template <int kWheelsets>
  void Step(long step, double supply_pa, ProtectionState<kWheelsets>& state) const;

 private:
  SlideProtectionParams params_;
  SlideControllerLaw law_;
  CylinderValve valve_;
  double period_s_;
  long period_steps_, delay_steps_;
};

// ---------------------------------------------------------------------------------------------------------------------

template <std::size_t kWheelsets>
void SlideProtection::Sample(long step, double speed_mps, const std::array<double, kWheelsets>& wheel_speed_mps,
                             ProtectionState<static_cast<int>(kWheelsets)>& state) const {
  constexpr double kMpsPerKmh = 1.0 / 3.6;
  const bool is_first = state.reference_speed_mps < 0.0;
  const double before = is_first ? 0.0 : state.reference_speed_mps;
  double direction = speed_mps < 0.0 ? -1.0 : 1.0, reference = std::abs(speed_mps);
  if (params_.reference_speed == ReferenceSpeed::kEstimated) {
    double fastest = 0.0;
    for (const double u : wheel_speed_mps) {
      if (std::abs(u) <= std::abs(fastest)) continue;
      fastest = u;
    }
    direction = fastest < 0.0 ? -1.0 : 1.0;
    reference = EstimatedReference(std::abs(fastest), before, params_.largest_deceleration_mps2, period_s_);
  }
  const double reference_acceleration = is_first ? 0.0 : (reference - before) / period_s_;
  state.reference_speed_mps = reference;
  const std::size_t slot = step / period_steps_ % (SlideProtectionParams::kLongestDelay + 1);
  for (std::size_t i = 0; i < kWheelsets; ++i) {
    ProtectedWheelset& wheelset = state.wheelset[i];
    const double u = direction * wheel_speed_mps[i];
    const WheelReading reading{reference, reference_acceleration, u,
                               is_first ? 0.0 : (u - wheelset.speed_mps) / period_s_,
                               std::max(0.0, wheelset.pressure_pa)};
    wheelset.speed_mps = u;
    ValveState wanted = std::visit([&](const auto& law) { return law.Decide(reading); }, law_);
    if (reference < params_.least_speed_kmh * kMpsPerKmh) wanted = ValveState::kFill;
    wheelset.vented_s = wanted == ValveState::kVent ? wheelset.vented_s + period_s_ : 0.0;
    if (wheelset.vented_s > params_.longest_vent_s) wanted = ValveState::kFill;
    wheelset.decided[slot] = static_cast<double>(wanted);
  }
}

template <int kWheelsets>
void SlideProtection::Step(long step, double supply_pa, ProtectionState<kWheelsets>& state) const {
  const long since = step - delay_steps_;
  const bool moves = since >= 0 && since % period_steps_ == 0;
  const std::size_t slot = moves ? since / period_steps_ % (SlideProtectionParams::kLongestDelay + 1) : 0;
  for (ProtectedWheelset& wheelset : state.wheelset) {
    if (moves) {
      const double next = wheelset.decided[slot];
      const double vent = static_cast<double>(ValveState::kVent);
      if (next == vent && wheelset.valve != vent) wheelset.vents += 1.0;
      wheelset.valve = next;
    }
    if (wheelset.pressure_pa < 0.0) wheelset.pressure_pa = supply_pa;
    wheelset.pressure_pa =
        valve_.Next(static_cast<ValveState>(static_cast<int>(wheelset.valve)), wheelset.pressure_pa, supply_pa);
  }
}

}  // namespace train_dynamics
