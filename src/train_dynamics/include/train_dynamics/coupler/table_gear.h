#pragma once

#include <optional>
#include <string>

#include "train_dynamics/coupler/force_curve.h"

namespace train_dynamics {

/// A connection measured as tables of its force: friction, elastomer or end-of-car gears.
struct TableGearParams {
  double slack_m = 0.0;
  double locked_stiffness_n_per_m = kRequired;
  double locked_damping_ns_per_m = 1.3e6;
  double damping_ns_per_m = 0.0;
  double solid_stiffness_n_per_m = 1.0e8;
  HysteresisParams tables;  ///< of the whole connection, in tension and compression
  std::optional<HysteresisParams> compression;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("slack_m", slack_m, kNonNegative, "total free play of the connection");
    v.Number("locked_stiffness_n_per_m", locked_stiffness_n_per_m, kPositive,
             "k of the line between the curves, while it sticks");
    v.Number("locked_damping_ns_per_m", locked_damping_ns_per_m, kNonNegative, "c while it sticks");
    v.Number("damping_ns_per_m", damping_ns_per_m, kNonNegative, "b, of a damper beyond the slack");
    v.Number("solid_stiffness_n_per_m", solid_stiffness_n_per_m, kPositive, "stiffness beyond the last point");
    tables.Visit(v);
    v.Group("compression", compression, "curves of compression; not given: those of tension");
    const double steepest =
        compression ? std::max(tables.SteepestSlope(), compression->SteepestSlope()) : tables.SteepestSlope();
    v.Check(locked_stiffness_n_per_m > steepest, "locked_stiffness_n_per_m",
            "must exceed the steepest slope of the tables, " + ShortestDecimal(steepest) + " N/m",
            {"loading", "unloading", "compression"});
  }
};

/// A whole connection given by tables: coupler/hysteresis.h with x = max(|q| - slack/2, 0).
struct TableGear : HystereticConnection<TableDevice> {
  explicit TableGear(const TableGearParams& p)
      : HystereticConnection<TableDevice>{
            p.slack_m,     1.0, p.damping_ns_per_m, Device(p, p.tables), Device(p, p.compression.value_or(p.tables)),
            !p.compression} {}

 private:
  static TableDevice Device(const TableGearParams& p, const HysteresisParams& tables) {
    return {tables, p.locked_stiffness_n_per_m, p.locked_damping_ns_per_m, p.solid_stiffness_n_per_m};
  }
};

}  // namespace train_dynamics
