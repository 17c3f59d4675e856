#pragma once

#include <cstddef>
#include <vector>

#include "train_dynamics/numeric/scalar.h"
#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// The brakes of a train's locomotives besides the automatic air brake.
struct LocomotiveBrakeParams {
  double maximum_independent_kpa = 450.0;
  double independent_fill_kpa_per_s = 100.0;
  double independent_release_kpa_per_s = 80.0;
  double bail_off_time_s = 5.0;
  double blending_kpa_per_kn = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("maximum_independent_kpa", maximum_independent_kpa, Range{50.0, 1000.0, false, false},
             "highest cylinder pressure of the independent brake [A]");
    v.Number("independent_fill_kpa_per_s", independent_fill_kpa_per_s, Range{1.0, 1000.0, false, false},
             "rate at which the independent brake fills the cylinder [A]");
    v.Number("independent_release_kpa_per_s", independent_release_kpa_per_s, Range{1.0, 1000.0, false, false},
             "rate at which the independent brake empties the cylinder [A]");
    v.Number("bail_off_time_s", bail_off_time_s, Range{0.0, 600.0, true, false},
             "for which the driver holds the handle of a bail-off [A]");
    v.Number("blending_kpa_per_kn", blending_kpa_per_kn, Range{0.0, 1000.0, false, false},
             "cylinder pressure of the train's brake that is let out per effort of the locomotive's dynamic "
             "brake; 0: no "
             "blending. With 1 / (1000 C mu_b), C [N/Pa], a locomotive brakes by the stronger of the two; "
             "with more, the "
             "air brake is locked out");
  }
};

enum class LocomotiveBrakeCommandKind { kIndependent, kBailOff };

/// What the driver does with the brakes of the locomotives alone, and when.
struct LocomotiveBrakeCommand {
  double time_s = 0.0;
  LocomotiveBrakeCommandKind kind = LocomotiveBrakeCommandKind::kIndependent;
  double pressure_kpa = 0.0;  ///< of kIndependent; 0 releases
  std::vector<int> vehicles;  ///< locomotives that obey, from 1, or from -1 for the last; empty: all
};

/// The independent brakes of a train's locomotives, and the blending of their air brakes with the dynamic brake. What
/// acts in the cylinder of a locomotive is
///
///   p = max(p_i, max(0, p_a - k F))
///
/// p_a [Pa] of the automatic brake; p_i of the independent brake, which follows the driver's demand at a constant rate,
/// up or down; k = blending_kpa_per_kn; F >= 0 effort of the dynamic brake over the previous exchange. Blending acts in
/// an emergency, too [A]. p_i is a function of time and of the commands so far: there is no other state. Its air comes
/// from the main reservoir, outside of the balance of the pipe's air.
///
/// Left out: relay valves by speed; an independent brake that cuts the dynamic brake out.
class LocomotiveBrakes {
 public:
  struct Locomotive {
    int vehicle;             ///< index from 0
    double command_delay_s;  ///< transmission delay of the driver's commands to it
  };

  LocomotiveBrakes() = default;  ///< of no locomotives: nothing acts
  LocomotiveBrakes(const LocomotiveBrakeParams& params, const std::vector<Locomotive>& locomotives, int vehicles);

  struct BailOff {
    int vehicle;
    double from_s, to_s;
  };
  /// Commands may come in any order, but none before the last time queried. @return bail-offs that the command causes
  std::vector<BailOff> Command(const LocomotiveBrakeCommand& command);

  bool blends() const { return params_.blending_kpa_per_kn > 0.0 && !brakes_.empty(); }
  /// @param effort_n  [locomotive, in the order of the constructor] of the dynamic brake, >= 0
  void SetDynamicBrake(std::size_t locomotive, double effort_n) { brakes_[locomotive].dynamic_n = effort_n; }
  std::size_t size() const { return brakes_.size(); }
  int vehicle(std::size_t locomotive) const { return brakes_[locomotive].vehicle; }

  /// Converts the pressures of the automatic brake into the acting ones. Times must ascend.
  /// @param pressure_pa  [vehicle] above the atmosphere, >= 0
  void Act(double time_s, std::vector<double>& pressure_pa);

 private:
  struct Order {
    double time_s, pressure_pa;
  };
  struct Brake {
    int vehicle;
    double command_delay_s;
    std::vector<Order> orders;  ///< by time
    std::size_t obeyed = 0;
    double from_s = 0.0, from_pa = 0.0, goal_pa = 0.0;  ///< since the last order obeyed
    double dynamic_n = 0.0;
  };
  double PressureOf(const Brake& brake, double time_s) const;

  LocomotiveBrakeParams params_;
  std::vector<Brake> brakes_;
  int vehicles_ = 0;
  bool is_used_ = false;
};

}  // namespace train_dynamics
