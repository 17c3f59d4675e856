#pragma once

#include <optional>
#include <string>
#include <vector>

#include "train_dynamics/parameters.h"
#include "train_dynamics/traction/drive.h"
#include "train_dynamics/traction/dynamic_brake.h"
#include "train_dynamics/traction/energy_supply.h"
#include "train_dynamics/traction/slip_control.h"
#include "train_dynamics/traction/tractive_effort.h"

namespace train_dynamics {

/// The traction equipment of a locomotive: driven wheels, tractive effort, dynamic brake, energy supply.
struct TractionParams {
  std::string name;
  TractiveEffortParams tractive_effort;
  std::optional<DynamicBrakeParams> dynamic_brake;
  DriveParams drive;
  std::vector<int> driven_wheelsets;
  double drive_inertia_kgm2 = 0.0;
  std::optional<SlipControlParams> slip_control;
  std::optional<EnergySupplyParams> energy_supply;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Text("name", name, "name of the traction equipment, for people");
    v.Group("tractive_effort", tractive_effort, "what the locomotive can pull with, at the rims of its driven wheels");
    v.Group("dynamic_brake", dynamic_brake, "brake by the traction motors; not given: none");
    v.Group("drive", drive, "how fast the effort follows the controller");
    v.Integers("driven_wheelsets", driven_wheelsets, Range{1, 6, false, false},
               "driven wheelsets, from 1 in front, ascending; none: all");
    bool repeats = false;
    for (std::size_t i = 1; i < driven_wheelsets.size(); ++i)
      repeats = repeats || driven_wheelsets[i] <= driven_wheelsets[i - 1];
    v.Check(!repeats, "driven_wheelsets", "must ascend");
    v.Number("drive_inertia_kgm2", drive_inertia_kgm2, kNonNegative,
             "i^2 J of the motor and its gear, in addition to the pitch inertia of each driven wheelset");
    v.Group("slip_control", slip_control,
            "takes torque from wheelsets that slip (2D model); not given: torque follows the effort, "
            "whatever slips");
    v.Group("energy_supply", energy_supply, "energy taken from tank or line; not given: it is not computed");
  }

  bool Drives(int wheelset) const;     ///< @param wheelset  from 0
  int DrivenOf(int wheelsets) const {  ///< number of driven wheelsets of a vehicle with so many
    return driven_wheelsets.empty() ? wheelsets : static_cast<int>(driven_wheelsets.size());
  }
};

/// The driver's demand on a locomotive. If both are set, the dynamic brake takes precedence.
struct NotchCommand {
  double throttle_notch = 0.0;
  double dynamic_brake_notch = 0.0;
};

/// The steady effort that a command asks for [N]: traction positive, dynamic brake negative.
/// @param speed_mps        of the locomotive
/// @param driven_weight_n  on its driven wheels
double WantedEffort(const TractionParams& p, const NotchCommand& command, double speed_mps, double driven_weight_n);

}  // namespace train_dynamics
