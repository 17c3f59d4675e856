#include "train_dynamics/coupler/connection.h"

namespace train_dynamics {
namespace {

ConnectionLaw DraftGears(const DraftGearParams& gear) {
  switch (gear.friction) {
    case DraftGearFriction::kStickSpring:
      return StickSpringGears(gear);
    case DraftGearFriction::kDampedStick:
      return DampedStickGears(gear);
    case DraftGearFriction::kLuGre:
      return LuGreGears(gear);
    default:
      return SmoothGears(gear);
  }
}

/// Which of the two is in front does not matter to the force.
ConnectionLaw Unequal(const UnequalGearsParams& p) {
  const auto friction = [](const OneGearParams& gear) { return FrictionDevice(gear.draft_gear); };
  const auto table = [](const OneGearParams& gear) {
    return TableDevice(gear.table.tables, gear.table.locked_stiffness_n_per_m,
                       gear.table.locked_damping_ns_per_m, gear.table.solid_stiffness_n_per_m);
  };
  const bool front_rubs = p.front_gear.kind == OneGearParams::Kind::kFriction;
  const bool rear_rubs = p.rear_gear.kind == OneGearParams::Kind::kFriction;
  if (front_rubs && rear_rubs) {
    return UnequalGears<FrictionDevice, FrictionDevice>{p.slack_m, friction(p.front_gear),
                                                        friction(p.rear_gear)};
  }
  if (front_rubs || rear_rubs) {
    return UnequalGears<FrictionDevice, TableDevice>{p.slack_m,
                                                     friction(front_rubs ? p.front_gear : p.rear_gear),
                                                     table(front_rubs ? p.rear_gear : p.front_gear)};
  }
  return UnequalGears<TableDevice, TableDevice>{p.slack_m, table(p.front_gear), table(p.rear_gear)};
}

}  // namespace

ConnectionLaw ConnectionParams::Law() const {
  switch (kind) {
    case ConnectionKind::kDrawBar:
      return DrawBar(draw_bar);
    case ConnectionKind::kTable:
      return TableGear(table);
    case ConnectionKind::kUnequalGears:
      return Unequal(unequal_gears);
    case ConnectionKind::kSideBuffers:
      return SideBuffers(side_buffers);
    default:
      return DraftGears(draft_gear);
  }
}

}  // namespace train_dynamics
