#pragma once

#include <string>

#include "train_dynamics/coupler/draft_gear.h"
#include "train_dynamics/coupler/draw_bar.h"

namespace train_dynamics {

enum class ConnectionKind { kDraftGears, kDrawBar };

/// What joins two neighbouring vehicles; exactly one of the two devices is used.
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
};

/// Where in the slack of its connections a train starts.
enum class SlackState { kStretched, kMiddle, kBunched };

}  // namespace train_dynamics
