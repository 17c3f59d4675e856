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

/// What is constant in a connection.
struct Connection {
  explicit Connection(const ConnectionParams& params)
      : kind(params.kind), bar(params.draw_bar), gear(params.draft_gear) {}
  ConnectionKind kind;
  DrawBarParams bar;
  DraftGear gear;  ///< unused in a draw-bar
};

/// Force of a connection [N], tension positive.
///
/// @param q      extension relative to the unstretched length [m], tension positive
/// @param q_rate its rate [m/s]
/// @param stick  memory, changed in connections with stick-spring friction only
template <class T>
GearForce<T> ConnectionForce(const Connection& c, T q, T q_rate, StickState<T>& stick) {
  if (c.kind == ConnectionKind::kDrawBar) {
    const T elastic = c.bar.stiffness_n_per_m * q;
    return {elastic + c.bar.damping_ns_per_m * q_rate, elastic};
  }
  if (c.gear.params.friction == DraftGearFriction::kSmooth) return SmoothGearForce(c.gear, q, q_rate);
  return StickSpringGearForce(c.gear, q, q_rate, stick);
}

/// Connections of one type, side by side: one number each, in arrays.
struct ConnectionArrays {
  const double* rate_mps;                      ///< of the extension
  const double* extension_m;                   ///< at the last exchange
  double *force_n, *elastic_n;                 ///< tension positive
  double *stick_m, *stick_n;                   ///< StickState
  double *tension_n, *tension_time_s;          ///< the largest so far, and when
  double *compression_n, *compression_time_s;  ///< the same, <= 0
};

/// Where in the slack of its connections a train starts.
enum class SlackState { kStretched, kMiddle, kBunched };

}  // namespace train_dynamics
