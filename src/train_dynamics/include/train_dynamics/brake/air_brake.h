#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "train_dynamics/brake/brake_command.h"
#include "train_dynamics/judgement.h"
#include "train_dynamics/numeric/elementary.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// Measured behaviour of service applications over the reduction of the brake pipe's pressure (paper Figure
/// 1).
///
/// All lists have the same length; between the measured reductions each quantity follows a monotone cubic.
struct ServiceApplicationParams {
  std::vector<double> reduction_kpa;
  std::vector<double> cylinder_pressure_kpa;
  std::vector<double> wave_speed_mps;
  std::vector<double> rise_rate_per_s;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Numbers("reduction_kpa", reduction_kpa, kPositive,
              "total reductions of the brake pipe's pressure at which the application was measured, ascending");
    v.Numbers("cylinder_pressure_kpa", cylinder_pressure_kpa, kNonNegative,
              "p_s, steady cylinder pressure at each of them");
    v.Numbers("wave_speed_mps", wave_speed_mps, kPositive, "speed of the brake wave at each of them");
    v.Numbers("rise_rate_per_s", rise_rate_per_s, kPositive,
              "beta, rate at which the cylinder pressure nears its steady value, at each of them");
    v.Check(reduction_kpa.size() >= 4, "reduction_kpa", "must list at least 4 reductions");
    for (std::size_t i = 1; i < reduction_kpa.size(); ++i) {
      v.Check(reduction_kpa[i] > reduction_kpa[i - 1], "reduction_kpa[" + std::to_string(i) + "]",
              "must be greater than the one before, " + ShortestDecimal(reduction_kpa[i - 1]), {"reduction_kpa"});
    }
    v.Check(cylinder_pressure_kpa.size() == reduction_kpa.size(), "cylinder_pressure_kpa", kSameLength);
    v.Check(wave_speed_mps.size() == reduction_kpa.size(), "wave_speed_mps", kSameLength);
    v.Check(rise_rate_per_s.size() == reduction_kpa.size(), "rise_rate_per_s", kSameLength);
  }

 private:
  static constexpr const char* kSameLength = "must have as many values as reduction_kpa";
};

/// An emergency application. Its pressure rises the slower the further a vehicle is from the source that
/// vents there: see EmergencyRiseRate.
struct EmergencyApplicationParams {
  double cylinder_pressure_kpa = kRequired;
  double wave_speed_mps = kRequired;
  double rise_rate_per_s = kRequired;
  double rise_rate_fall_per_s = 0.0;
  double rise_rate_fall_length_m = 1.0;
  double blocking_time_s = 60.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("cylinder_pressure_kpa", cylinder_pressure_kpa, kNonNegative, "steady cylinder pressure of an emergency");
    v.Number("wave_speed_mps", wave_speed_mps, kPositive, "speed of the emergency's wave along the train");
    v.Number("rise_rate_per_s", rise_rate_per_s, kPositive,
             "b0, rate at which the cylinder pressure nears its steady value beside the source that vents");
    v.Number("rise_rate_fall_per_s", rise_rate_fall_per_s, kNonNegative,
             "fall of that rate over rise_rate_fall_length_m of distance from the source");
    v.Number("rise_rate_fall_length_m", rise_rate_fall_length_m, kPositive,
             "L, distance up to which the rate falls evenly");
    v.Number("blocking_time_s", blocking_time_s, kNonNegative,
             "time for which nothing ends an emergency; afterwards a release does");
    v.Check(rise_rate_fall_per_s < rise_rate_per_s, "rise_rate_fall_per_s", "must be below rise_rate_per_s",
            {"rise_rate_per_s"});
  }
};

/// Rise rate of an emergency's pressure [1/s] at the distance d >= 0 [m] from the source that vents there:
///
///   beta(d) = b0 - k d                       up to L = rise_rate_fall_length_m
///   beta(d) = b1 / (1 + k (d - L) / b1)      beyond it
///
/// b0 = rise_rate_per_s, k = rise_rate_fall_per_s / L, b1 = b0 - k L > 0. Once differentiable, positive and falling at
/// any distance; what lies beyond L is an assumption [A].
double EmergencyRiseRate(const EmergencyApplicationParams& params, double distance_m);

struct ReleaseParams {
  double wave_speed_mps = kRequired;
  double fall_rate_per_s = kRequired;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("wave_speed_mps", wave_speed_mps, kPositive, "speed of the release's wave along the train");
    v.Number("fall_rate_per_s", fall_rate_per_s, kPositive, "beta_r, rate at which the cylinder pressure falls");
  }
};

/// A place where the brake pipe is vented (and charged, if it releases): a locomotive or an End-of-Train
/// device.
struct BrakeSourceParams {
  std::string name;
  int vehicle = 0;
  double application_delay_s = 0.0;
  bool releases = true;
  double release_delay_s = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Text("name", name, "name of the source, for people");
    v.Integer("vehicle", vehicle, Range{-100000, 100000, false, false},
              "vehicle that has the source: 1 the first, -1 the last");
    v.Number("application_delay_s", application_delay_s, kNonNegative,
             "from the driver's command to the venting of the pipe here");
    v.Flag("releases", releases, "whether it also charges the pipe; false: an end-of-train device, which only vents");
    if (releases)
      v.Number("release_delay_s", release_delay_s, kNonNegative,
               "from the driver's command to the charging of the pipe here");
    v.Check(vehicle != 0, "vehicle", "must count from 1, or from -1 for the last");
  }
};

/// A conventional automatic air brake, as an empirical model over measured data.
struct AirBrakeParams {
  std::vector<BrakeSourceParams> sources;
  ServiceApplicationParams service;
  EmergencyApplicationParams emergency;
  ReleaseParams release;
  bool graduated_release = false;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.List("sources", sources, "places where the pipe is vented and charged: locomotives and end-of-train devices");
    v.Group("service", service, "measured service applications over the pipe's reduction");
    v.Group("emergency", emergency, "emergency application");
    v.Group("release", release, "release");
    v.Flag("graduated_release", graduated_release,
           "whether a smaller total reduction lets the cylinders down to its pressure; else it releases them "
           "fully");
    v.Check(!sources.empty(), "sources", "must list at least one source");
    v.Check(sources.size() <= 100, "sources", "must list at most 100 sources");
  }

  /// The rules that the commands break in a train of this many vehicles, with the scenario's keys.
  std::vector<BrokenRule> BrokenRules(const std::vector<BrakeCommand>& commands, int vehicles) const;
  /// Commands without effect, and applications that this model gives too much pressure.
  std::vector<Warning> Warnings(const std::vector<BrakeCommand>& commands, int vehicles) const;
  bool ReleasesGradually() const { return graduated_release; }
};

/// Every vehicle's cylinder as phases, in each of which its pressure tends to a target:
///
///   p = target + (begin - target) exp(-rate (t - t_begin)),  from t_begin until the next phase begins
///
/// Arrays of [phase][vehicle], `stride` vehicles to a phase. The first phase begins before any time that is queried;
/// phases that a vehicle does not have begin at infinity.
struct BrakePhases {
  int phases, stride;
  const double *begin_s, *begin_pa, *target_pa, *rate_per_s;
};

/// For one vehicle or several: the target pressure, the remaining gap to it, and the rate at which the gap decays.
template <class T>
struct CylinderGap {
  T target_pa;
  T gap_pa;  ///< pressure less target
  T rate_per_s;
};

/// The gap at a time, of one vehicle or of several consecutive ones.
template <class T>
CylinderGap<T> CylinderGapAt(const BrakePhases& p, int vehicle, double time_s) {
  T begin_s = Load<T>(p.begin_s + vehicle), begin_pa = Load<T>(p.begin_pa + vehicle);
  T target_pa = Load<T>(p.target_pa + vehicle), rate_per_s = Load<T>(p.rate_per_s + vehicle);
  for (int phase = 1; phase < p.phases; ++phase) {
    const int at = phase * p.stride + vehicle;
    const T next_s = Load<T>(p.begin_s + at);
    const MaskOf<T> begun = next_s <= T(time_s);
    begin_s = Select(begun, next_s, begin_s);
    begin_pa = Select(begun, Load<T>(p.begin_pa + at), begin_pa);
    target_pa = Select(begun, Load<T>(p.target_pa + at), target_pa);
    rate_per_s = Select(begun, Load<T>(p.rate_per_s + at), rate_per_s);
  }
  return {target_pa, (begin_pa - target_pa) * Exp(-rate_per_s * (T(time_s) - begin_s)), rate_per_s};
}

/// Cylinder pressure [Pa] at a time, of one vehicle or of several consecutive ones.
template <class T>
T CylinderPressure(const BrakePhases& p, int vehicle, double time_s) {
  const CylinderGap<T> gap = CylinderGapAt<T>(p, vehicle, time_s);
  return gap.target_pa + gap.gap_pa;
}

/// Cylinder pressures of a train under a list of driver commands (paper Eq 2).
///
/// What a command does depends on those before it:
///
///   at one time            the strongest holds: emergency, the larger reduction, the smaller one, release
///   emergency              holds until a release that comes blocking_time_s or more after it
///   a larger reduction     an application
///   an equal reduction     nothing
///   a smaller reduction    a rise of the pipe's pressure: a release, full or graduated (graduated_release)
///
/// A command that has an effect reaches vehicle i with the first wave (t_d,i of FirstWave in brake/brake_wave.h;
/// releases and smaller reductions start at the sources that release). From then on, with p_m the pressure at that
/// moment,
///
///   application:        p = p_m + (p_s - p_m)(1 - exp(-beta (t - t_d,i))),  limited to [p_m, p_s]
///   full release:       p = p_m exp(-beta_r (t - t_d,i))
///   graduated release:  p = p_s + (p_m - p_s) exp(-beta_r (t - t_d,i)); while p_m < p_s the application to p_s
///
/// A later command overtakes an earlier one where its wave is faster: a vehicle obeys the newest command that
/// has reached it. Distances are between vehicle centres on the unstretched train. Stateless in time: any time may be
/// queried.
///
/// Left out: reservoirs. An application after a release has the pressure of a fully charged train; a real one has
/// less (Warnings says so).
class AirBrake {
 public:
  /// @param vehicle_positions_m  centre of each vehicle on the unstretched train, any origin, front to rear
  /// @throws std::invalid_argument if a source is outside the train, a reduction lies outside the measured range, times
  ///         do not ascend, or no source releases where a command demands it.
  AirBrake(const AirBrakeParams& params, const std::vector<BrakeCommand>& commands,
           const std::vector<double>& vehicle_positions_m);

  int vehicles() const { return static_cast<int>(positions_m_.size()); }

  /// Adds a command while earlier ones still propagate. Commands of later times remain valid.
  /// @throws std::invalid_argument as the constructor
  void Command(const BrakeCommand& command);

  /// The brake pipe opens between vehicles `connection` and `connection` + 1, from 0: an emergency propagates from
  /// there in both directions, and no command ends it. An emergency already in effect becomes permanent.
  void OpenPipe(double time_s, int connection);

  /// The phases that the pressures are computed from; the stride is a multiple of 8.
  BrakePhases Phases() const;

  /// Cylinder pressure of each vehicle [Pa] at time t [s]; resizes `pressure_pa`.
  void PressuresAt(double time_s, std::vector<double>& pressure_pa) const;

 private:
  /// The pressure from `begin_s` on tends from `begin_pa` to `target_pa`.
  struct Phase {
    double begin_s, begin_pa, target_pa, rate_per_s;
    bool emergency;

    double PressureAt(double time_s) const;
  };
  struct Opening {
    double time_s;
    int connection;
  };
  /// Builds the phases from the commands, then from the openings of the pipe.
  void MakePhases();
  void AddPhases(const Opening& opening);
  /// Copies the phases into the arrays [phase][vehicle].
  void Arrange();

  AirBrakeParams params_;
  std::vector<BrakeCommand> commands_;  ///< by time
  std::vector<double> positions_m_;
  std::vector<Opening> openings_;
  std::vector<std::vector<Phase>> vehicle_phases_;  ///< [vehicle][phase]
  int stride_ = 0;
  std::vector<double> begin_s_, begin_pa_, target_pa_, rate_per_s_;  ///< [phase][vehicle]
};

}  // namespace train_dynamics
