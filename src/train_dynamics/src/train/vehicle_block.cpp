#include "train_dynamics/train/vehicle_block.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <variant>

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
template <int kPerBogie>
WagonState<double, kPerBogie> StartState(const BogieVehicle<kPerBogie>& wagon, double origin_m,
                                         double speed_mps) {
  return StaticEquilibrium(wagon, origin_m, speed_mps);
}

VehicleEnergy EnergyOf(const LtdVehicle& vehicle, const TrackParams& /*track*/, const LtdState<double>& s) {
  return {KineticEnergy(vehicle, s), 0.0, s.work};
}
template <int kPerBogie>
VehicleEnergy EnergyOf(const BogieVehicle<kPerBogie>& wagon, const TrackParams& track,
                       const WagonState<double, kPerBogie>& s) {
  return {KineticEnergy(wagon, s), PotentialEnergy(wagon, track, s), s.work};
}

/// WagonDetail holds vehicles with two wheelsets per bogie; the scenario's rules refuse others.
template <class Vehicle>
void FillDetail(const VehicleBatch<Vehicle>& /*batch*/, int /*i*/, WagonDetail& /*detail*/) {}
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

std::string FaultOf(const LtdState<double>& s) { return Describe("speed", s.v_mps, "m/s"); }

/// Names the first body that is not where a body can be.
template <int kPerBogie>
std::string FaultOf(const WagonState<double, kPerBogie>& s) {
  for (int b = 0; b < kBodiesOf<kPerBogie>; ++b) {
    const auto describe = [b](const char* what, double value, const char* unit) {
      return std::string(kBodyNames[b]) + " " + Describe(what, value, unit);
    };
    const auto wrong = [](double value, double limit) { return !(std::abs(value) < limit); };
    if (wrong(s.velocity.x[b], absurd::kSpeed)) return describe("speed", s.velocity.x[b], "m/s");
    if (wrong(s.velocity.z[b], absurd::kSpeed)) return describe("vertical speed", s.velocity.z[b], "m/s");
    if (wrong(s.position.z[b], absurd::kMovement))
      return describe("vertical displacement", s.position.z[b], "m");
    if (b < kWheelset1 && wrong(s.position.pitch[b], absurd::kPitch))
      return describe("pitch", s.position.pitch[b], "rad");
    if (b >= kWheelset1 && wrong(s.velocity.pitch[b], absurd::kRotation)) {
      return describe("rotation", s.velocity.pitch[b], "rad/s");
    }
  }
  return "state";
}

// ---- what they have in common ---------------------------------------------------------------------------------

using AnyBatch = std::variant<VehicleBatch<LtdVehicle>, VehicleBatch<Wagon>, VehicleBatch<SixAxleVehicle>>;

/// Calls use(vehicle) with the model of a vehicle that a scenario asks for.
template <class Use>
auto WithModel(const ScenarioParams& scenario, const VehicleParams& params, const Use& use) {
  if (scenario.model == VehicleModel::kTwoD) return WithBogieVehicle(params, use);
  return use(LtdVehicle(params, scenario.model == VehicleModel::kLtd, scenario.integrator));
}

template <class Batch>
constexpr int NumbersOf() {
  return sizeof(typename Batch::State) / sizeof(double);
}

/// Numbers in the state of a vehicle of this model.
int StateNumbers(const ScenarioParams& scenario, const VehicleParams& params) {
  if (scenario.model != VehicleModel::kTwoD) return NumbersOf<VehicleBatch<LtdVehicle>>();
  return params.wheelsets_per_bogie == 3 ? NumbersOf<VehicleBatch<SixAxleVehicle>>()
                                         : NumbersOf<VehicleBatch<Wagon>>();
}

/// Vehicles in one batch for each run of equal ones.
class Block : public VehicleBlock {
 public:
  Block(const ScenarioParams& scenario, const Consist& consist, int first, int count)
      : track_(scenario.track), first_(first) {
    for (const VehicleParams& params : consist.vehicle_types) {
      numbers_ = std::max(numbers_, StateNumbers(scenario, params));
    }
    for (int i = first; i < first + count;) {
      const int type = consist.vehicle_type[i], begin = i;
      while (i < first + count && consist.vehicle_type[i] == type) ++i;
      const auto batch_of = [&](const auto& vehicle) -> AnyBatch {
        auto state = StartState(vehicle, 0.0, scenario.InitialSpeed());
        std::vector<decltype(state)> states;
        for (int k = begin; k < i; ++k) {
          state.origin_m = scenario.start_position_m + consist.centre_m[k];
          states.push_back(state);
        }
        return VehicleBatch<std::decay_t<decltype(vehicle)>>(vehicle, BestLaneKernels(), states);
      };
      runs_.push_back({begin, WithModel(scenario, consist.vehicle_types[type], batch_of)});
    }
  }

  bool Advance(const ExchangeRequest& request, int offset, ExchangeReply& reply) override {
    bool sound = true;
    for (Run& run : runs_) {
      const int at = offset + run.begin - first_;
      const VehicleArrays arrays = {&request.coupler_force_n[at], &request.coupler_force_n[at + 1],
                                    &request.cylinder_pressure_pa[at], &reply.head_displacement_m[at],
                                    &reply.head_velocity_mps[at]};
      sound &= std::visit(
          [&](auto& batch) {
            return batch.Advance(track_, request.dt_s, request.steps, arrays, request.record);
          },
          run.batch);
    }
    if (request.record) Report(offset, request.ledger, reply);
    return sound;
  }

  void Report(int offset, bool with_energy, ExchangeReply& reply) const override {
    for (const Run& run : runs_) {
      const std::size_t at = offset + run.begin - first_;
      std::visit(
          [&](const auto& batch) {
            batch.Record({&reply.head_displacement_m[at], &reply.head_velocity_mps[at], &reply.position_m[at],
                          &reply.speed_mps[at], &reply.shoe_force_n[at], &reply.wheel_force_n[at],
                          &reply.creepage[at]});
            batch.Digests(&reply.state_digest[at]);
            for (int i = 0; with_energy && i < batch.size(); ++i) {
              reply.energy[at + i] = EnergyOf(batch.vehicle(), track_, batch.StateOf(i));
            }
            for (WagonDetail& detail : reply.details) {
              const int i = detail.vehicle - run.begin;
              if (i >= 0 && i < batch.size()) FillDetail(batch, i, detail);
            }
          },
          run.batch);
    }
  }

  int NumbersPerVehicle() const override { return numbers_; }

  void Save(double* state) const override {
    ForEachVehicle(*this, [&](const auto& batch, int i, int /*vehicle*/) {
      const auto vehicle = batch.StateOf(i);
      std::fill_n(state, numbers_, 0.0);
      std::memcpy(state, &vehicle, sizeof vehicle);
      state += numbers_;
    });
  }

  void Restore(const double* state) override {
    ForEachVehicle(*this, [&](auto& batch, int i, int /*vehicle*/) {
      auto vehicle = batch.StateOf(i);
      std::memcpy(static_cast<void*>(&vehicle), state, sizeof vehicle);
      batch.SetState(i, vehicle);
      state += numbers_;
    });
  }

  VehicleFault FindFault() const override {
    VehicleFault fault;
    ForEachVehicle(*this, [&](const auto& batch, int i, int vehicle) {
      if (fault.vehicle >= 0) return;
      const auto state = batch.StateOf(i);
      if (!IsSound(state)) fault = {vehicle, FaultOf(state)};
    });
    return fault;
  }

 private:
  /// Vehicles of one type, one behind the other.
  struct Run {
    int begin;  ///< index of the first in the train
    AnyBatch batch;
  };

  /// Calls use(batch, index in it, index in the train) for all vehicles in order.
  template <class Self, class Use>
  static void ForEachVehicle(Self& self, const Use& use) {
    for (auto& run : self.runs_) {
      std::visit(
          [&](auto& batch) {
            for (int i = 0; i < batch.size(); ++i) use(batch, i, run.begin + i);
          },
          run.batch);
    }
  }

  TrackParams track_;
  int first_;
  int numbers_ = 0;  ///< of the vehicle of the train that has most
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
  return std::make_unique<Block>(scenario, consist, first, count);
}

}  // namespace train_dynamics
