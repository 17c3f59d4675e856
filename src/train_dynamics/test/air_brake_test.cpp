#include "train_dynamics/brake/air_brake.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "paper_vehicle.h"
#include "strict_config/validate.h"
#include "train_dynamics/brake/brake_system.h"
#include "train_dynamics/brake/pressure_table.h"
#include "train_dynamics/brake/shoe_friction.h"
#include "train_dynamics/numeric/monotone_cubic.h"

namespace train_dynamics {
namespace {

constexpr double kPitch = 10.5;  // [m] between vehicles
constexpr int kVehicles = 242;

const AirBrakeParams& PaperBrake() {
  static const AirBrakeParams brake = LoadPart<BrakeSystemParams>("brakes/calibrated.yaml").empirical;
  return brake;
}

std::vector<double> PaperTrain() {
  std::vector<double> centres;
  for (int i = 0; i < kVehicles; ++i) centres.push_back(-kPitch * i);
  return centres;
}

BrakeCommand Apply(double time_s, double reduction_kpa) { return {time_s, BrakeCommandKind::kApply, reduction_kpa}; }
BrakeCommand Emergency(double time_s) { return {time_s, BrakeCommandKind::kEmergency, 0.0}; }
BrakeCommand Release(double time_s) { return {time_s, BrakeCommandKind::kRelease, 0.0}; }

AirBrake Brake(const std::vector<BrakeCommand>& commands) { return AirBrake(PaperBrake(), commands, PaperTrain()); }

// When the last command reaches a vehicle; infinity without commands.
double ArrivalTime(const AirBrake& brake, int vehicle) {
  const BrakePhases p = brake.Phases();
  double arrival = std::numeric_limits<double>::infinity();
  for (int phase = 1; phase < p.phases; ++phase) {
    const double begin_s = p.begin_s[phase * p.stride + vehicle];
    if (std::isfinite(begin_s)) arrival = begin_s;
  }
  return arrival;
}

double PressureOf(const AirBrake& brake, int vehicle, double time_s) {
  std::vector<double> pressure;
  brake.PressuresAt(time_s, pressure);
  return pressure.at(vehicle);
}

struct Source {
  int vehicle;
  double delay_s;
};
const std::vector<Source> kApplying = {{0, 0.0}, {121, 1.09}, {241, 3.2}};  // lead and mid locomotive, End-of-Train
const std::vector<Source> kReleasing = {{0, 0.0}, {121, 0.0}};

// First arrival after a command, and the distance from the source it comes from.
struct Arrival {
  double after_s, distance_m;
};
Arrival FirstWave(int vehicle, const std::vector<Source>& sources, double wave_speed) {
  Arrival first{1e9, 0.0};
  for (const Source& s : sources) {
    const double distance = kPitch * std::abs(vehicle - s.vehicle);
    if (s.delay_s + distance / wave_speed < first.after_s) first = {s.delay_s + distance / wave_speed, distance};
  }
  return first;
}

// Relative rounding of a few operations and of Exp.
constexpr double kRounding = 1e-13;

TEST(AirBrake, ServiceApplicationIsEq2) {
  const AirBrake brake = Brake({Apply(2.0, 170.0)});
  for (int i = 0; i < kVehicles; ++i) {
    const double arrival = 2.0 + FirstWave(i, kApplying, 180.0).after_s;
    EXPECT_NEAR(ArrivalTime(brake, i), arrival, 1e-12);  // rounding
    EXPECT_EQ(PressureOf(brake, i, arrival - 1e-9), 0.0);
    for (const double t : {arrival + 0.5, 20.0, 90.0}) {
      const double eq2 = 430e3 * (1.0 - std::exp(-0.041933 * (t - arrival)));
      EXPECT_NEAR(PressureOf(brake, i, t), eq2, kRounding * 430e3);
    }
  }
}

TEST(AirBrake, EmergencyRisesSlowerFarFromItsSource) {
  const AirBrake brake = Brake({Emergency(2.0)});
  for (int i = 0; i < kVehicles; ++i) {
    const Arrival wave = FirstWave(i, kApplying, 250.0);
    const double beta = 0.238 - 0.1683 * wave.distance_m / 2530.5;
    for (const double t : {10.0, 30.0}) {
      const double eq2 = 430e3 * (1.0 - std::exp(-beta * (t - 2.0 - wave.after_s)));
      EXPECT_NEAR(PressureOf(brake, i, t), eq2, kRounding * 430e3);
    }
  }
  // With the other sources far away the wave of the lead alone would take 10 s to the rear; the End-of-Train
  // device vents there after 3.2 s.
  EXPECT_NEAR(ArrivalTime(brake, 241), 2.0 + 3.2, 1e-12);
  EXPECT_NEAR(ArrivalTime(brake, 121), 2.0 + 1.09, 1e-12);
  EXPECT_EQ(ArrivalTime(brake, 0), 2.0);
}

TEST(AirBrake, AFurtherReductionStartsFromThePressureItMeets) {
  const AirBrake brake = Brake({Apply(2.0, 50.0), Apply(30.0, 170.0)});
  for (const int i : {0, 60, 121, 180, 241}) {
    const double first = 2.0 + FirstWave(i, kApplying, 150.0).after_s;
    const double second = 30.0 + FirstWave(i, kApplying, 180.0).after_s;
    const double met = 118e3 * (1.0 - std::exp(-0.06 * (second - first)));
    for (const double t : {second, second + 4.0, second + 60.0}) {
      const double eq2 = met + (430e3 - met) * (1.0 - std::exp(-0.041933 * (t - second)));
      EXPECT_NEAR(PressureOf(brake, i, t), eq2, kRounding * 430e3);
    }
  }
}

TEST(AirBrake, ReleaseComesFromTheLocomotivesOnly) {
  const AirBrake brake = Brake({Apply(2.0, 50.0), Release(70.0)});
  for (const int i : {0, 60, 121, 180, 241}) {
    const double applied = 2.0 + FirstWave(i, kApplying, 150.0).after_s;
    const double released = 70.0 + FirstWave(i, kReleasing, 180.0).after_s;
    const double met = 118e3 * (1.0 - std::exp(-0.06 * (released - applied)));
    EXPECT_NEAR(ArrivalTime(brake, i), released, 1e-12);
    EXPECT_NEAR(PressureOf(brake, i, released + 25.0), met * std::exp(-0.08 * 25.0), kRounding * 430e3);
    EXPECT_NEAR(PressureOf(brake, i, released + 500.0), 0.0, 1e-9);  // exp(-40)
  }
}

TEST(AirBrake, AnEmergencyOvertakesTheServiceWave) {
  // The service wave (180 m/s) leads by 0.5 s: the emergency wave (250 m/s) catches it after 0.5 / (1/180 -
  // 1/250) m.
  const AirBrake both = Brake({Apply(2.0, 170.0), Emergency(2.5)});
  const AirBrake emergency = Brake({Emergency(2.5)});
  const double caught = 0.5 / (1.0 / 180.0 - 1.0 / 250.0);
  for (int i = 0; i * kPitch < 600.0; ++i) {  // where the lead locomotive's waves come first
    const double after = 2.5 + i * kPitch / 250.0 + 1.0;
    if (i * kPitch < caught) {
      EXPECT_GT(PressureOf(both, i, after), PressureOf(emergency, i, after)) << i;  // it had begun to brake
    } else {
      EXPECT_EQ(PressureOf(both, i, after), PressureOf(emergency, i, after)) << i;  // only ever felt the emergency
    }
  }
}

TEST(AirBrake, PressureStaysBetweenWhereItWasAndItsGoal) {
  const AirBrake brake =
      Brake({Apply(1.0, 70.0), Apply(8.0, 140.0), Release(20.0), Apply(40.0, 50.0), Emergency(60.0)});
  for (const int i : {0, 30, 121, 170, 241}) {
    double before = 0.0;
    for (double t = 0.0; t < 200.0; t += 0.05) {
      const double p = PressureOf(brake, i, t);
      EXPECT_GE(p, 0.0);
      EXPECT_LE(p, 430e3);
      if (t < 20.0) {
        EXPECT_GE(p, before - 1e-9);
        EXPECT_LE(p, 354e3);  // the steady pressure of 140 kPa
      }
      EXPECT_NEAR(p, before, 430e3 * 0.238 * 0.05 + 1e-9);  // no jumps: at most p_s beta dt
      before = p;
    }
  }
}

// Pressures of some vehicles over 300 s.
std::vector<double> History(const std::vector<BrakeCommand>& commands, bool graduated = false) {
  AirBrakeParams params = PaperBrake();
  params.graduated_release = graduated;
  const AirBrake brake(params, commands, PaperTrain());
  std::vector<double> history;
  for (double t = 0.0; t < 300.0; t += 1.7) {
    for (const int i : {0, 33, 121, 200, 241}) history.push_back(PressureOf(brake, i, t));
  }
  return history;
}

TEST(AirBrake, NothingButItsReleaseAfterTheBlockingTimeEndsAnEmergency) {
  const std::vector<double> emergency = History({Emergency(2.0)});
  EXPECT_EQ(History({Emergency(2.0), Apply(2.5, 50.0)}), emergency);
  EXPECT_EQ(History({Emergency(2.0), Apply(70.0, 170.0), Apply(100.0, 60.0)}), emergency);
  EXPECT_EQ(History({Emergency(2.0), Release(61.999)}), emergency);  // within 60 s
  EXPECT_EQ(History({Emergency(2.0), Emergency(30.0)}), emergency);
  EXPECT_NE(History({Emergency(2.0), Release(62.0)}), emergency);
  // The second emergency does not begin the time anew; a release within it is not kept for later.
  EXPECT_EQ(History({Emergency(2.0), Emergency(30.0), Release(40.0), Release(62.0)}),
            History({Emergency(2.0), Release(62.0)}));
  // Once released the brake obeys again.
  const std::vector<BrakeCommand> again = {Emergency(2.0), Apply(20.0, 90.0), Release(80.0), Apply(120.0, 60.0)};
  EXPECT_EQ(History(again), History({Emergency(2.0), Release(80.0), Apply(120.0, 60.0)}));
  EXPECT_NEAR(PressureOf(Brake(again), 0, 1000.0),
              1e3 * MonotoneCubic(PaperBrake().service.reduction_kpa, PaperBrake().service.cylinder_pressure_kpa, 60.0),
              1.0);  // exp(-0.06 * 880)
}

TEST(AirBrake, OfCommandsAtOneTimeTheStrongestHoldsInAnyOrder) {
  std::vector<BrakeCommand> commands = {Apply(5.0, 80.0), Release(5.0), Emergency(5.0), Apply(5.0, 120.0)};
  const auto by_kind = [](const BrakeCommand& a, const BrakeCommand& b) {
    return std::make_pair(a.kind, a.reduction_kpa) < std::make_pair(b.kind, b.reduction_kpa);
  };
  std::sort(commands.begin(), commands.end(), by_kind);
  const std::vector<double> emergency = History({Emergency(5.0)});
  const std::vector<double> service = History({Apply(5.0, 120.0)});
  do {
    EXPECT_EQ(History(commands), emergency);
    std::vector<BrakeCommand> without = commands;
    without.erase(std::remove_if(without.begin(), without.end(),
                                 [](const BrakeCommand& c) { return c.kind == BrakeCommandKind::kEmergency; }),
                  without.end());
    EXPECT_EQ(History(without), service);
  } while (std::next_permutation(commands.begin(), commands.end(), by_kind));
}

TEST(AirBrake, ASmallerReductionReleasesFullyWithoutGraduatedRelease) {
  EXPECT_EQ(History({Apply(0.0, 170.0), Apply(60.0, 70.0)}), History({Apply(0.0, 170.0), Release(60.0)}));
  // It is the reduction now: less is a rise again, more is an application.
  EXPECT_EQ(History({Apply(0.0, 170.0), Apply(60.0, 70.0), Apply(90.0, 70.0)}),
            History({Apply(0.0, 170.0), Release(60.0)}));
  EXPECT_EQ(History({Apply(0.0, 170.0), Apply(60.0, 70.0), Apply(90.0, 100.0)}),
            History({Apply(0.0, 170.0), Release(60.0), Apply(90.0, 100.0)}));
  EXPECT_EQ(History({Apply(0.0, 100.0), Apply(60.0, 100.0)}), History({Apply(0.0, 100.0)}));
}

TEST(AirBrake, ASmallerReductionGoesDownToItsPressureWithGraduatedRelease) {
  AirBrakeParams params = PaperBrake();
  params.graduated_release = true;
  const AirBrake brake(params, {Apply(0.0, 170.0), Apply(100.0, 70.0)}, PaperTrain());
  for (const int i : {0, 60, 121, 180, 241}) {
    const double applied = FirstWave(i, kApplying, 180.0).after_s;
    const double lowered = 100.0 + FirstWave(i, kReleasing, 180.0).after_s;
    const double met = 430e3 * (1.0 - std::exp(-0.041933 * (lowered - applied)));
    for (const double after : {0.0, 5.0, 40.0}) {
      EXPECT_NEAR(PressureOf(brake, i, lowered + after), 172e3 + (met - 172e3) * std::exp(-0.08 * after),
                  kRounding * 430e3);
    }
  }
  // Before the pressure has risen so far it goes on rising, to the smaller pressure.
  const AirBrake early(params, {Apply(0.0, 170.0), Apply(3.0, 70.0)}, PaperTrain());
  double before = 0.0;
  for (double t = 0.0; t < 300.0; t += 0.5) {
    const double p = PressureOf(early, 0, t);
    EXPECT_GE(p, before);
    EXPECT_LE(p, 172e3 + 1e-9);
    before = p;
  }
  EXPECT_NEAR(before, 172e3, 172e3 * 1e-6);  // exp(-0.057 * 297)
}

TEST(AirBrake, TellsOfCommandsWithoutEffectAndOfReservoirs) {
  const auto of = [](const std::vector<BrakeCommand>& commands) {
    std::string text;
    for (const Warning& warning : PaperBrake().Warnings(commands, 242))
      text += warning.key + ": " + warning.text + "\n";
    return text;
  };
  EXPECT_EQ(of({Apply(2.0, 50.0), Apply(9.0, 100.0), Emergency(20.0), Release(90.0)}), "");
  EXPECT_EQ(of({Emergency(2.0), Apply(3.0, 50.0)}),
            "commands[1].time_s: commands[1] has no effect: the emergency of commands[0] holds until a "
            "release at 62 s "
            "or later (brake.emergency.blocking_time_s)\n");
  EXPECT_EQ(of({Apply(2.0, 50.0), Emergency(2.0)}),
            "commands[0].time_s: commands[0] has no effect: commands[1] at the same time is at least as strong\n");
  const std::string again = "applies the brake again after a release: the empirical brake has no reservoirs";
  EXPECT_NE(of({Apply(2.0, 100.0), Release(9.0), Apply(20.0, 60.0)}).find("commands[2] " + again), std::string::npos);
  EXPECT_NE(of({Apply(2.0, 100.0), Apply(9.0, 60.0), Apply(20.0, 80.0)}).find("commands[2] " + again),
            std::string::npos);
  EXPECT_NE(of({Apply(2.0, 100.0), Release(9.0), Apply(20.0, 60.0), Release(29.0), Apply(40.0, 60.0)})
                .find("commands[2] (and 1 more after it) " + again),
            std::string::npos);
  EXPECT_EQ(of({Release(2.0), Apply(20.0, 60.0)}), "");  // nothing had been used
}

TEST(EmergencyRiseRate, IsPositiveAndOnceDifferentiableAtAnyDistance) {
  const EmergencyApplicationParams& p = PaperBrake().emergency;
  EXPECT_EQ(EmergencyRiseRate(p, 0.0), 0.238);
  EXPECT_NEAR(EmergencyRiseRate(p, 2530.5), 0.0697, 1e-15);
  const double k = 0.1683 / 2530.5, b1 = 0.0697;
  for (const double beyond : {1.0, 1000.0, 1e5, 1e9}) {
    EXPECT_NEAR(EmergencyRiseRate(p, 2530.5 + beyond), b1 / (1.0 + k * beyond / b1), 1e-15);
    EXPECT_GT(EmergencyRiseRate(p, 2530.5 + beyond), 0.0);
  }
  const double h = 1e-3;
  const double left = (EmergencyRiseRate(p, 2530.5) - EmergencyRiseRate(p, 2530.5 - h)) / h;
  const double right = (EmergencyRiseRate(p, 2530.5 + h) - EmergencyRiseRate(p, 2530.5)) / h;
  EXPECT_NEAR(left, right, 1e-3 * k);
  // A train of 20 km with one source brakes to its end.
  AirBrakeParams lead_only = PaperBrake();
  lead_only.sources = {{"lead", 1}};
  std::vector<double> centres;
  for (int i = 0; i < 1000; ++i) centres.push_back(-20.0 * i);
  const AirBrake brake(lead_only, {Emergency(0.0)}, centres);
  const double beta = b1 / (1.0 + k * (19980.0 - 2530.5) / b1);
  EXPECT_NEAR(PressureOf(brake, 999, 300.0), 430e3 * (1.0 - std::exp(-beta * (300.0 - 19980.0 / 250.0))),
              kRounding * 430e3);
}

TEST(AirBrake, AnOpenPipeIsAnEmergencyFromBothSidesThatNothingEnds) {
  AirBrake brake = Brake({Apply(2.0, 50.0), Release(30.0), Apply(200.0, 50.0), Release(400.0)});
  const AirBrake before = brake;
  constexpr int kConnection = 60;  // between vehicles 61 and 62
  brake.OpenPipe(20.0, kConnection);
  for (int i = 0; i < kVehicles; i += 5) {
    const double distance = kPitch * (i <= kConnection ? kConnection - i : i - kConnection - 1);
    const double arrival = 20.0 + distance / 250.0;
    EXPECT_EQ(PressureOf(brake, i, arrival - 1e-9), PressureOf(before, i, arrival - 1e-9)) << i;
    const double met = PressureOf(before, i, arrival);
    const double beta = 0.238 - 0.1683 * distance / 2530.5;
    for (const double t : {arrival + 3.0, 100.0, 1000.0}) {
      EXPECT_NEAR(PressureOf(brake, i, t), met + (430e3 - met) * (1.0 - std::exp(-beta * (t - arrival))),
                  kRounding * 430e3)
          << i;
    }
  }
}

TEST(AirBrake, AnEmergencyInForceGoesOnThroughAnOpenPipe) {
  AirBrake brake = Brake({Emergency(2.0), Release(80.0)});
  brake.OpenPipe(30.0, 100);
  const AirBrake emergency = Brake({Emergency(2.0)});
  for (int i = 0; i < kVehicles; i += 7) {
    for (const double t : {20.0, 45.0, 150.0}) EXPECT_EQ(PressureOf(brake, i, t), PressureOf(emergency, i, t));
  }
}

TEST(AirBrake, MeasuredReductionsAreReproduced) {
  const ServiceApplicationParams& s = PaperBrake().service;
  for (size_t k = 0; k < s.reduction_kpa.size(); ++k) {
    const AirBrake brake = Brake({Apply(0.0, s.reduction_kpa[k])});
    EXPECT_NEAR(PressureOf(brake, 0, 1e4), 1e3 * s.cylinder_pressure_kpa[k], 1e-6);  // exp(-400) later
    EXPECT_NEAR(ArrivalTime(brake, 20), 20 * kPitch / s.wave_speed_mps[k], 1e-12);
    const double quarter_rise = std::log(4.0 / 3.0) / s.rise_rate_per_s[k];
    EXPECT_NEAR(PressureOf(brake, 0, quarter_rise), 250.0 * s.cylinder_pressure_kpa[k], 1e-6);
  }
}

TEST(AirBrake, BetweenMeasurementsNothingOvershoots) {
  const ServiceApplicationParams& s = PaperBrake().service;
  double before = 0.0;
  for (double reduction = 50.0; reduction <= 170.0; reduction += 0.5) {
    const double p = PressureOf(Brake({Apply(0.0, reduction)}), 0, 1e4);
    EXPECT_GT(p, before);  // the measured pressures ascend
    before = p;
    const size_t k =
        std::upper_bound(s.reduction_kpa.begin(), s.reduction_kpa.end() - 1, reduction) - s.reduction_kpa.begin();
    EXPECT_GE(p, 1e3 * s.cylinder_pressure_kpa[k - 1] - 1e-6);
    EXPECT_LE(p, 1e3 * s.cylinder_pressure_kpa[k] + 1e-6);
  }
}

TEST(AirBrake, WithoutCommandsNothingBrakes) {
  const AirBrake brake = Brake({});
  EXPECT_EQ(brake.vehicles(), kVehicles);
  EXPECT_EQ(PressureOf(brake, 100, 1e6), 0.0);
  EXPECT_EQ(ArrivalTime(brake, 100), std::numeric_limits<double>::infinity());
}

TEST(AirBrake, WrongInputIsRefused) {
  const std::vector<double> ten(10, 0.0);
  EXPECT_THROW(AirBrake(PaperBrake(), {Emergency(0.0)}, ten),
               std::invalid_argument);                             // source at vehicle 122 of 10
  EXPECT_THROW(Brake({Apply(0.0, 49.9)}), std::invalid_argument);  // outside the measured range
  EXPECT_THROW(Brake({Apply(0.0, 170.1)}), std::invalid_argument);
  EXPECT_THROW(Brake({Apply(5.0, 60.0), Release(4.0)}), std::invalid_argument);  // back in time
  AirBrakeParams slow = PaperBrake();
  slow.emergency.rise_rate_fall_per_s = slow.emergency.rise_rate_per_s;  // nothing would be left
  EXPECT_THROW(strict_config::Validate(slow), std::invalid_argument);
  AirBrakeParams no_charger = PaperBrake();
  for (BrakeSourceParams& source : no_charger.sources) source.releases = false;
  EXPECT_THROW(AirBrake(no_charger, {Apply(0.0, 70.0), Release(9.0)}, PaperTrain()), std::invalid_argument);
  EXPECT_THROW(AirBrake(no_charger, {Apply(0.0, 70.0), Apply(9.0, 60.0)}, PaperTrain()), std::invalid_argument);
}

}  // namespace
}  // namespace train_dynamics
