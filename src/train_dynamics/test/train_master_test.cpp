#include "train_dynamics/train/train_master.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "simulate.h"

namespace train_dynamics {
namespace {

TEST(Exchange, AnIntervalOfFiveMillisecondsIsHarmless) {
  for (const char* model : {"model=2d", "model=ltd"}) {
    const Outcome fine = Simulate("emergency", {model});
    const Outcome coarse = Simulate("emergency", {model, "exchange_interval_s=0.005"});
    // Both bounds are what a prototype found for the calibrated gears.
    EXPECT_NEAR(coarse.mean_speed_kmh, fine.mean_speed_kmh, 1e-4) << model;
    ASSERT_EQ(coarse.coupler_extremes.size(), 241u);
    double largest = 0.0;
    for (size_t c = 0; c < fine.coupler_extremes.size(); ++c) {
      const ForceExtremes &a = fine.coupler_extremes[c], &b = coarse.coupler_extremes[c];
      EXPECT_NEAR(b.tension_n, a.tension_n, 5e3) << model << ", connection " << c + 1;
      EXPECT_NEAR(b.compression_n, a.compression_n, 5e3) << model << ", connection " << c + 1;
      largest = std::max(largest, a.tension_n - a.compression_n);
    }
    EXPECT_GT(largest, 500e3) << model;  // 5 kN is a hundredth of what the couplers bear
  }
}

TEST(Exchange, NewmarkRunsTheSameTrain) {
  const Outcome leapfrog = Simulate("full_service", {"model=ltd", "duration_s=30"});
  const Outcome newmark = Simulate("full_service", {"model=ltd", "duration_s=30", "integrator=newmark"});
  // The same trajectory, sampled half a step apart: rounding of 30000 steps.
  EXPECT_NEAR(newmark.mean_speed_kmh, leapfrog.mean_speed_kmh, 1e-9);
  ExpectLedgerCloses(newmark, "newmark");
}

TEST(Records, ComeAtTheirTimes) {
  const Outcome outcome =
      Simulate("single_wagon_stop", {"duration_s=0.5", "record_interval_s=0.1", "ledger_interval_s=0.2"});
  ASSERT_EQ(outcome.record_times.size(), 6u);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(outcome.record_times[i], 0.1 * i, 1e-15);
  EXPECT_TRUE(std::isnan(outcome.accelerations.front()));
  for (int i = 1; i < 6; ++i) EXPECT_LT(outcome.accelerations[i], 0.0);  // the resistance slows it
  EXPECT_NEAR(outcome.ledger.time_s, 0.5, 1e-15);                        // the last record has a ledger, due or not
}

// Vehicles in this process, of which the second gets a brake pressure that is NaN from 0.5 s on.
class SpoiltTransport : public InProcessTransport {
 public:
  using InProcessTransport::InProcessTransport;
  void Exchange(const ExchangeRequest& request, ExchangeReply& reply) override {
    ExchangeRequest spoilt = request;
    if (request.exchange >= 500) {
      spoilt.cylinder_pressure_pa[1] = std::numeric_limits<double>::quiet_NaN();
    }
    InProcessTransport::Exchange(spoilt, reply);
  }
};

// Runs a scenario whose brake pressures become NaN at vehicle 2 after 0.5 s; the fault's text.
std::string FaultOf(const std::string& scenario, const std::vector<std::string>& overrides) {
  const config::LoadedScenario loaded = config::LoadScenario(ScenarioFile(scenario), overrides);
  SpoiltTransport transport(loaded.params, loaded.consist, 2);
  TrainMaster master(loaded.params, loaded.consist, transport, loaded.pressures);
  try {
    master.Start();
    while (!master.Done()) master.Exchange();
  } catch (const SimulationFault& fault) {
    EXPECT_NEAR(master.time_s(), 0.501, 1e-12);  // the end of the very exchange
    return fault.what();
  }
  return "none";
}

TEST(Faults, NameVehicleBodyQuantityAndTime) {
  EXPECT_EQ(FaultOf("emergency", {"model=ltd"}), "vehicle 2: speed is nan m/s at t = 0.501000 s");
  EXPECT_EQ(FaultOf("emergency", {"model=2d"}), "vehicle 2: wheelset 1 speed is nan m/s at t = 0.501000 s");
}

TEST(Faults, AnAbsurdStateEndsTheRun) {
  try {
    Simulate("dip", {"track.dips[0].depth_m=-1", "track.dips[0].length_m=2"});  // a wall of one metre
    ADD_FAILURE() << "the run went through";
  } catch (const SimulationFault& fault) {
    const std::string what = fault.what();
    EXPECT_EQ(what.find("vehicle 1: "), 0u) << what;
    EXPECT_NE(what.find(" at t = "), std::string::npos) << what;
  }
}

}  // namespace
}  // namespace train_dynamics
