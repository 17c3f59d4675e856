// The built-in driver: its goals by closed forms, and its driving of trains over lines.
#include "train_dynamics/train/built_in_driver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "simulate.h"
#include "strict_config/error_list.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_dynamics/train/train_master.h"

namespace train_dynamics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

DriverView At(double position_m, double speed_mps) {
  DriverView view;
  view.position_m = view.front_m = position_m;
  view.rear_m = position_m - 500.0;
  view.speed_mps = speed_mps;
  view.speed_limit_mps = kInfinity;
  return view;
}

TEST(SpeedGoal, IsTheLowestOfItsOwnAndTheLimits) {
  BuiltInDriverParams p;
  p.speed_kmh = 72.0;
  p.limit_margin_kmh = 3.6;
  p.deceleration_mps2 = 0.1;
  DriverView view = At(0.0, 20.0);
  EXPECT_DOUBLE_EQ(GoalAt(p, view, std::nullopt, 10.0).speed_mps, 20.0);
  view.speed_limit_mps = 15.0;
  EXPECT_DOUBLE_EQ(GoalAt(p, view, std::nullopt, 10.0).speed_mps, 14.0);
  EXPECT_EQ(GoalAt(p, view, std::nullopt, 10.0).acceleration_mps2, 0.0);
  // A limit of 10 m/s in 500 m, of which 200 m are run until the brake answers: sqrt(9^2 + 2 * 0.1 * 300).
  view.limits_ahead = {{500.0, 10.0}};
  EXPECT_DOUBLE_EQ(GoalAt(p, view, std::nullopt, 10.0).speed_mps, std::sqrt(141.0));
  EXPECT_EQ(GoalAt(p, view, std::nullopt, 10.0).acceleration_mps2, -0.1);
  view.limits_ahead = {{5000.0, 10.0}};
  EXPECT_DOUBLE_EQ(GoalAt(p, view, std::nullopt, 10.0).speed_mps, 14.0);
  // A stop with creep at 1 m/s in 300 m: sqrt(1 + 2 * 0.1 * 100).
  p.creep_speed_kmh = 3.6;
  EXPECT_DOUBLE_EQ(GoalAt(p, view, 300.0, 10.0).speed_mps, std::sqrt(21.0));
}

TEST(SpeedGoal, IsNeverFasterForAMarginAboveALowLimit) {
  BuiltInDriverParams p;  // margin 3 km/h; a limit of 5 km/h would leave 2
  DriverView view = At(0.0, 1.0);
  view.speed_limit_mps = 5.0 / 3.6;
  EXPECT_DOUBLE_EQ(GoalAt(p, view, std::nullopt, 10.0).speed_mps, 2.5 / 3.6);
}

/// A train of a million kilograms without rotating parts, whose shoes give 1e5 N at once with any reduction.
DriversTrain SimpleTrain() {
  DriversTrain train;
  train.mass_kg = train.moving_mass_kg = 1e6;
  train.first_brake_n.assign(13, 1e5);
  train.largest_brake_n.assign(13, 1e5);
  train.application_share.assign(61, 1.0);
  train.release_time_s = 10.0;
  return train;
}

TEST(StoppingDistance, IsTheClosedFormAtConstantForce) {
  const BuiltInDriverParams p;
  DriverView view = At(0.0, 2.0);
  EXPECT_NEAR(StoppingDistance(p, SimpleTrain(), 50.0, 0.0, view, 0.0), 2.0 * 2.0 / (2.0 * 0.1), 0.01);
  view.mean_grade = 0.005;  // uphill
  EXPECT_NEAR(StoppingDistance(p, SimpleTrain(), 50.0, 0.01, view, 0.0),
              2.0 * 2.0 / (2.0 * (0.1 + 0.005 * kGravity + 0.01)), 0.02);
  // A brake that answers after 5 s: the distance of those is run at the full speed.
  DriversTrain slow = SimpleTrain();
  for (int second = 0; second <= 5; ++second) slow.application_share[second] = 0.0;
  slow.application_share[5] = 0.0;
  view.mean_grade = 0.0;
  EXPECT_NEAR(StoppingDistance(p, slow, 50.0, 0.0, view, 0.0), 2.0 * 5.5 + 20.0, 0.5);
}

TEST(DriversTrain, KnowsMassEffortAndBrake) {
  const config::LoadedScenario loaded = config::LoadScenario(ScenarioFile("drive_and_stop"), {});
  const BuiltInDriverParams p;
  const DriversTrain train = MakeDriversTrain(p, *loaded.params.brake, loaded.consist);
  double mass_kg = 0.0;
  for (int i = 0; i < loaded.consist.vehicles(); ++i) mass_kg += loaded.consist.vehicle(i).TotalMass();
  EXPECT_NEAR(train.mass_kg, mass_kg, 1e-6 * mass_kg);
  EXPECT_GT(train.moving_mass_kg, train.mass_kg);
  EXPECT_EQ(train.Effort(0, 10.0), 0.0);
  const VehicleParams& locomotive = loaded.consist.vehicle(0);
  EXPECT_DOUBLE_EQ(train.Effort(5, 10.0),
                   TractiveEffort(locomotive.traction->tractive_effort, 5, 10.0, locomotive.DrivenWeight()));
  EXPECT_EQ(train.BrakeForce(p, 0.0, 10.0), 0.0);
  const double first_n = train.BrakeForce(p, 50.0, 10.0), largest_n = train.BrakeForce(p, 140.0, 10.0);
  EXPECT_GT(first_n, 0.0);
  EXPECT_GT(largest_n, first_n);
  EXPECT_GT(train.BrakeForce(p, 95.0, 10.0), first_n);
  EXPECT_GT(train.BrakeForce(p, 50.0, 1.0), train.BrakeForce(p, 50.0, 25.0));  // friction falls with the speed
  EXPECT_EQ(train.ApplicationShare(0.0), 0.0);
  EXPECT_NEAR(train.ApplicationShare(60.0), 1.0, 0.01);
}

/// What came of a run.
struct Trip {
  std::vector<double> time_s, position_m, speed_kmh, over_limit_kmh;
  std::vector<GivenCommand> given;
  std::uint64_t digest = 0;
  double end_m = 0.0, end_mps = 0.0;

  double Largest(double from_s, double wanted_kmh) const {
    double largest = 0.0;
    for (std::size_t i = 0; i < time_s.size(); ++i) {
      if (time_s[i] >= from_s) largest = std::max(largest, std::abs(speed_kmh[i] - wanted_kmh));
    }
    return largest;
  }
  double FastestOverLimit() const {
    double fastest = -kInfinity;
    for (const double over : over_limit_kmh) fastest = std::max(fastest, over);
    return fastest;
  }
};

/// The 2 km train on a stretch of the ore line, by the shipped scenario.
std::vector<std::string> OreLine(const std::string& from_m, const std::string& speed_kmh,
                                 const std::string& duration_s) {
  return {"until=null", "start_position_m=" + from_m, "initial_speed_kmh=" + speed_kmh, "duration_s=" + duration_s,
          "ledger_interval_s=1"};
}

std::vector<std::string> Driven(const std::vector<std::string>& more) {
  std::vector<std::string> overrides = {"commands=[]", "until=null", "dt_s=0.005", "exchange_interval_s=0.005",
                                        "record_interval_s=1"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return overrides;
}

Trip RunScenario(const std::string& scenario, const std::vector<std::string>& overrides, int threads = 1) {
  const config::LoadedScenario loaded = config::LoadScenario(ScenarioFile(scenario), overrides);
  InProcessTransport transport(loaded.params, loaded.consist, threads);
  TrainMaster master(loaded.params, loaded.consist, transport, loaded.pressures);
  const Track track(loaded.params.track);
  Trip trip;
  const int last = loaded.consist.vehicles() - 1;
  master.AddObserver([&](const TrainRecord& record) {
    const double front_m = record.vehicles.position_m[0] + 0.5 * loaded.consist.vehicle(0).length_m;
    const double rear_m = record.vehicles.position_m[last] - 0.5 * loaded.consist.vehicle(last).length_m;
    trip.time_s.push_back(record.time_s);
    trip.position_m.push_back(record.vehicles.position_m[0]);
    trip.speed_kmh.push_back(3.6 * record.mean_speed_mps);
    trip.over_limit_kmh.push_back(3.6 * (record.mean_speed_mps - SpeedLimitUnder(track, rear_m, front_m)));
    trip.end_mps = record.mean_speed_mps;
    trip.end_m = record.vehicles.position_m[0];
  });
  master.Start();
  while (!master.Done()) master.Exchange();
  trip.digest = master.state_digest();
  trip.given = master.schedule().Given();
  return trip;
}

Trip TripOf(const std::vector<std::string>& more, int threads = 1) {
  return RunScenario("drive_and_stop", Driven(more), threads);
}

bool Gives(const Trip& trip, DriverCommandKind kind) {
  for (const GivenCommand& given : trip.given) {
    if (given.command.kind == kind) return true;
  }
  return false;
}

TEST(BuiltInDriver, HoldsASpeedOnTheLevelAndUphill) {
  for (const char* grade : {"track=level", "track={name: up, grades: [{from_m: 0, grade_percent: 0.3}]}"}) {
    const Trip trip = TripOf({grade, "driver={speed_kmh: 40}", "duration_s=900"});
    EXPECT_LT(trip.Largest(600.0, 40.0), 1.0) << grade;
    EXPECT_FALSE(Gives(trip, DriverCommandKind::kApply)) << grade;
  }
}

TEST(BuiltInDriver, HoldsASpeedDownhillWithTheDynamicBrake) {
  // A C44AC before ten loaded hoppers down 1 percent: some 110 kN, which the dynamic brake gives alone.
  const Trip trip =
      TripOf({"train={name: short, connection: mt2, consist: [{vehicle: c44ac}, {vehicle: hopper, count: 10}]}",
              "track={name: down, grades: [{from_m: -1000, grade_percent: -1}]}", "initial_speed_kmh=60",
              "driver={speed_kmh: 60}", "duration_s=600"});
  EXPECT_LT(trip.Largest(200.0, 60.0), 1.0);
  EXPECT_TRUE(Gives(trip, DriverCommandKind::kDynamicBrake));
  EXPECT_FALSE(Gives(trip, DriverCommandKind::kApply));
}

TEST(BuiltInDriver, TakesTheAirBrakeWhereTheDynamicBrakeIsTooWeak) {
  const Trip trip =
      TripOf({"train={name: heavy, connection: mt2, consist: [{vehicle: c44ac}, {vehicle: hopper, count: 60}]}",
              "track={name: down, grades: [{from_m: -3000, grade_percent: -1.2}]}", "brake=head_end",
              "initial_speed_kmh=50", "driver={speed_kmh: 50}", "duration_s=900"});
  EXPECT_TRUE(Gives(trip, DriverCommandKind::kApply));
  // A brake that can only be released as a whole is applied again and again: the speed falls far, but hardly rises.
  double fastest_kmh = 0.0, slowest_kmh = 100.0;
  for (std::size_t i = 120; i < trip.speed_kmh.size(); ++i) {
    fastest_kmh = std::max(fastest_kmh, trip.speed_kmh[i]);
    slowest_kmh = std::min(slowest_kmh, trip.speed_kmh[i]);
  }
  EXPECT_LT(fastest_kmh, 50.0 + BuiltInDriverParams().limit_margin_kmh);
  EXPECT_GT(slowest_kmh, 35.0);
}

TEST(BuiltInDriver, KeepsBelowLimitsAndStopsAtAPlace) {
  const std::vector<std::string> line = {
      "track={name: line, speed_limits: [{from_m: -1000, limit_kmh: 50}, {from_m: 3000, limit_kmh: 30}, "
      "{from_m: 4000, limit_kmh: 60}], grades: [{from_m: -1000, grade_percent: 0.1}, {from_m: 2000, "
      "grade_percent: -0.5}, {from_m: 5000, grade_percent: 0}], stations: [{name: End, position_m: 7000}]}",
      "driver={stops: [{station: End}]}", "duration_s=1200"};
  const Trip trip = TripOf(line);
  EXPECT_LT(trip.FastestOverLimit(), 0.0);
  EXPECT_LT(std::abs(trip.end_mps), 1e-3);
  EXPECT_NEAR(trip.end_m, 7000.0, 5.0);
  EXPECT_EQ(TripOf(line, 2).digest, trip.digest);
}

TEST(BuiltInDriver, GoesOnAfterAStop) {
  const Trip trip = TripOf(
      {"driver={speed_kmh: 40, stops: [{position_m: 1500, dwell_s: 60}, {position_m: 3000}]}", "duration_s=900"});
  double stood_s = 0.0;
  for (std::size_t i = 0; i < trip.time_s.size(); ++i) {
    if (std::abs(trip.position_m[i] - 1500.0) < 5.0 && std::abs(trip.speed_kmh[i]) < 0.01) stood_s += 1.0;
  }
  EXPECT_GE(stood_s, 59.0);
  EXPECT_LT(stood_s, 120.0);
  EXPECT_NEAR(trip.end_m, 3000.0, 5.0);
}

TEST(BuiltInDriver, StopsATrainOfManyWagonsAndOneThatIsLight) {
  const Trip heavy =
      TripOf({"train={name: heavy, connection: mt2, consist: [{vehicle: c44ac}, {vehicle: hopper, count: 60}]}",
              "brake=head_end", "initial_speed_kmh=40", "driver={speed_kmh: 40, stops: [{position_m: 4000}]}",
              "duration_s=900"});
  EXPECT_LT(std::abs(heavy.end_mps), 1e-6);
  EXPECT_NEAR(heavy.end_m, 4000.0, 10.0);
  const Trip light =
      TripOf({"train={name: light, connection: mt2, consist: [{vehicle: c44ac}, {vehicle: hopper_empty, count: "
              "20}]}",
              "brake=head_end", "initial_speed_kmh=40", "driver={speed_kmh: 40, stops: [{position_m: 3000}]}",
              "duration_s=700"});
  EXPECT_LT(std::abs(light.end_mps), 1e-6);
  EXPECT_NEAR(light.end_m, 3000.0, 10.0);
}

TEST(BuiltInDriver, TakesATrainOfTwoKilometresOverTheOreLine) {
  // Away from the mine; down 8 and 10 per mille through changes of the limit; into the port.
  const Trip start = RunScenario("ore_line_trip", OreLine("1", "0", "300"));
  EXPECT_LT(start.FastestOverLimit(), 0.0);
  EXPECT_GT(start.speed_kmh.back(), 34.0);
  const Trip down = RunScenario("ore_line_trip", OreLine("17000", "55", "700"));
  EXPECT_LT(down.FastestOverLimit(), 0.0);
  EXPECT_TRUE(Gives(down, DriverCommandKind::kDynamicBrake) && Gives(down, DriverCommandKind::kApply));
  EXPECT_GT(down.speed_kmh.back(), 40.0);
  const Trip port = RunScenario("ore_line_trip", OreLine("48500", "35", "400"));
  EXPECT_LT(port.FastestOverLimit(), 0.0);
  EXPECT_LT(std::abs(port.end_mps), 1e-3);
  EXPECT_NEAR(port.end_m, 49500.0, 10.0);
}

TEST(BuiltInDriver, DoesNothingAfterAnEmergency) {
  const Trip trip = TripOf({"commands=[{time_s: 30, kind: emergency}]", "driver={speed_kmh: 40}", "duration_s=200"});
  EXPECT_LT(std::abs(trip.end_mps), 1e-6);
  for (const GivenCommand& given : trip.given) {
    if (given.exchange < 6000) continue;
    EXPECT_TRUE(given.command.IsOfLocomotives());
    EXPECT_EQ(given.command.notch, 0.0);
  }
}

TEST(BuiltInDriver, GoesOnFromACheckpointToTheSameBits) {
  const config::LoadedScenario loaded =
      config::LoadScenario(ScenarioFile("drive_and_stop"),
                           Driven({"driver={speed_kmh: 30, stops: [{position_m: 1200}]}", "duration_s=300"}));
  std::vector<TrainCheckpoint> checkpoints;
  InProcessTransport transport(loaded.params, loaded.consist, 1);
  TrainMaster whole(loaded.params, loaded.consist, transport, loaded.pressures);
  whole.Start();
  while (!whole.Done()) {
    const std::uint64_t next = whole.exchange() + 1;
    const bool asks = next == 10000 || next == 30000;
    if (asks) whole.AskForCheckpoint();
    whole.Exchange();
    if (asks) checkpoints.push_back(whole.Checkpoint());
  }
  ASSERT_EQ(checkpoints.size(), 2u);
  for (const TrainCheckpoint& checkpoint : checkpoints) {
    InProcessTransport other(loaded.params, loaded.consist, 1);
    TrainMaster rest(loaded.params, loaded.consist, other, loaded.pressures);
    rest.Resume(DecodeTrainCheckpoint(Encode(checkpoint)));
    while (!rest.Done()) rest.Exchange();
    EXPECT_EQ(rest.state_digest(), whole.state_digest());
    EXPECT_EQ(rest.schedule().Given().size(), whole.schedule().Given().size());
  }
}

std::string ErrorsOf(const std::vector<std::string>& overrides) {
  try {
    config::LoadScenario(ScenarioFile("drive_and_stop"), Driven(overrides));
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(BuiltInDriver, TellsAllThatHeCannotDo) {
  const std::string errors =
      ErrorsOf({"track={name: line, stations: [{name: Ash, position_m: 500}, {name: Elm, position_m: 900}]}",
                "driver={period_s: 0.0123, first_reduction_kpa: 1, stops: [{station: Oak}, {station: Elm}, "
                "{station: Ash}]}"});
  EXPECT_NE(errors.find("driver.period_s"), std::string::npos) << errors;
  EXPECT_NE(errors.find("driver.first_reduction_kpa"), std::string::npos) << errors;
  EXPECT_NE(errors.find("must be a station of the track: Ash, Elm"), std::string::npos) << errors;
  EXPECT_NE(errors.find("driver.stops[2]"), std::string::npos) << errors;
}

TEST(GroupNames, OfCommandsMeanTheirLocomotives) {
  const std::string train =
      "train={name: dp, connection: mt2, consist: [{vehicle: c44ac, name: lead}, {vehicle: hopper, count: "
      "3}, "
      "{vehicle: c44ac_trailing, name: remote}, {vehicle: hopper, count: 3}]}";
  const std::string by_name = train, commands = "commands=[{time_s: 1, kind: throttle, notch: 4, ";
  const Trip named = TripOf({train, commands + "group: remote}]", "duration_s=20"});
  const Trip numbered = TripOf({train, commands + "vehicles: [5]}]", "duration_s=20"});
  const Trip all = TripOf({train, commands + "vehicles: []}]", "duration_s=20"});
  EXPECT_EQ(named.digest, numbered.digest);
  EXPECT_NE(named.digest, all.digest);
  const std::string error = ErrorsOf({train, commands + "group: remot}]"});
  EXPECT_NE(error.find("must be the name of a group of locomotives of the train: lead, remote"), std::string::npos)
      << error;
}

// The brakes of locomotives act on vehicles that are locomotives without traction, too; throttles do not.
TEST(GroupNames, OfLocomotiveBrakesMeanLocomotivesWithoutTraction) {
  const std::string train =
      "train={name: hauled, connection: mt2, consist: [{vehicle: c44ac, name: lead}, {vehicle: hopper, "
      "count: "
      "3}, {vehicle: ore_wagon_loaded, count: 2, name: dead, locomotive: true, model: ltd}]}";
  const auto commands = [](const std::string& kind, const std::string& who) {
    return "commands=[{time_s: 1, kind: " + kind + ", " + who + "}]";
  };
  const std::vector<std::string> common = {train, "duration_s=20", "initial_speed_kmh=20"};
  const auto trip_of = [&](const std::string& who) {
    std::vector<std::string> set = common;
    set.push_back(commands("independent_brake, pressure_kpa: 200", who));
    return TripOf(set);
  };
  EXPECT_EQ(trip_of("group: dead").digest, trip_of("vehicles: [5, 6]").digest);
  EXPECT_NE(trip_of("group: dead").digest, trip_of("group: lead").digest);
  const std::string error = ErrorsOf({train, commands("throttle, notch: 4", "group: dead")});
  EXPECT_NE(error.find("must be the name of a group of locomotives of the train: lead"), std::string::npos) << error;
}

TEST(StartStates, TheBrakeHasItsPressureAndHoldsTheTrainOnAGrade) {
  const std::vector<std::string> grade = {"track={name: down, grades: [{from_m: -1000, grade_percent: -1}]}",
                                          "duration_s=60"};
  std::vector<std::string> applied = grade;
  applied.push_back("initial_reduction_kpa=100");
  EXPECT_LT(std::abs(TripOf(applied).end_mps), 1e-3);
  EXPECT_GT(TripOf(grade).end_mps, 3.0);  // released: 60 s at 0.1 m/s2, less resistance
  std::vector<std::string> released = applied;
  released.push_back("commands=[{time_s: 5, kind: release}]");
  EXPECT_GT(TripOf(released).end_mps, 1.0);
}

TEST(StartStates, LocomotivesBeginWithTheSteadyEffortOfTheirNotch) {
  const config::LoadedScenario loaded = config::LoadScenario(
      ScenarioFile("drive_and_stop"), Driven({"train.consist[0].initial_throttle_notch=5", "initial_speed_kmh=30"}));
  InProcessTransport transport(loaded.params, loaded.consist, 1);
  TrainMaster master(loaded.params, loaded.consist, transport, loaded.pressures);
  master.Start();
  const VehicleParams& locomotive = loaded.consist.vehicle(0);
  EXPECT_DOUBLE_EQ(master.locomotives().drive(0).effort_n,
                   TractiveEffort(locomotive.traction->tractive_effort, 5, 30.0 / 3.6, locomotive.DrivenWeight()));
  EXPECT_NE(ErrorsOf({"train.consist[1].initial_throttle_notch=5"}).find("train.consist[1].initial_throttle_notch"),
            std::string::npos);
}

TEST(StartStates, SlackOfAGroupIsInFrontOfItsVehicles) {
  const auto extensions = [](const std::string& second) {
    const config::LoadedScenario loaded = config::LoadScenario(
        ScenarioFile("drive_and_stop"), Driven({"train={name: two, connection: calibrated, consist: "
                                                "[{vehicle: c44ac}, {vehicle: hopper, count: 2}, "
                                                "{vehicle: hopper, count: 2" +
                                                    second + "}]}",
                                                "initial_slack=bunched"}));
    InTrainForces forces(loaded.consist, loaded.params.initial_slack, 0.0);
    std::vector<double> extension_m;
    forces.Extensions(extension_m);
    return extension_m;
  };
  const std::vector<double> all = extensions(""), own = extensions(", initial_slack: stretched");
  ASSERT_EQ(own.size(), 4u);
  EXPECT_LT(all[0], 0.0);
  EXPECT_EQ(own[0], all[0]);
  EXPECT_EQ(own[1], all[1]);
  EXPECT_DOUBLE_EQ(own[2], -all[0]);
  EXPECT_DOUBLE_EQ(own[3], -all[0]);
}

}  // namespace
}  // namespace train_dynamics
