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

/// Force of a draw-bar [N], tension positive, at its extension q [m] and rate [m/s].
template <class T>
GearForce<T> DrawBarForce(const DrawBarParams& bar, T q, T q_rate) {
  const T elastic = bar.stiffness_n_per_m * q;
  return {elastic + bar.damping_ns_per_m * q_rate, elastic};
}

/// Connections of one type, side by side: one number each, in arrays.
struct ConnectionArrays {
  const double* rate_mps;                      ///< of the extension
  double* extension_m;                         ///< at the last exchange
  double *force_n, *elastic_n;                 ///< tension positive
  double *stick_m, *stick_n;                   ///< StickState
  double *tension_n, *tension_time_s;          ///< the largest so far, and when
  double *compression_n, *compression_time_s;  ///< the same, <= 0
  double* dissipated_j;                        ///< so far
};

/// Where in the slack of its connections a train starts.
enum class SlackState { kStretched, kMiddle, kBunched };

}  // namespace train_dynamics
