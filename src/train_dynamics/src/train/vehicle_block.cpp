#include "train_dynamics/train/vehicle_block.h"

#include <cmath>
#include <cstring>

#include "train_dynamics/train/snapshot.h"
#include "train_dynamics/vehicle/vehicle_batch.h"

namespace train_dynamics {
namespace {

// ---- what the models do differently --------------------------------------------------------------------------

LtdState<double> StartState(const LtdVehicle& /*vehicle*/, double origin_m, double speed_mps) {
  LtdState<double> state;
  state.origin_m = origin_m;
  state.v_mps = speed_mps;
  return state;
}
WagonState<double> StartState(const Wagon& wagon, double origin_m, double speed_mps) {
  return StaticEquilibrium(wagon, origin_m, speed_mps);
}

VehicleEnergy EnergyOf(const LtdVehicle& vehicle, const Track& /*track*/, const LtdState<double>& s) {
  return {KineticEnergy(vehicle, s), 0.0, s.work};
}
VehicleEnergy EnergyOf(const Wagon& wagon, const Track& track, const WagonState<double>& s) {
  return {KineticEnergy(wagon, s), PotentialEnergy(wagon, track, s), s.work};
}

void FillDetail(const VehicleBatch<LtdVehicle>& /*batch*/, int /*i*/, WagonDetail& /*detail*/) {}
void FillDetail(const VehicleBatch<Wagon>& batch, int i, WagonDetail& detail) {
  const WagonState<double> s = batch.StateOf(i);
  detail.position = s.position;
  detail.velocity = s.velocity;
  detail.output = batch.OutputOf(i);
  detail.nest_compression_m = ElementsOf(batch.vehicle(), s.position).nest;
}

std::string Describe(const char* what, double value, const char* unit) {
  return std::string(what) + " is " + std::to_string(value) + " " + unit;
}

std::string FaultOf(const LtdVehicle& /*vehicle*/, const Track& /*track*/, const LtdState<double>& s) {
  return Describe("speed", s.v_mps, "m/s");
}

/// Names the first body that is not where a body can be.
std::string FaultOf(const Wagon& wagon, const Track& track, const WagonState<double>& s) {
  const OverRail<double> over = OverRailOf(wagon, track, s);
  for (int b = 0; b < kBodies; ++b) {
    const auto describe = [b](const char* what, double value, const char* unit) {
      return std::string(kBodyNames[b]) + " " + Describe(what, value, unit);
    };
    const auto wrong = [](double value, double limit) { return !(std::abs(value) < limit); };
    if (wrong(s.velocity.x[b], absurd::kSpeed)) return describe("speed", s.velocity.x[b], "m/s");
    if (wrong(s.velocity.z[b], absurd::kSpeed)) return describe("vertical speed", s.velocity.z[b], "m/s");
    if (wrong(over.z[b], absurd::kMovement))
      return describe("vertical displacement over the rail", over.z[b], "m");
    if (b < kWheelset1 && wrong(over.pitch[b], absurd::kPitch))
      return describe("pitch over the rail", over.pitch[b], "rad");
    if (b >= kWheelset1 && wrong(s.velocity.pitch[b], absurd::kRotation)) {
      return describe("rotation", s.velocity.pitch[b], "rad/s");
    }
  }
  return "state";
}

// ---- what they have in common ---------------------------------------------------------------------------------

/// Vehicles of one model, in one batch for each run of equal vehicles.
template <class Vehicle>
class Block : public VehicleBlock {
 public:
  /// @param make  a vehicle from its VehicleParams
  template <class Make>
  Block(const ScenarioParams& scenario, const Consist& consist, int first, int count, const Make& make)
      : track_(scenario.track), first_(first) {
    for (int i = first; i < first + count;) {
      const int type = consist.vehicle_type[i], begin = i;
      const Vehicle vehicle = make(consist.vehicle_types[type]);
      auto state = StartState(vehicle, 0.0, scenario.InitialSpeed());
      std::vector<typename VehicleBatch<Vehicle>::State> states;
      for (; i < first + count && consist.vehicle_type[i] == type; ++i) {
        state.origin_m = scenario.start_position_m + consist.centre_m[i];
        states.push_back(state);
      }
      runs_.push_back({begin, VehicleBatch<Vehicle>(vehicle, BestLaneKernels(), states)});
    }
  }

  bool Advance(const ExchangeRequest& request, int offset, ExchangeReply& reply) override {
    bool sound = true;
    for (Run& run : runs_) {
      const int at = offset + run.begin - first_;
      const VehicleArrays arrays = {&request.coupler_force_n[at], &request.coupler_force_n[at + 1],
                                    &request.cylinder_pressure_pa[at], &reply.head_displacement_m[at],
                                    &reply.head_velocity_mps[at]};
      sound &= run.batch.Advance(track_, request.dt_s, request.steps, arrays, request.record);
    }
    if (request.record) Report(offset, request.ledger, reply);
    return sound;
  }

  void Report(int offset, bool with_energy, ExchangeReply& reply) const override {
    for (const Run& run : runs_) {
      const std::size_t at = offset + run.begin - first_;
      run.batch.Record({&reply.head_displacement_m[at], &reply.head_velocity_mps[at], &reply.position_m[at],
                        &reply.speed_mps[at], &reply.shoe_force_n[at], &reply.wheel_force_n[at],
                        &reply.creepage[at]});
      run.batch.Digests(&reply.state_digest[at]);
      if (!with_energy) continue;
      for (int i = 0; i < run.batch.size(); ++i) {
        reply.energy[at + i] = EnergyOf(run.batch.vehicle(), track_, run.batch.StateOf(i));
      }
    }
    for (WagonDetail& detail : reply.details) {
      for (const Run& run : runs_) {
        const int i = detail.vehicle - run.begin;
        if (i >= 0 && i < run.batch.size()) FillDetail(run.batch, i, detail);
      }
    }
  }

  int NumbersPerVehicle() const override { return kNumbers; }

  void Save(double* state) const override {
    for (const Run& run : runs_) {
      for (int i = 0; i < run.batch.size(); ++i, state += kNumbers) {
        const State vehicle = run.batch.StateOf(i);
        std::memcpy(state, &vehicle, sizeof vehicle);
      }
    }
  }

  void Restore(const double* state) override {
    for (Run& run : runs_) {
      for (int i = 0; i < run.batch.size(); ++i, state += kNumbers) {
        State vehicle;
        std::memcpy(static_cast<void*>(&vehicle), state, sizeof vehicle);
        run.batch.SetState(i, vehicle);
      }
    }
  }

  VehicleFault FindFault() const override {
    for (const Run& run : runs_) {
      for (int i = 0; i < run.batch.size(); ++i) {
        const auto state = run.batch.StateOf(i);
        if (IsSound(run.batch.vehicle(), track_, state)) continue;
        return {run.begin + i, FaultOf(run.batch.vehicle(), track_, state)};
      }
    }
    return {};
  }

 private:
  using State = typename VehicleBatch<Vehicle>::State;
  static constexpr int kNumbers = sizeof(State) / sizeof(double);

  /// Vehicles of one type, one behind the other.
  struct Run {
    int begin;  ///< index of the first in the train
    VehicleBatch<Vehicle> batch;
  };

  Track track_;
  int first_;
  std::vector<Run> runs_;
};

}  // namespace

void CheckSnapshotSize(const std::vector<double>& snapshot, const VehicleBlock& block, int vehicles) {
  const std::size_t expected = static_cast<std::size_t>(vehicles) * block.NumbersPerVehicle();
  if (snapshot.size() == expected) return;
  throw SnapshotError("has " + std::to_string(snapshot.size()) + " numbers, but " + std::to_string(vehicles) +
                      " vehicle(s) of this model have " + std::to_string(expected));
}

std::unique_ptr<VehicleBlock> MakeVehicleBlock(const ScenarioParams& scenario, const Consist& consist,
                                               int first, int count) {
  if (scenario.model == VehicleModel::kTwoD) {
    return std::make_unique<Block<Wagon>>(scenario, consist, first, count,
                                          [](const VehicleParams& params) { return Wagon(params); });
  }
  const bool with_inertia = scenario.model == VehicleModel::kLtd;
  return std::make_unique<Block<LtdVehicle>>(
      scenario, consist, first, count,
      [&](const VehicleParams& params) { return LtdVehicle(params, with_inertia, scenario.integrator); });
}

}  // namespace train_dynamics
