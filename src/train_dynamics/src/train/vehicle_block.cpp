#include "train_dynamics/train/vehicle_block.h"

#include <cmath>
#include <limits>

#include "train_dynamics/vehicle/wagon_batch.h"

namespace train_dynamics {
namespace {

std::string Describe(const char* what, double value, const char* unit) {
  return std::string(what) + " is " + std::to_string(value) + " " + unit;
}

/// Vehicles of conventional longitudinal train dynamics.
class LtdBlock : public VehicleBlock {
 public:
  LtdBlock(const ScenarioParams& scenario, const Consist& consist, int first, int count)
      : track_(scenario.track), integrator_(scenario.integrator), first_(first) {
    for (const VehicleParams& type : consist.vehicle_types) {
      types_.emplace_back(type, scenario.model == VehicleModel::kLtd);
    }
    for (int i = first; i < first + count; ++i) {
      type_.push_back(consist.vehicle_type[i]);
      LtdState<double> state;
      state.origin_m = scenario.start_position_m + consist.centre_m[i];
      state.v_mps = scenario.InitialSpeed();
      states_.push_back(state);
    }
    outputs_.resize(count);
  }

  bool Advance(const ExchangeRequest& request, int offset, ExchangeReply& reply) override {
    bool sound = true;
    for (size_t i = 0; i < states_.size(); ++i) {
      const LtdVehicle& type = types_[type_[i]];
      VehicleLoads<double> loads;
      loads.front_coupler_n = request.coupler_force_n[offset + i];
      loads.rear_coupler_n = request.coupler_force_n[offset + i + 1];
      loads.cylinder_pressure_pa = request.cylinder_pressure_pa[offset + i];
      LtdState<double>& s = states_[i];
      for (int step = 0; step < request.steps; ++step) {
        StepLtd(type, track_, integrator_, loads, request.dt_s, s, &outputs_[i]);
      }
      reply.head_displacement_m[offset + i] = s.x_m;
      reply.head_velocity_mps[offset + i] = s.v_mps;
      sound = sound & IsSound(s);
    }
    if (request.record) Report(offset, request.ledger, reply);
    return sound;
  }

  void Report(int offset, bool with_energy, ExchangeReply& reply) const override {
    for (size_t i = 0; i < states_.size(); ++i) {
      const LtdState<double>& s = states_[i];
      const size_t at = offset + i;
      reply.head_displacement_m[at] = s.x_m;
      reply.head_velocity_mps[at] = s.v_mps;
      reply.position_m[at] = s.origin_m + s.x_m;
      reply.speed_mps[at] = s.v_mps;
      reply.shoe_force_n[at] = outputs_[i].shoe_force_n;
      reply.wheel_force_n[at] = reply.creepage[at] = std::numeric_limits<double>::quiet_NaN();
      Digest digest;
      digest.Add(s.x_m);
      digest.Add(s.v_mps);
      reply.state_digest[at] = digest.value();
      if (with_energy) reply.energy[at] = {KineticEnergy(types_[type_[i]], s), 0.0, s.work};
    }
  }

  VehicleFault FindFault() const override {
    for (size_t i = 0; i < states_.size(); ++i) {
      if (!IsSound(states_[i]))
        return {first_ + static_cast<int>(i), Describe("speed", states_[i].v_mps, "m/s")};
    }
    return {};
  }

 private:
  static bool IsSound(const LtdState<double>& s) { return std::abs(s.v_mps) < absurd::kSpeed; }

  TrackParams track_;
  LtdIntegrator integrator_;
  int first_;
  std::vector<LtdVehicle> types_;
  std::vector<int> type_;
  std::vector<LtdState<double>> states_;
  std::vector<LtdOutput<double>> outputs_;
};

/// Wagons of the 2D train, in one batch for each run of equal vehicles.
class WagonBlock : public VehicleBlock {
 public:
  WagonBlock(const ScenarioParams& scenario, const Consist& consist, int first, int count)
      : track_(scenario.track), first_(first) {
    const WagonKernel& kernel = WagonKernels().front();
    for (int i = first; i < first + count;) {
      const int type = consist.vehicle_type[i], begin = i;
      const Wagon wagon(consist.vehicle_types[type]);
      WagonState<double> state = StaticEquilibrium(wagon, 0.0, scenario.InitialSpeed());
      std::vector<WagonState<double>> states;
      for (; i < first + count && consist.vehicle_type[i] == type; ++i) {
        state.origin_m = scenario.start_position_m + consist.centre_m[i];
        states.push_back(state);
      }
      batches_.push_back({begin, WagonBatch(wagon, kernel, states)});
    }
  }

  bool Advance(const ExchangeRequest& request, int offset, ExchangeReply& reply) override {
    bool sound = true;
    for (Run& run : batches_) {
      const int at = offset + run.begin - first_;
      for (int i = 0; i < run.batch.size(); ++i) {
        run.batch.SetLoads(i, request.coupler_force_n[at + i], request.coupler_force_n[at + i + 1],
                           request.cylinder_pressure_pa[at + i]);
      }
      run.batch.Advance(track_, request.dt_s, request.steps, request.record);
      for (int i = 0; i < run.batch.size(); ++i) {
        reply.head_displacement_m[at + i] = run.batch.HeadDisplacement(i);
        reply.head_velocity_mps[at + i] = run.batch.HeadVelocity(i);
        sound = sound & run.batch.IsSound(i);
      }
    }
    if (request.record) Report(offset, request.ledger, reply);
    return sound;
  }

  void Report(int offset, bool with_energy, ExchangeReply& reply) const override {
    for (const Run& run : batches_) {
      for (int i = 0; i < run.batch.size(); ++i) {
        ReportOne(run.batch.wagon(), run.batch.State(i), run.batch.Output(i), offset + run.begin - first_ + i,
                  with_energy, reply);
      }
    }
    for (WagonDetail& detail : reply.details) {
      for (const Run& run : batches_) {
        const int i = detail.vehicle - run.begin;
        if (i < 0 || i >= run.batch.size()) continue;
        const WagonState<double> s = run.batch.State(i);
        detail.position = s.position;
        detail.velocity = s.velocity;
        detail.output = run.batch.Output(i);
        detail.nest_compression_m = ElementsOf(run.batch.wagon(), s.position).nest;
      }
    }
  }

  VehicleFault FindFault() const override {
    for (const Run& run : batches_) {
      for (int i = 0; i < run.batch.size(); ++i) {
        const WagonState<double> s = run.batch.State(i);
        if (!IsSound(s)) return {run.begin + i, FaultOf(s)};
      }
    }
    return {};
  }

 private:
  /// Vehicles of one type, one behind the other.
  struct Run {
    int begin;  ///< index of the first in the train
    WagonBatch batch;
  };

  void ReportOne(const Wagon& type, const WagonState<double>& s, const WagonOutput<double>& out, size_t at,
                 bool with_energy, ExchangeReply& reply) const {
    reply.head_displacement_m[at] = CouplerHead(type, s.position);
    reply.head_velocity_mps[at] = CouplerHead(type, s.velocity);
    reply.position_m[at] = s.origin_m + s.position.x[kCarbody];
    reply.speed_mps[at] = s.velocity.x[kCarbody];
    double shoes = 0.0, wheels = 0.0, creepage = 0.0;
    for (int wheelset = 0; wheelset < kWheelsets; ++wheelset) {
      shoes += out.shoe_force_n[wheelset];
      wheels += out.creep_force_n[wheelset];
      if (!(std::abs(out.creepage[wheelset]) <= std::abs(creepage))) creepage = out.creepage[wheelset];
    }
    reply.shoe_force_n[at] = shoes;
    reply.wheel_force_n[at] = wheels;
    reply.creepage[at] = creepage;
    reply.state_digest[at] = DigestOf(s);
    if (with_energy) reply.energy[at] = {KineticEnergy(type, s), PotentialEnergy(type, track_, s), s.work};
  }

  /// Names the first body that is not where a body can be.
  static std::string FaultOf(const WagonState<double>& s) {
    for (int b = 0; b < kBodies; ++b) {
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

  static std::uint64_t DigestOf(const WagonState<double>& s) {
    Digest digest;
    for (const BodyVector<double>* motion : {&s.position, &s.velocity}) {
      for (int b = 0; b < kBodies; ++b) {
        digest.Add(motion->x[b]);
        digest.Add(motion->z[b]);
        digest.Add(motion->pitch[b]);
      }
    }
    return digest.value();
  }

  TrackParams track_;
  int first_;
  std::vector<Run> batches_;
};

}  // namespace

std::unique_ptr<VehicleBlock> MakeVehicleBlock(const ScenarioParams& scenario, const Consist& consist,
                                               int first, int count) {
  if (scenario.model == VehicleModel::kTwoD)
    return std::make_unique<WagonBlock>(scenario, consist, first, count);
  return std::make_unique<LtdBlock>(scenario, consist, first, count);
}

}  // namespace train_dynamics
