#pragma once

#include <vector>

#include "train_dynamics/brake/pneumatic/air.h"

namespace train_dynamics {

/// Darcy friction factor times Reynolds number of a brake pipe, f Re:
///
///   f = 64/Re | 0.000137 Re^0.717 from 2000 | 0.13977 Re^-0.11781 from 4000 | 0.04 from 40000     (Abdol-Hamid 1986)
///
/// From a table that is linear in Re between 2000 and 40000, steps of 50: within 3e-4 of the law, except at its jump of
/// 0.4 % at 4000, and the same bits everywhere. A constant factor may be given in its place.
class PipeFriction {
 public:
  PipeFriction();
  explicit PipeFriction(double constant_factor);

  double FactorTimesReynolds(double reynolds) const {
    if (constant_ > 0.0) return constant_ * reynolds;
    if (!(reynolds > kFrom)) return 64.0;
    if (!(reynolds < kTo)) return 0.04 * reynolds;
    const double at = (reynolds - kFrom) * (1.0 / kStep);
    const int i = static_cast<int>(at);
    return table_[i] + (at - i) * (table_[i + 1] - table_[i]);
  }

 private:
  static constexpr double kFrom = 2000.0, kTo = 40000.0, kStep = 50.0;
  double constant_ = 0.0;
  std::vector<double> table_;
};

/// Constants of a brake pipe that is divided into cells, numbered from the head.
struct PipeGrid {
  /// @param cell_length_m     of each cell, > 0
  /// @param branch_volume_m3  of the side branches at each cell
  PipeGrid(double diameter_m, double temperature_k, const std::vector<double>& cell_length_m,
           const std::vector<double>& branch_volume_m3, PipeFriction friction = PipeFriction());

  int cells() const { return static_cast<int>(volume_m3.size()); }
  /// The longest step that is stable: 0.5 min(dx) / c.
  double LongestStep() const;

  double diameter_m, area_m2;
  double rt;                             ///< R T = c^2 [m2/s2]
  std::vector<double> cell_length_m;     ///< [cell]
  std::vector<double> volume_m3;         ///< [cell], with branches: A dx (1 + nu)
  std::vector<double> rt_over_volume;    ///< [cell]
  std::vector<double> area_over_length;  ///< [face 0 ... cells], between cell centres; face i is in front of cell i
  PipeFriction friction;
};

/// The air in the pipe.
struct PipeFlow {
  PipeFlow(const PipeGrid& grid, double pressure_pa);

  std::vector<double> pressure_pa;  ///< [cell], absolute
  /// [face 0 ... cells], towards the rear; at the two ends set by the caller, initially 0.
  std::vector<double> mass_flow_kgps;
  std::vector<double> open;           ///< [face 0 ... cells], 1 or 0: an angle cock closed, a hose parted
  std::vector<double> momentum_flux;  ///< [cell], M^2/(rho A) [N]: of the step, no state
};

/// Moves the air by dt <= LongestStep(): quasi-1D isothermal flow,
///
///   (1 + nu) d rho/dt + d m/dx = 0
///   d m/dt + d(m^2/rho)/dx + c^2 d rho/dx + f |m| m / (2 D rho) = 0,     c^2 = R T, m = rho u
///
/// on a staggered grid (pressures in cells, mass flows M = A m on the faces between them), momentum first, then mass
/// with the new flows; friction implicit, momentum carried from upwind. Closed faces let nothing through. At the two
/// ends the flow is what the caller has set before (0: closed; a nozzle there takes the momentum of its air along).
/// Everything else that enters or leaves is a side flow without axial momentum, applied to a cell's pressure between
/// steps (AddMass, and Pass in air.h over the cell's volume). So the pipe itself keeps its mass to rounding. First
/// order in dt and, by the carried momentum, in dx.
///
/// Left out: temperature (a fast expansion is colder than isothermal), bends and couplings one by one.
/// Sources: Abdol-Hamid 1986; Specchia, Afshari, Shabana & Caldwell, Proc. IMechE F 227 (2013), the equations [S].
void Advance(const PipeGrid& grid, double dt_s, PipeFlow& flow);

/// Adds air to a cell [kg] (takes it out, if negative).
inline void AddMass(const PipeGrid& grid, int cell, double mass_kg, PipeFlow& flow) {
  flow.pressure_pa[cell] += mass_kg * grid.rt_over_volume[cell];
}

/// Air in all cells [kg].
double MassOf(const PipeGrid& grid, const PipeFlow& flow);

}  // namespace train_dynamics
