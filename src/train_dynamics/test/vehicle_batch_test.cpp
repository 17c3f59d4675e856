// A batch is only a way to step vehicles fast: whatever the instruction set and the number of lanes, each one
// moves as the scalar step moves it, bit for bit. The same for the laws between vehicles.
#include "train_dynamics/vehicle/vehicle_batch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "paper_vehicle.h"
#include "train_dynamics/numeric/digest.h"
#include "train_dynamics/vehicle/wagon_step.h"

namespace train_dynamics {
namespace {

constexpr int kVehicles = 11;  // fills no pack exactly, so that the last one has spare lanes

// The arrays of an exchange.
struct Arrays {
  std::vector<double> coupler_n = std::vector<double>(kVehicles + 1);
  std::vector<double> pressure_pa = std::vector<double>(kVehicles);
  std::vector<double> displacement_m = std::vector<double>(kVehicles + 1, -1.0);
  std::vector<double> velocity_mps = std::vector<double>(kVehicles + 1, -1.0);
  std::vector<double> traction_n, dynamic_brake_n;  ///< empty: not used

  void Set(int exchange) {
    for (int i = 0; i <= kVehicles; ++i) coupler_n[i] = 1e5 * std::sin(0.1 * exchange + i);
    for (int i = 0; i < kVehicles; ++i) pressure_pa[i] = 3e3 * exchange + 1e3 * i;
  }
  VehicleLoads<double> Of(int i) const {
    VehicleLoads<double> loads;
    loads.front_coupler_n = coupler_n[i];
    loads.rear_coupler_n = coupler_n[i + 1];
    loads.cylinder_pressure_pa = pressure_pa[i];
    if (!traction_n.empty()) loads.traction_n = traction_n[i];
    if (!dynamic_brake_n.empty()) loads.dynamic_brake_n = dynamic_brake_n[i];
    return loads;
  }
  LoadPlaces Loads() const {
    LoadPlaces places;
    places.front_coupler_n = coupler_n.data();
    places.rear_coupler_n = coupler_n.data() + 1;
    places.cylinder_pressure_pa = pressure_pa.data();
    if (!traction_n.empty()) places.traction_n = traction_n.data();
    if (!dynamic_brake_n.empty()) places.dynamic_brake_n = dynamic_brake_n.data();
    return places;
  }
  ReplyPlaces Reply() {
    ReplyPlaces places;
    places.head_displacement_m = displacement_m.data();
    places.head_velocity_mps = velocity_mps.data();
    return places;
  }
};

/// What a batch records of its vehicles against the law for one of them, bit for bit.
template <class Vehicle, class State, class Output>
void ExpectRecords(const VehicleBatch<Vehicle>& batch, const std::vector<State>& states,
                   const std::vector<Output>& outputs) {
  ReplyArrays reply;
  RecordArrays record;
  ResizeReply(kVehicles + 1, reply);
  ResizeRecord(kVehicles + 1, record);
  const auto mark = [](const RecordInfo&, std::vector<double>& array) { array.assign(array.size(), -1.0); };
  ForEachReplyField(mark, reply);
  ForEachRecordField(mark, record);
  batch.Record(PlacesOf(reply, 0), PlacesOf(record, 0));
  for (int i = 0; i < kVehicles; ++i) {
    EXPECT_EQ(CouplerHeadDisplacement(batch.vehicle(), states[i]), reply.head_displacement_m[i]);
    EXPECT_EQ(CouplerHeadVelocity(batch.vehicle(), states[i]), reply.head_velocity_mps[i]);
    const VehicleRecord<double> one = RecordOf(batch.vehicle(), states[i], outputs[i]);
    const auto expect = [i](const RecordInfo& field, double expected, const std::vector<double>& array) {
      EXPECT_EQ(ToBits(expected), ToBits(array[i])) << "vehicle " << i << ", " << field.name;
    };
    ForEachRecordField(expect, one, record);
  }
  const auto expect_mark = [](const RecordInfo& field, const std::vector<double>& array) {
    EXPECT_EQ(-1.0, array[kVehicles]) << field.name;
  };
  ForEachReplyField(expect_mark, reply);
  ForEachRecordField(expect_mark, record);
}

class LaneKernelsTest : public testing::TestWithParam<LaneKernels> {
 protected:
  static std::vector<WagonState<double>> Wagons(const Wagon& wagon) {
    std::vector<WagonState<double>> states;
    for (int i = 0; i < kVehicles; ++i) states.push_back(StaticEquilibrium(wagon, -10.5 * i, 22.0 - 2.0 * i));
    return states;
  }
};

TEST_P(LaneKernelsTest, MoveEachWagonAsTheScalarStepDoes) {
  const Wagon wagon(OreWagon());
  TrackParams track;
  track.dips = {{5.0, 0.03, 10.0}};
  std::vector<WagonState<double>> states = Wagons(wagon);
  WagonBatch batch(wagon, GetParam(), states);
  ASSERT_EQ(kVehicles, batch.size());
  Arrays arrays;
  for (int exchange = 0; exchange < 200; ++exchange) {
    const bool with_output = exchange == 199;
    arrays.Set(exchange);
    std::vector<WagonOutput<double>> outputs(states.size());
    for (int i = 0; i < kVehicles; ++i) {
      for (int step = 0; step < 5; ++step) StepWagon(wagon, track, arrays.Of(i), 1e-3, states[i], &outputs[i]);
    }
    ASSERT_TRUE(batch.Advance(track, 1e-3, 5, arrays.Loads(), arrays.Reply(), with_output));
    for (int i = 0; i < kVehicles; ++i) {
      ASSERT_EQ(CouplerHead(wagon, states[i].position), arrays.displacement_m[i]) << "wagon " << i;
      ASSERT_EQ(CouplerHead(wagon, states[i].velocity), arrays.velocity_mps[i]) << "wagon " << i;
      if (!with_output) continue;
      const WagonState<double> s = batch.StateOf(i);
      EXPECT_EQ(states[i].position.z, s.position.z);
      EXPECT_EQ(states[i].position.pitch, s.position.pitch);
      EXPECT_EQ(states[i].velocity.x, s.velocity.x);
      EXPECT_EQ(states[i].work.dissipated, s.work.dissipated);
      EXPECT_EQ(outputs[i].creep_force_n, batch.OutputOf(i).creep_force_n);
      EXPECT_EQ(outputs[i].wedge_friction_n, batch.OutputOf(i).wedge_friction_n);
    }
  }
  EXPECT_EQ(arrays.velocity_mps[kVehicles], -1.0);  // what is behind the batch is not written
}

TEST_P(LaneKernelsTest, RecordWhatTheScalarLawDoesWhileWheelsRollAndSlide) {
  for (const bool slides : {false, true}) {
    VehicleParams params = OreWagon();
    if (slides) params.wheel_rail.adhesion.friction_coefficient = 0.02;
    const Wagon wagon(params);
    std::vector<WagonState<double>> states = Wagons(wagon);
    for (int i = 0; slides && i < kVehicles; ++i) {
      for (int w = 0; w < kWheelsets; ++w) states[i].velocity.pitch[kWheelset1 + w] = 0.0;
    }
    std::vector<WagonOutput<double>> outputs(kVehicles);
    WagonBatch batch(wagon, GetParam(), states);
    Arrays arrays;
    arrays.pressure_pa.assign(kVehicles, 300e3);
    for (int exchange = 0; exchange < 300; ++exchange) {
      for (int i = 0; i < kVehicles; ++i) {
        for (int step = 0; step < 5; ++step) StepWagon(wagon, {}, arrays.Of(i), 1e-3, states[i], &outputs[i]);
      }
      ASSERT_TRUE(batch.Advance({}, 1e-3, 5, arrays.Loads(), arrays.Reply(), true));
    }
    for (const WagonState<double>& state : states) {
      ASSERT_GT(state.velocity.x[kCarbody], 1.0);
      ASSERT_EQ(slides, state.velocity.pitch[kWheelset1] == 0.0);
    }
    ExpectRecords(batch, states, outputs);
    if (HasFailure()) return;
  }
}

TEST_P(LaneKernelsTest, LoadsThatFewTrainsHaveActWhereTheyAreGiven) {
  const Wagon wagon(OreWagon());
  const LtdVehicle ltd(OreWagon(), true);
  std::vector<WagonState<double>> wagons = Wagons(wagon);
  std::vector<LtdState<double>> ltds(kVehicles);
  for (int i = 0; i < kVehicles; ++i) ltds[i].v_mps = 22.0 - i;
  WagonBatch wagon_batch(wagon, GetParam(), wagons);
  LtdBatch ltd_batch(ltd, GetParam(), ltds);
  Arrays arrays;
  for (int i = 0; i < kVehicles; ++i) {
    arrays.traction_n.push_back(1e4 * i);
    arrays.dynamic_brake_n.push_back(3e3 * (kVehicles - i));
  }
  for (int exchange = 0; exchange < 50; ++exchange) {
    for (int i = 0; i < kVehicles; ++i) {
      StepWagon(wagon, {}, arrays.Of(i), 1e-3, wagons[i], static_cast<WagonOutput<double>*>(nullptr));
      StepLtd(ltd, {}, arrays.Of(i), 1e-3, ltds[i]);
    }
    ASSERT_TRUE(wagon_batch.Advance({}, 1e-3, 1, arrays.Loads(), arrays.Reply(), false));
    ASSERT_TRUE(ltd_batch.Advance({}, 1e-3, 1, arrays.Loads(), arrays.Reply(), false));
  }
  for (int i = 0; i < kVehicles; ++i) {
    const WagonState<double> s = wagon_batch.StateOf(i);
    EXPECT_EQ(wagons[i].velocity.x, s.velocity.x) << i;
    EXPECT_EQ(wagons[i].work.traction, s.work.traction) << i;
    EXPECT_EQ(ltds[i].v_mps, ltd_batch.StateOf(i).v_mps) << i;
    EXPECT_EQ(ltds[i].work.traction, ltd_batch.StateOf(i).work.traction) << i;
    EXPECT_EQ(i > 0, s.work.traction > 0.0) << i;
    EXPECT_GT(s.work.dissipated[kDynamicBrake], 0.0) << i;
  }
}

TEST_P(LaneKernelsTest, MoveEachLtdVehicleAsTheScalarStepDoes) {
  TrackParams hills;
  hills.grades = {{0.0, -1.0}, {30.0, 0.7}, {60.0, -0.4}};
  for (const LtdIntegrator integrator : {LtdIntegrator::kLeapfrog, LtdIntegrator::kNewmark}) {
    const LtdVehicle vehicle(OreWagon(), true, integrator);
    std::vector<LtdState<double>> states(kVehicles);
    for (int i = 0; i < kVehicles; ++i) {
      states[i].origin_m = -10.5 * i;
      states[i].v_mps = 0.4 * i - 1.0;  // some stop, some run backwards
    }
    LtdBatch batch(vehicle, GetParam(), states);
    Arrays arrays;
    for (int exchange = 0; exchange < 500; ++exchange) {
      arrays.Set(exchange / 10);
      std::vector<LtdOutput<double>> outputs(states.size());
      for (int i = 0; i < kVehicles; ++i) {
        for (int step = 0; step < 3; ++step) StepLtd(vehicle, hills, arrays.Of(i), 1e-3, states[i], &outputs[i]);
      }
      ASSERT_TRUE(batch.Advance(hills, 1e-3, 3, arrays.Loads(), arrays.Reply(), true));
      for (int i = 0; i < kVehicles; ++i) {
        ASSERT_EQ(states[i].x_m, arrays.displacement_m[i]);
        ASSERT_EQ(states[i].v_mps, arrays.velocity_mps[i]);
        ASSERT_EQ(states[i].work.dissipated, batch.StateOf(i).work.dissipated);
        ASSERT_EQ(states[i].work.gravity, batch.StateOf(i).work.gravity);
        ASSERT_EQ(outputs[i].shoe_force_n, batch.OutputOf(i).shoe_force_n);
      }
      if (exchange % 100 == 0) ExpectRecords(batch, states, outputs);
    }
  }
}

TEST_P(LaneKernelsTest, ReportABatchWithAWagonThatIsNotSound) {
  const Wagon wagon(OreWagon());
  for (const int broken : {0, 6, 10}) {
    std::vector<WagonState<double>> states = Wagons(wagon);
    states[broken].velocity.z[kFrontBolster] = std::numeric_limits<double>::quiet_NaN();
    WagonBatch batch(wagon, GetParam(), states);
    Arrays arrays;
    EXPECT_FALSE(batch.Advance({}, 1e-3, 1, arrays.Loads(), arrays.Reply(), false)) << "wagon " << broken;
    for (int i = 0; i < kVehicles; ++i) EXPECT_EQ(i != broken, IsSound(batch.vehicle(), Track(), batch.StateOf(i)));
  }
}

TEST_P(LaneKernelsTest, TakeAStateThatIsSetAsOneTheyBeganWith) {
  const Wagon wagon(OreWagon());
  const std::vector<WagonState<double>> states = Wagons(wagon);
  WagonBatch began(wagon, GetParam(), states);
  WagonBatch set(wagon, GetParam(), std::vector<WagonState<double>>(kVehicles, states[3]));
  for (int i = 0; i < kVehicles; ++i) set.SetState(i, states[i]);
  Arrays arrays, others;
  arrays.Set(7);
  others.Set(7);
  ASSERT_TRUE(began.Advance({}, 1e-3, 20, arrays.Loads(), arrays.Reply(), false));
  ASSERT_TRUE(set.Advance({}, 1e-3, 20, others.Loads(), others.Reply(), false));
  EXPECT_EQ(arrays.displacement_m, others.displacement_m);
}

TEST_P(LaneKernelsTest, DigestPositionsAndVelocitiesOfEachBody) {
  const Wagon wagon(OreWagon());
  std::vector<WagonState<double>> states = Wagons(wagon);
  for (int i = 0; i < kVehicles; ++i) {
    for (int b = 0; b < kBodies; ++b) {  // all different
      states[i].position.x[b] = 100.0 * i + b;
      states[i].velocity.pitch[b] = -100.0 * i - b;
    }
  }
  std::vector<std::uint64_t> digests(kVehicles);
  WagonBatch(wagon, GetParam(), states).Digests(digests.data());
  for (int i = 0; i < kVehicles; ++i) {
    Digest digest;
    for (const BodyVector<double>* motion : {&states[i].position, &states[i].velocity}) {
      for (int b = 0; b < kBodies; ++b) {
        digest.Add(motion->x[b]);
        digest.Add(motion->z[b]);
        digest.Add(motion->pitch[b]);
      }
    }
    EXPECT_EQ(digests[i], digest.value()) << "wagon " << i;
  }

  LtdState<double> state;
  state.x_m = 3.0;
  state.v_mps = 4.0;
  Digest digest;
  digest.Add(3.0);
  digest.Add(4.0);
  std::uint64_t of_ltd = 0;
  LtdBatch(LtdVehicle(OreWagon(), true), GetParam(), {state}).Digests(&of_ltd);
  EXPECT_EQ(of_ltd, digest.value());
}

TEST(BestLaneKernels, AreNoWiderThanTheVehiclesFill) {
  const std::vector<LaneKernels>& all = AllLaneKernels();
  for (int vehicles = 1; vehicles <= 20; ++vehicles) {
    const int lanes = BestLaneKernels(vehicles).lanes;
    EXPECT_GE(lanes, std::min(vehicles, all.front().lanes)) << vehicles;
    for (const LaneKernels& other : all) {
      EXPECT_TRUE(other.lanes >= lanes || other.lanes < vehicles) << vehicles;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, LaneKernelsTest, testing::ValuesIn(AllLaneKernels()),
                         [](const auto& kernels) { return std::string(kernels.param.instruction_set); });

}  // namespace
}  // namespace train_dynamics
