#pragma once

#include <optional>
#include <string>
#include <vector>

#include "train_dynamics/parameters.h"

namespace train_dynamics {

/// Where a driver is to stop.
struct StopParams {
  std::optional<double> position_m;
  std::string station;
  double dwell_s = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("position_m", position_m, kFinite, "of the first vehicle's centre; or else station");
    v.Text("station", station, "name of a station of the track");
    v.Number("dwell_s", dwell_s, kNonNegative,
             "standing time before the driver continues to the next stop; after the last stop the train stays");
    v.Check(position_m.has_value() == station.empty(), "position_m", "or station must be given, one of them",
            {"station"});
  }
};

/// The built-in driver: holds a speed or the route's limits, and stops at given places. See
/// train/built_in_driver.h.
struct BuiltInDriverParams {
  double period_s = 0.5;
  std::optional<double> speed_kmh;
  double limit_margin_kmh = 3.0;
  double deceleration_mps2 = 0.07;
  double response_time_s = 20.0;
  double notch_time_s = 2.0;
  double recharge_time_s = 60.0;
  double creep_speed_kmh = 5.0;
  double first_reduction_kpa = 50.0;
  double reduction_step_kpa = 20.0;
  double largest_reduction_kpa = 140.0;
  double sight_m = 10000.0;
  std::vector<StopParams> stops;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Number("period_s", period_s, Range{0.0, 10.0},
             "period at which the driver acts, a multiple of exchange_interval_s");
    v.Number("speed_kmh", speed_kmh, Range{0.0, 400.0},
             "speed to hold; not given: as fast as the route's limits allow");
    v.Number("limit_margin_kmh", limit_margin_kmh, kNonNegative, "margin that the driver keeps below each limit");
    v.Number("deceleration_mps2", deceleration_mps2, Range{0.0, 1.5},
             "planned deceleration towards lower limits and stops");
    v.Number("response_time_s", response_time_s, kPositive, "time constant for correcting a difference in speed");
    v.Number("notch_time_s", notch_time_s, kNonNegative,
             "least time from one notch up, of throttle or dynamic brake, to the next");
    v.Number("recharge_time_s", recharge_time_s, kNonNegative,
             "least time from a release to the next application, if the speed allows");
    v.Number("creep_speed_kmh", creep_speed_kmh, kPositive, "speed of the approach to a stop");
    v.Number("first_reduction_kpa", first_reduction_kpa, kPositive, "first reduction of the brake pipe");
    v.Number("reduction_step_kpa", reduction_step_kpa, kPositive, "step between further reductions");
    v.Number("largest_reduction_kpa", largest_reduction_kpa, kPositive, "largest reduction (full service)");
    v.Number("sight_m", sight_m, kNonNegative, "distance ahead over which the driver knows the line");
    v.List("stops", stops, "where the driver stops, one after the other");
    v.Check(largest_reduction_kpa >= first_reduction_kpa, "largest_reduction_kpa",
            "must be at least first_reduction_kpa", {"first_reduction_kpa"});
  }
};

}  // namespace train_dynamics
