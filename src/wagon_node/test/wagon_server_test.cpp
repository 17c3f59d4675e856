#include "wagon_node/wagon_server.h"

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "strict_config/writer.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/in_process_train.h"

namespace wagon_node {
namespace {

using testing::Test;
using train_brake_msgs::ConfigureRequest;
using train_brake_msgs::ConfigureResponse;
using train_brake_msgs::StepRequest;
using train_brake_msgs::StepResponse;
using train_dynamics::config::LoadedScenario;

constexpr std::uint64_t kRun = 17, kOtherRun = 18;
constexpr int kFirst = 2, kCount = 3;  // the rank: vehicles 3-5 of 6

LoadedScenario Load(const std::vector<std::string>& overrides = {}) {
  return train_dynamics::config::LoadScenario(std::string(TRAIN_BRAKE_CONFIG_DIR) + "/../test/short_train.yaml",
                                              overrides);
}

ConfigureRequest ConfigureFor(const LoadedScenario& scenario) {
  ConfigureRequest request;
  request.protocol_version = ConfigureRequest::PROTOCOL_VERSION;
  request.run_id = kRun;
  request.first_vehicle = kFirst + 1;
  request.vehicle_count = kCount;
  request.scenario = strict_config::Write(scenario.params);
  request.scenario_digest = train_dynamics::TextDigest(request.scenario);
  return request;
}

/// Forces and pressures that differ from vehicle to vehicle and from exchange to exchange.
StepRequest StepFor(const LoadedScenario& scenario, std::uint64_t exchange) {
  StepRequest request;
  request.run_id = kRun;
  request.exchange = exchange;
  request.dt_s = scenario.params.dt_s;
  request.steps = static_cast<std::uint32_t>(scenario.params.StepsPerExchange());
  request.record = request.ledger = exchange % 5 == 4;
  for (int i = 0; i <= kCount; ++i) {
    request.coupler_force_n.push_back(1e4 * (i + 1) * (exchange % 2 == 0 ? 1.0 : -1.0));
    if (i < kCount) request.cylinder_pressure_pa.push_back(1e5 * i);
  }
  return request;
}

/// A message bit by bit, so that NaN equals NaN.
template <class Message>
std::string Bytes(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  stream.next(message);
  return {bytes.begin(), bytes.end()};
}

class WagonServerTest : public Test {
 protected:
  ConfigureResponse Configure(const ConfigureRequest& request, bool driven = true) {
    ConfigureResponse response;
    server_.Configure(request, driven, response);
    return response;
  }
  void Begin() { ASSERT_TRUE(Configure(ConfigureFor(scenario_)).ok); }
  StepResponse Step(std::uint64_t exchange) { return server_.Step(StepFor(scenario_, exchange)); }

  void ExpectRefused(const StepRequest& request, const std::string& text) {
    const StepResponse response = server_.Step(request);
    EXPECT_FALSE(response.ok) << text;
    EXPECT_EQ(response.message, text);
    EXPECT_TRUE(response.head_velocity_mps.empty());
  }
  void ExpectRefused(const ConfigureRequest& request, const std::string& text, bool driven = true) {
    const ConfigureResponse response = Configure(request, driven);
    EXPECT_FALSE(response.ok) << text;
    EXPECT_EQ(response.message, text);
    EXPECT_TRUE(response.record.state_digest.empty());
  }

  const LoadedScenario scenario_ = Load();
  WagonServer server_{1};
};

// ---- the right bits ----

/// Compares a rank with the same vehicles in this process, request by request.
class Mirror : public train_dynamics::Transport {
 public:
  Mirror(const LoadedScenario& scenario, int threads)
      : scenario_(scenario), vehicles_(scenario.params, scenario.consist, 1), server_(threads) {}

  void Start(train_dynamics::ExchangeReply& reply) override {
    vehicles_.Start(reply);
    ConfigureResponse response;
    server_.Configure(ConfigureFor(scenario_), false, response);
    ASSERT_TRUE(response.ok) << response.message;
    ExpectSlice(response.head_displacement_m, reply.head_displacement_m);
    ExpectSlice(response.head_velocity_mps, reply.head_velocity_mps);
    ExpectRecord(response.record, reply);
    ExpectEnergies(response.record, reply);
  }

  void Resume(std::uint64_t, const std::vector<train_dynamics::StateRow>&, train_dynamics::ExchangeReply&) override {
    FAIL() << "no call of this test asks for it";
  }

  void Exchange(const train_dynamics::ExchangeRequest& request, train_dynamics::ExchangeReply& reply) override {
    vehicles_.Exchange(request, reply);
    StepRequest part = StepFor(scenario_, request.exchange);
    part.record = request.record;
    part.ledger = request.ledger;
    const auto force = request.coupler_force_n.begin() + kFirst;
    const auto pressure = request.cylinder_pressure_pa.begin() + kFirst;
    part.coupler_force_n.assign(force, force + kCount + 1);
    part.cylinder_pressure_pa.assign(pressure, pressure + kCount);
    const StepResponse& response = server_.Step(part);
    ASSERT_TRUE(response.ok) << response.message;
    EXPECT_EQ(response.exchange, request.exchange);
    EXPECT_EQ(response.fault_vehicle, 0u);
    ExpectSlice(response.head_displacement_m, reply.head_displacement_m);
    ExpectSlice(response.head_velocity_mps, reply.head_velocity_mps);
    if (request.record) ExpectRecord(response.record, reply);
    EXPECT_EQ(response.record.state_digest.empty(), !request.record);
    if (request.ledger) ExpectEnergies(response.record, reply);
    EXPECT_EQ(response.record.kinetic_j.empty(), !request.ledger);
  }

 private:
  template <class Part, class Whole>
  static void ExpectSlice(const Part& part, const Whole& whole) {
    ASSERT_EQ(part.size(), static_cast<std::size_t>(kCount));
    EXPECT_TRUE(std::equal(part.begin(), part.end(), whole.begin() + kFirst, [](auto a, auto b) {
      return a == b || (a != a && b != b);  // NaN where LTD computes nothing
    }));
  }

  void ExpectRecord(const train_brake_msgs::RankRecord& record, const train_dynamics::ExchangeReply& reply) {
    train_dynamics::ForEachRecordField(
        [](const train_dynamics::RecordInfo& field, const auto& part, const auto& whole) {
          SCOPED_TRACE(field.name);
          ExpectSlice(part, whole);
        },
        record, reply);
    ExpectSlice(record.state_digest, reply.state_digest);
    // Of the vehicles 1, 4 and 6 in full detail, 4 is in the rank.
    const bool has_details = scenario_.params.VehicleModels()[3] == train_dynamics::VehicleModel::kTwoD;
    ASSERT_EQ(record.details.size(), has_details ? 1u : 0u);
    if (!has_details) return;
    EXPECT_EQ(record.details[0].vehicle, 4u);
    const auto found = std::find_if(reply.details.begin(), reply.details.end(),
                                    [](const train_dynamics::WagonDetail& one) { return one.vehicle == 3; });
    ASSERT_NE(found, reply.details.end());
    const train_dynamics::WagonDetail& detail = *found;
    EXPECT_TRUE(std::equal(detail.velocity.pitch.begin(), detail.velocity.pitch.end(),
                           record.details[0].body_pitch_radps.begin()));
  }

  static void ExpectEnergies(const train_brake_msgs::RankRecord& record, const train_dynamics::ExchangeReply& reply) {
    ASSERT_EQ(record.dissipated_j.size(), std::size_t{kCount} * train_dynamics::kDissipations);
    for (int i = 0; i < kCount; ++i) {
      const train_dynamics::VehicleEnergy& energy = reply.energy[kFirst + i];
      EXPECT_EQ(record.kinetic_j[i], energy.kinetic_j);
      EXPECT_EQ(record.potential_j[i], energy.potential_j);
      EXPECT_EQ(record.gravity_work_j[i], energy.gravity_work_j);
      EXPECT_TRUE(std::equal(energy.dissipated_j.begin(), energy.dissipated_j.end(),
                             record.dissipated_j.begin() + i * train_dynamics::kDissipations));
    }
  }

  const LoadedScenario& scenario_;
  train_dynamics::InProcessTransport vehicles_;
  WagonServer server_;
};

TEST(WagonServer, ComputesTheBitsOfTheTrainInOneProcess) {
  const std::vector<std::vector<std::string>> models = {
      {"model=2d"},
      {"model=ltd"},
      {"train.consist[1].model=ltd", "train.consist[2].model=ltd-no-inertia"},
      {"model=ltd", "train.consist[1].model=2d"}};
  for (const std::vector<std::string>& overrides : models) {
    for (const int threads : {1, 2}) {
      SCOPED_TRACE(overrides.back() + ", threads: " + std::to_string(threads));
      const LoadedScenario scenario = Load(overrides);
      Mirror mirror(scenario, threads);
      train_dynamics::TrainMaster master(scenario.params, scenario.consist, mirror, scenario.pressures);
      master.Start();
      while (!master.Done() && !Test::HasFatalFailure()) master.Exchange();
    }
  }
}

// ---- snapshots ----

TEST_F(WagonServerTest, GoesOnFromASnapshotToTheSameBits) {
  Begin();
  StepRequest last = StepFor(scenario_, 6);
  last.snapshot = true;
  for (std::uint64_t k = 0; k < 6; ++k) EXPECT_TRUE(Step(k).snapshot.empty());
  ConfigureRequest restored = ConfigureFor(scenario_);
  restored.snapshot = server_.Step(last).snapshot;
  restored.exchange = 7;
  WagonServer other(2);
  ConfigureResponse response;
  other.Configure(restored, false, response);
  ASSERT_TRUE(response.ok) << response.message;
  EXPECT_EQ(response.head_velocity_mps,
            server_.Step(last).head_velocity_mps);  // where the snapshot was taken
  // What came before is not stored here: a repeated exchange has no reply.
  EXPECT_EQ(other.Step(StepFor(scenario_, 6)).message, "exchange 6 is past: exchange 7 is next");
  for (std::uint64_t k = 7; k < 30; ++k) {
    ASSERT_EQ(Bytes(Step(k)), Bytes(other.Step(StepFor(scenario_, k)))) << "exchange " << k;
  }
  // And back again, in the middle of the same run.
  restored.again = true;
  EXPECT_TRUE(Configure(restored).ok);
  EXPECT_TRUE(Step(7).ok);
}

TEST_F(WagonServerTest, RefusesASnapshotThatDoesNotFit) {
  Begin();
  StepRequest step = StepFor(scenario_, 0);
  step.snapshot = true;
  ConfigureRequest request = ConfigureFor(scenario_);
  request.run_id = kOtherRun;
  request.snapshot = server_.Step(step).snapshot;
  request.exchange = 1;
  const ConfigureRequest good = request;
  request.exchange = 2;
  ExpectRefused(request, "the snapshot is of exchange 1, not of exchange 2", false);
  request = good;
  request.first_vehicle = 1;
  ExpectRefused(request, "the snapshot is of 3 vehicle(s) from 3 on, not of vehicles 1-3", false);
  request = good;
  request.snapshot[40] ^= 1;
  ExpectRefused(request, "the snapshot is damaged or cut short: its checksum is wrong", false);
  request = good;
  request.snapshot.clear();
  ExpectRefused(request, "exchange 1 cannot be begun without a snapshot", false);
  const LoadedScenario ltd = Load({"model=ltd"});
  request = ConfigureFor(ltd);
  request.run_id = kOtherRun;
  request.snapshot = good.snapshot;
  request.exchange = 1;
  const ConfigureResponse response = Configure(request, false);
  EXPECT_FALSE(response.ok);
  EXPECT_NE(response.message.find("but one of the ltd model has"), std::string::npos) << response.message;
  EXPECT_TRUE(Step(1).ok);  // none of it has touched the run
}

// ---- repeats ----

TEST_F(WagonServerTest, RepeatsItsLastReplyAndMovesNothing) {
  Begin();
  WagonServer twin(1);
  ConfigureResponse response;
  twin.Configure(ConfigureFor(scenario_), false, response);
  for (std::uint64_t exchange = 0; exchange < 10; ++exchange) {
    const std::string first = Bytes(Step(exchange));
    EXPECT_EQ(Bytes(Step(exchange)), first);
    EXPECT_EQ(Bytes(Step(exchange)), first);
    EXPECT_EQ(Bytes(twin.Step(StepFor(scenario_, exchange))), first);
  }
}

TEST_F(WagonServerTest, RefusesARepetitionWithOtherInputs) {
  Begin();
  Step(0);
  const StepRequest right = StepFor(scenario_, 1);
  const std::string reply = Bytes(server_.Step(right));
  const std::vector<std::function<void(StepRequest&)>> changes = {
      [](auto& r) { r.coupler_force_n[1] += 1.0; },
      [](auto& r) { r.cylinder_pressure_pa[2] += 1.0; },
      [](auto& r) { r.coupler_force_n.clear(); },
      [](auto& r) { r.coupler_force_n[0] = std::numeric_limits<double>::quiet_NaN(); },
      [](auto& r) {
        r.friction_patches = {10.0, 20.0, 0.1};
      },
      [](auto& r) { r.steps += 1; },
      [](auto& r) { r.dt_s *= 2.0; }};
  for (const auto& change : changes) {
    StepRequest other = right;
    change(other);
    ExpectRefused(other, "exchange 1 has been computed already, with other loads");
  }
  StepRequest other_flags = right;
  other_flags.record = other_flags.ledger = true;
  EXPECT_EQ(Bytes(server_.Step(other_flags)), reply);
  EXPECT_TRUE(Step(2).ok);
}

TEST_F(WagonServerTest, PatchesOfRailStayOnceTheyHaveCome) {
  Begin();
  const std::vector<double> one = {-500.0, 500.0, 0.02}, two = {-500.0, 500.0, 0.02, -90.0, -10.0, 0.3};
  const auto step = [this](std::uint64_t exchange, const std::vector<double>& patches) {
    StepRequest request = StepFor(scenario_, exchange);
    request.friction_patches = patches;
    return request;
  };
  const std::string past = "friction_patches does not begin with those of the exchange before";
  const std::string known = "exchange 1 has been computed already, with other loads";
  ASSERT_TRUE(server_.Step(step(0, one)).ok);
  ExpectRefused(step(1, {}), past);
  ExpectRefused(step(1, {-500.0, 501.0, 0.02}), past);
  ExpectRefused(step(1, {-90.0, -10.0, 0.3, -500.0, 500.0, 0.02}), past);
  StepRequest with_snapshot = step(1, two);
  with_snapshot.snapshot = true;
  const StepResponse snapshot = server_.Step(with_snapshot);
  ASSERT_TRUE(snapshot.ok);
  ExpectRefused(step(1, one), known);
  // All answers up to records that feel the rail.
  const auto go_on = [&](WagonServer& server, const std::vector<double>& patches) {
    std::string answers;
    for (std::uint64_t exchange = 2; exchange < 15; ++exchange) answers += Bytes(server.Step(step(exchange, patches)));
    return answers;
  };
  const std::string whole = go_on(server_, two);

  // Who takes its place knows of no patch, and is told of all with its first exchange.
  ConfigureRequest again = ConfigureFor(scenario_);
  again.again = true;
  again.exchange = 2;
  again.snapshot = snapshot.snapshot;
  WagonServer other(1);
  for (WagonServer* server : {&other, &server_}) {
    ConfigureResponse configured;
    server->Configure(again, true, configured);
    ASSERT_TRUE(configured.ok) << configured.message;
    EXPECT_TRUE(go_on(*server, two) == whole);
  }
  ASSERT_TRUE(Configure(again).ok);
  EXPECT_FALSE(go_on(server_, {}) == whole);
}

TEST_F(WagonServerTest, TellsItsRunToNobody) {
  ConfigureRequest configure = ConfigureFor(scenario_);
  configure.run_id = 7234981734512349871;
  ASSERT_TRUE(Configure(configure).ok);
  StepRequest step = StepFor(scenario_, 0);
  configure.run_id = kOtherRun;
  for (const std::string& text : {Configure(configure).message, server_.Step(step).message}) {
    EXPECT_EQ(text.find("7234981734512349871"), std::string::npos) << text;
  }
}

TEST_F(WagonServerTest, MayBeConfiguredOnceMoreBeforeTheFirstExchange) {
  Begin();
  const ConfigureRequest request = ConfigureFor(scenario_);
  EXPECT_EQ(Bytes(Configure(request)), Bytes(Configure(request)));
  ASSERT_TRUE(Step(0).ok);
  ExpectRefused(request, "run 17 is configured already, and exchange 1 is next");
  EXPECT_TRUE(Step(1).ok);
}

// ---- refusals ----

TEST_F(WagonServerTest, RefusesStepsWithoutARun) {
  ExpectRefused(StepFor(scenario_, 0), "this wagon node has no run yet: Configure comes first");
}

TEST_F(WagonServerTest, RefusesStepsThatDoNotFitAndStaysAsItWas) {
  Begin();
  WagonServer twin(1);
  ConfigureResponse ignored;
  twin.Configure(ConfigureFor(scenario_), false, ignored);
  for (std::uint64_t exchange = 0; exchange < 5; ++exchange) {
    Step(exchange);
    twin.Step(StepFor(scenario_, exchange));
  }
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const std::vector<std::pair<std::function<void(StepRequest&)>, std::string>> wrong = {
      {[](auto& r) { r.run_id = kOtherRun; }, "run 18 is not known here: this wagon node is in another run"},
      {[](auto& r) { r.exchange = 3; }, "exchange 3 is past: exchange 5 is next"},
      {[](auto& r) { r.exchange = 7; }, "exchange 7 leaves a gap: exchange 5 is next"},
      {[](auto& r) { r.exchange = ~std::uint64_t{0}; },
       "exchange 18446744073709551615 leaves a gap: exchange 5 is next"},
      {[](auto& r) { r.dt_s = 0.0005; }, "2 steps of 0.0005 s are asked for, but it is 2 of 0.001 s in the scenario"},
      {[nan](auto& r) { r.dt_s = nan; }, "2 steps of nan s are asked for, but it is 2 of 0.001 s in the scenario"},
      {[](auto& r) { r.steps = 4000000000; },
       "4000000000 steps of 0.001 s are asked for, but it is 2 of 0.001 s in the scenario"},
      {[](auto& r) { r.coupler_force_n.pop_back(); }, "coupler_force_n has 3 values, expected 4"},
      {[](auto& r) {
         r.friction_patches = {10.0, 20.0};
       },
       "friction_patches has 2 values, expected three for each patch, at most 300"},
      {[](auto& r) { r.friction_patches.assign(303, 0.1); },
       "friction_patches has 303 values, expected three for each patch, at most 300"},
      {[nan](auto& r) {
         r.friction_patches = {10.0, nan, 0.1};
       },
       "friction_patches from [0] on is no patch of rail"},
      {[](auto& r) { r.friction_patches = {10.0, 20.0, 0.1, 30.0, 30.0, 0.1}; },
       "friction_patches from [3] on is no patch of rail"},
      {[](auto& r) { r.cylinder_pressure_pa.push_back(0.0); }, "cylinder_pressure_pa has 4 values, expected 3"},
      {[](auto& r) { r.cylinder_pressure_pa.clear(); }, "cylinder_pressure_pa has 0 values, expected 3"},
      {[nan](auto& r) { r.coupler_force_n[3] = nan; }, "coupler_force_n[3] is nan, must be finite"},
      {[infinity](auto& r) { r.cylinder_pressure_pa[1] = -infinity; },
       "cylinder_pressure_pa[1] is -inf, must be finite"},
  };
  for (const auto& [spoil, text] : wrong) {
    StepRequest request = StepFor(scenario_, 5);
    spoil(request);
    ExpectRefused(request, text);
  }
  EXPECT_EQ(Bytes(Step(5)), Bytes(twin.Step(StepFor(scenario_, 5))));
  EXPECT_EQ(Bytes(Step(6)), Bytes(twin.Step(StepFor(scenario_, 6))));
}

TEST_F(WagonServerTest, RefusesConfigurationsThatDoNotFitAndStaysAsItWas) {
  Begin();
  const StepResponse before = Step(0);
  const std::string digest = [this] {
    char text[24];
    std::snprintf(text, sizeof text, "0x%016lx", ConfigureFor(scenario_).scenario_digest);
    return std::string(text);
  }();
  const std::vector<std::pair<std::function<void(ConfigureRequest&)>, std::string>> wrong = {
      {[](auto& r) { r.protocol_version = 99; }, "the master speaks protocol version 99, this wagon node version " +
                                                     std::to_string(ConfigureRequest::PROTOCOL_VERSION) +
                                                     ": both must be of the same build"},
      {[](auto& r) { r.scenario_digest = 0xabc; },
       "the scenario should have the digest 0x0000000000000abc, but has " + digest + " as it arrived"},
      {[](auto& r) { r.run_id = 0; }, "run_id is 0, which stands for no run"},
      {[](auto& r) { r.first_vehicle = 0; }, "first_vehicle 0 and vehicle_count 3 are not in a train of 6 vehicles"},
      {[](auto& r) { r.first_vehicle = 5; }, "first_vehicle 5 and vehicle_count 3 are not in a train of 6 vehicles"},
      {[](auto& r) { r.vehicle_count = 0; }, "first_vehicle 3 and vehicle_count 0 are not in a train of 6 vehicles"},
      {[](auto& r) { r.vehicle_count = 4294967295; },
       "first_vehicle 3 and vehicle_count 4294967295 are not in a train of 6 vehicles"},
  };
  for (const auto& [spoil, text] : wrong) {
    ConfigureRequest request = ConfigureFor(scenario_);
    request.run_id = kOtherRun;
    spoil(request);
    ExpectRefused(request, text, false);
  }
  ConfigureRequest other = ConfigureFor(scenario_);
  other.run_id = kOtherRun;
  ExpectRefused(other, "this wagon node is driven in another run, and run 18 must wait until that has ended");
  EXPECT_EQ(Bytes(Step(0)), Bytes(before));
  EXPECT_TRUE(Step(1).ok);
  EXPECT_EQ(server_.run_id(), kRun);
}

TEST_F(WagonServerTest, NamesWhatIsWrongWithAScenario) {
  ConfigureRequest request = ConfigureFor(scenario_);
  const auto set_scenario = [&request](const std::string& text) {
    request.scenario = text;
    request.scenario_digest = train_dynamics::TextDigest(text);
  };
  std::string text = request.scenario;
  const std::size_t place = text.find("duration_s: ") + 12;
  text.insert(place, "-");
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(place), '\n');
  set_scenario(text);
  ExpectRefused(request, "the scenario cannot be used:\nscenario:" + std::to_string(line) +
                             ": duration_s must be in (0, 1000000), got -0.2");
  set_scenario("name: [");
  EXPECT_FALSE(Configure(request).ok);
  set_scenario("");
  EXPECT_FALSE(Configure(request).ok);
}

TEST_F(WagonServerTest, ReadsNoFilesForAMaster) {
  ConfigureRequest request = ConfigureFor(scenario_);
  request.scenario = "train: /etc/passwd\ntrack: level\n";
  request.scenario_digest = train_dynamics::TextDigest(request.scenario);
  const ConfigureResponse response = Configure(request);
  EXPECT_FALSE(response.ok);
  EXPECT_NE(response.message.find("scenario:1: train must be a map, because no files are read here"), std::string::npos)
      << response.message;
}

// ---- runs ----

TEST_F(WagonServerTest, StartsAnotherRunWhenNobodyDrivesThePresentOne) {
  Begin();
  ASSERT_TRUE(Step(0).ok);
  ConfigureRequest other = ConfigureFor(scenario_);
  other.run_id = kOtherRun;
  ASSERT_TRUE(Configure(other, false).ok);
  ExpectRefused(StepFor(scenario_, 1), "run 17 is not known here: this wagon node is in another run");
  StepRequest step = StepFor(scenario_, 0);
  step.run_id = kOtherRun;
  EXPECT_TRUE(server_.Step(step).ok);
}

TEST_F(WagonServerTest, NamesTheVehicleThatGoesAstray) {
  Begin();
  StepRequest request = StepFor(scenario_, 0);
  request.coupler_force_n[2] = 1e13;  // pulls vehicle 4 back and vehicle 5 on, far beyond any speed of a train
  const StepResponse& response = server_.Step(request);
  EXPECT_TRUE(response.ok);
  EXPECT_EQ(response.fault_vehicle, 4u);
  EXPECT_NE(response.fault.find("carbody speed is -"), std::string::npos) << response.fault;
}

}  // namespace
}  // namespace wagon_node
