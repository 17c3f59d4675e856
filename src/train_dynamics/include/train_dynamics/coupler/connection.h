#pragma once

#include <string>
#include <variant>

#include "train_dynamics/coupler/draw_bar.h"
#include "train_dynamics/coupler/smooth_gear.h"
#include "train_dynamics/coupler/stick_spring_gear.h"

namespace train_dynamics {

/// The closed set of laws of the force between two vehicles; see connection_law.h. Chosen once per set of equal
/// connections, never per connection.
template <template <class...> class Of>
using OfConnectionLaws = Of<DrawBar, SmoothGears, StickSpringGears>;

using ConnectionLaw = OfConnectionLaws<std::variant>;

enum class ConnectionKind { kDraftGears, kDrawBar };

/// What joins two neighbouring vehicles; exactly one of the devices is used.
struct ConnectionParams {
  std::string name;
  ConnectionKind kind = ConnectionKind::kDraftGears;
  DraftGearParams draft_gear;
  DrawBarParams draw_bar;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Text("name", name);
    v.Choice("kind", kind,
             {{"draft_gears", ConnectionKind::kDraftGears}, {"draw_bar", ConnectionKind::kDrawBar}});
    if (kind == ConnectionKind::kDraftGears) v.Group("draft_gear", draft_gear);
    if (kind == ConnectionKind::kDrawBar) v.Group("draw_bar", draw_bar);
  }

  /// The law that these parameters describe.
  ConnectionLaw Law() const {
    if (kind == ConnectionKind::kDrawBar) return DrawBar(draw_bar);
    if (draft_gear.friction == DraftGearFriction::kStickSpring) return StickSpringGears(draft_gear);
    return SmoothGears(draft_gear);
  }
};

/// Where in the slack of its connections a train starts.
enum class SlackState { kStretched, kMiddle, kBunched };

}  // namespace train_dynamics
