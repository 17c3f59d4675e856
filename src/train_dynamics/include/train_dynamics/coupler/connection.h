#pragma once

#include <string>
#include <variant>

#include "train_dynamics/coupler/damped_stick_gear.h"
#include "train_dynamics/coupler/draw_bar.h"
#include "train_dynamics/coupler/lugre_gear.h"
#include "train_dynamics/coupler/side_buffers.h"
#include "train_dynamics/coupler/smooth_gear.h"
#include "train_dynamics/coupler/stick_spring_gear.h"
#include "train_dynamics/coupler/table_gear.h"
#include "train_dynamics/coupler/unequal_gears.h"

namespace train_dynamics {

/// The closed set of laws of the force between two vehicles; see connection_law.h. Chosen once per set of equal
/// connections, never per connection.
template <template <class...> class Of>
using OfConnectionLaws = Of<DrawBar, SmoothGears, StickSpringGears, DampedStickGears, LuGreGears, TableGear,
                            UnequalGears<FrictionDevice, FrictionDevice>, UnequalGears<FrictionDevice, TableDevice>,
                            UnequalGears<TableDevice, TableDevice>, SideBuffers>;

using ConnectionLaw = OfConnectionLaws<std::variant>;

enum class ConnectionKind { kDraftGears, kDrawBar, kTable, kUnequalGears, kSideBuffers };

/// What joins two neighbouring vehicles; exactly one of the devices is used.
struct ConnectionParams {
  std::string name;
  ConnectionKind kind = ConnectionKind::kDraftGears;
  double strength_n = 0.0;
  DraftGearParams draft_gear;
  DrawBarParams draw_bar;
  TableGearParams table;
  UnequalGearsParams unequal_gears;
  SideBuffersParams side_buffers;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Text("name", name, "name of the coupler, for people");
    v.Choice("kind", kind,
             {{"draft_gears", ConnectionKind::kDraftGears},
              {"draw_bar", ConnectionKind::kDrawBar},
              {"table", ConnectionKind::kTable},
              {"unequal_gears", ConnectionKind::kUnequalGears},
              {"side_buffers", ConnectionKind::kSideBuffers}},
             "draft_gears: two equal friction gears; draw_bar; table: measured force; unequal_gears: two "
             "different gears; side_buffers: screw coupling with buffers");
    v.Number("strength_n", strength_n, kNonNegative,
             "tension beyond which the connection breaks: from then on it carries no tension and the brake "
             "pipe is open there; 0: it never breaks");
    if (kind == ConnectionKind::kDraftGears)
      v.Group("draft_gear", draft_gear, "one of two equal friction draft gears in series");
    if (kind == ConnectionKind::kDrawBar) v.Group("draw_bar", draw_bar, "rigid bar: a linear spring and damper");
    if (kind == ConnectionKind::kTable) v.Group("table", table, "measured force of the whole connection");
    if (kind == ConnectionKind::kUnequalGears)
      v.Group("unequal_gears", unequal_gears, "two different draft gears in series");
    if (kind == ConnectionKind::kSideBuffers)
      v.Group("side_buffers", side_buffers, "side buffers, draw gear and screw");
  }

  /// The law that these parameters describe.
  ConnectionLaw Law() const;
};

inline ConnectionLaw ConnectionParams::Law() const {
  switch (kind) {
    case ConnectionKind::kDrawBar:
      return DrawBar(draw_bar);
    case ConnectionKind::kTable:
      return TableGear(table);
    case ConnectionKind::kUnequalGears:
      return UnequalGearsOf<ConnectionLaw>(unequal_gears);
    case ConnectionKind::kSideBuffers:
      return SideBuffers(side_buffers);
    default:
      break;
  }
  switch (draft_gear.friction) {
    case DraftGearFriction::kStickSpring:
      return StickSpringGears(draft_gear);
    case DraftGearFriction::kDampedStick:
      return DampedStickGears(draft_gear);
    case DraftGearFriction::kLuGre:
      return LuGreGears(draft_gear);
    default:
      return SmoothGears(draft_gear);
  }
}

/// Initial state of the slack in a train's connections.
enum class SlackState { kStretched, kMiddle, kBunched };

}  // namespace train_dynamics
