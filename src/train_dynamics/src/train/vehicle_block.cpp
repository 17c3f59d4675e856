#include "train_dynamics/train/vehicle_block.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <variant>

#include "train_dynamics/numeric/digest.h"
#include "train_dynamics/train/snapshot.h"
#include "train_dynamics/vehicle/batch_protection.h"
#include "train_dynamics/vehicle/batch_slip_control.h"
#include "train_dynamics/vehicle/slide_watch.h"
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
WagonState<double, kPerBogie> StartState(const BogieVehicle<kPerBogie>& wagon, double origin_m, double speed_mps) {
  return StaticEquilibrium(wagon, origin_m, speed_mps);
}

VehicleEnergy EnergyOf(double kinetic_j, double potential_j, const VehicleWork<double>& work) {
  VehicleEnergy energy;
  energy.kinetic_j = kinetic_j;
  energy.potential_j = potential_j;
  energy.gravity_work_j = work.gravity;
  energy.traction_work_j = work.traction;
  energy.dissipated_j = work.dissipated;
  return energy;
}

VehicleEnergy EnergyOf(const LtdVehicle& vehicle, const Track& /*track*/, const LtdState<double>& s) {
  return EnergyOf(KineticEnergy(vehicle, s), 0.0, s.work);
}
template <int kPerBogie>
VehicleEnergy EnergyOf(const BogieVehicle<kPerBogie>& wagon, const Track& track,
                       const WagonState<double, kPerBogie>& s) {
  return EnergyOf(KineticEnergy(wagon, s), PotentialEnergy(wagon, track, s), s.work);
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

void FillWheelsetWork(const VehicleBatch<LtdVehicle>& /*batch*/, double* /*work_j*/) {}
template <int kPerBogie>
void FillWheelsetWork(const VehicleBatch<BogieVehicle<kPerBogie>>& batch, double* work_j) {
  using Vehicle = BogieVehicle<kPerBogie>;
  for (int i = 0; i < batch.size(); ++i, work_j += 2 * kMostWheelsets) {
    for (int j = 0; j < Vehicle::kWheelsets; ++j) {
      work_j[j] = batch.NumberOf(i, Vehicle::kFirstCreep + j);
      work_j[kMostWheelsets + j] = batch.NumberOf(i, Vehicle::kFirstBrake + j);
    }
  }
}

std::string Describe(const char* what, double value, const char* unit) {
  return std::string(what) + " is " + std::to_string(value) + " " + unit;
}

std::string FaultOf(const LtdVehicle& /*vehicle*/, const Track& /*track*/, const LtdState<double>& s) {
  return Describe("speed", s.v_mps, "m/s");
}

/// Names the first body whose position or speed is not possible.
template <int kPerBogie>
std::string FaultOf(const BogieVehicle<kPerBogie>& wagon, const Track& track, const WagonState<double, kPerBogie>& s) {
  const OverRail<double, kPerBogie> over = OverRailOf(wagon, track, s);
  for (int b = 0; b < kBodiesOf<kPerBogie>; ++b) {
    const auto describe = [b](const char* what, double value, const char* unit) {
      return std::string(kBodyNames[b]) + " " + Describe(what, value, unit);
    };
    const auto wrong = [](double value, double limit) { return !(std::abs(value) < limit); };
    if (wrong(s.velocity.x[b], state_limits::kSpeed)) return describe("speed", s.velocity.x[b], "m/s");
    if (wrong(s.velocity.z[b], state_limits::kSpeed)) return describe("vertical speed", s.velocity.z[b], "m/s");
    if (wrong(over.z[b], state_limits::kMovement))
      return describe("vertical displacement over the rail", over.z[b], "m");
    if (b < kWheelset1 && wrong(over.pitch[b], state_limits::kPitch))
      return describe("pitch over the rail", over.pitch[b], "rad");
    if (b >= kWheelset1 && wrong(s.velocity.pitch[b], state_limits::kRotation)) {
      return describe("rotation", s.velocity.pitch[b], "rad/s");
    }
  }
  return "state";
}

// ---- what they have in common ---------------------------------------------------------------------------------

/// Equal vehicles, one behind the other.
template <class Vehicle>
class EqualVehicles : public VehicleBatch<Vehicle> {
 public:
  using VehicleType = Vehicle;
  using VehicleBatch<Vehicle>::VehicleBatch;

  /// As VehicleBatch::Advance, in the requested exchange.
  bool Advance(const Track& track, const ExchangeRequest& request, const LoadPlaces& loads, const ReplyPlaces& reply,
               bool with_output) {
    return VehicleBatch<Vehicle>::Advance(track, request.dt_s, request.steps, loads, reply, with_output);
  }
  void TellSlides(int /*first*/, bool /*ongoing*/, double /*time_s*/, std::vector<SlideEvent>& /*slides*/) {}
  void Save(int i, StateRow& row) const {
    const auto state = this->StateOf(i);
    row.resize(VehicleBatch<Vehicle>::kNumbers);
    std::memcpy(row.data(), &state, sizeof state);
  }
  /// Takes numbers from the front of a row. @return how many; 0: the row has too few
  std::size_t Restore(int i, const StateRow& row) {
    constexpr std::size_t kOwn = VehicleBatch<Vehicle>::kNumbers;
    if (row.size() < kOwn) return 0;
    auto state = this->StateOf(i);
    std::memcpy(static_cast<void*>(&state), row.data(), sizeof state);
    this->SetState(i, state);
    return kOwn;
  }
};

/// One step of equal vehicles, the last of an exchange with its output.
template <class Vehicle>
bool AdvanceStep(EqualVehicles<Vehicle>& vehicles, const Track& track, const ExchangeRequest& request, int step,
                 const LoadPlaces& loads, const ReplyPlaces& reply, bool with_output) {
  const bool shows = with_output && step + 1 == request.steps;
  return vehicles.VehicleBatch<Vehicle>::Advance(track, request.dt_s, 1, loads, reply, shows);
}

/// The number of a step from the start of the run.
long StepOfRun(const ExchangeRequest& request, int step) {
  return static_cast<long>(request.exchange) * request.steps + step;
}

/// Equal vehicles with wheel-slide protection.
template <class Vehicle>
class ProtectedVehicles : public EqualVehicles<Vehicle> {
  using Base = EqualVehicles<Vehicle>;
  using Protection = BatchProtection<Vehicle>;

 public:
  ProtectedVehicles(Base vehicles, double dt)
      : Base(std::move(vehicles)), protection_(*this->vehicle().params.wheel_slide_protection, dt, *this) {}

  bool Advance(const Track& track, const ExchangeRequest& request, LoadPlaces loads, const ReplyPlaces& reply,
               bool with_output) {
    bool sound = true;
    for (int step = 0; step < request.steps; ++step) {
      Control(StepOfRun(request, step), loads);
      sound &= AdvanceStep<Vehicle>(*this, track, request, step, loads, reply, with_output);
    }
    return sound;
  }
  /// Puts the cylinders' pressures over the step that comes among the loads.
  void Control(long step, LoadPlaces& loads) {
    loads.wheelset_pressure_pa = protection_.Step(step, *this, loads.cylinder_pressure_pa);
  }

  void Digests(std::uint64_t* digest) const {
    Base::Digests(digest);
    std::array<double, Protection::kNumbers> numbers;
    for (int i = 0; i < this->size(); ++i) {
      Digest with_protection;
      with_protection.Add(digest[i]);
      std::memcpy(numbers.data(), &protection_.StateOf(i), sizeof numbers);
      for (const double number : numbers) with_protection.Add(number);
      digest[i] = with_protection.value();
    }
  }

  static constexpr int kNumbers = Base::kNumbers + Protection::kNumbers;
  void Save(int i, StateRow& row) const {
    Base::Save(i, row);
    row.resize(kNumbers);
    std::memcpy(row.data() + Base::kNumbers, &protection_.StateOf(i), sizeof(typename Protection::State));
  }
  std::size_t Restore(int i, const StateRow& row) {
    if (row.size() < kNumbers || Base::Restore(i, row) == 0) return 0;
    typename Protection::State state;
    std::memcpy(static_cast<void*>(&state), row.data() + Base::kNumbers, sizeof state);
    protection_.SetState(i, state);
    return kNumbers;
  }

 private:
  Protection protection_;
};

/// Equal locomotives with slip control, with wheel-slide protection or without.
template <class Vehicles>
class SlipControlledVehicles : public Vehicles {
  using Vehicle = typename Vehicles::VehicleType;
  using SlipControl = BatchSlipControl<Vehicle>;

 public:
  template <class... Arguments>
  SlipControlledVehicles(double dt, Arguments&&... arguments)
      : Vehicles(std::forward<Arguments>(arguments)...),
        slip_control_(*this->vehicle().params.traction->slip_control, dt, *this) {}

  bool Advance(const Track& track, const ExchangeRequest& request, LoadPlaces loads, const ReplyPlaces& reply,
               bool with_output) {
    bool sound = true;
    for (int step = 0; step < request.steps; ++step) {
      const long of_run = StepOfRun(request, step);
      if constexpr (!std::is_same_v<Vehicles, EqualVehicles<Vehicle>>) Vehicles::Control(of_run, loads);
      loads.traction_share = slip_control_.Step(of_run, *this);
      sound &= AdvanceStep<Vehicle>(*this, track, request, step, loads, reply, with_output);
    }
    return sound;
  }

  void Digests(std::uint64_t* digest) const {
    Vehicles::Digests(digest);
    for (int i = 0; i < this->size(); ++i) {
      Digest with_control;
      with_control.Add(digest[i]);
      for (const double number : slip_control_.StateOf(i)) with_control.Add(number);
      digest[i] = with_control.value();
    }
  }

  static constexpr int kNumbers = Vehicles::kNumbers + SlipControl::kNumbers;
  void Save(int i, StateRow& row) const {
    Vehicles::Save(i, row);
    const auto& state = slip_control_.StateOf(i);
    row.insert(row.end(), state.begin(), state.end());
  }
  std::size_t Restore(int i, const StateRow& row) {
    if (row.size() < kNumbers || Vehicles::Restore(i, row) == 0) return 0;
    typename SlipControl::State state;
    std::copy_n(row.begin() + Vehicles::kNumbers, state.size(), state.begin());
    slip_control_.SetState(i, state);
    return kNumbers;
  }

 private:
  SlipControl slip_control_;
};

/// Equal vehicles of the 2D model, whose slides are followed.
template <class Vehicles>
class WatchedVehicles : public Vehicles {
  using Watch = SlideWatch<typename Vehicles::VehicleType>;

 public:
  template <class... Arguments>
  explicit WatchedVehicles(Arguments&&... arguments)
      : Vehicles(std::forward<Arguments>(arguments)...), watch_(this->size()) {}

  bool Advance(const Track& track, const ExchangeRequest& request, const LoadPlaces& loads, const ReplyPlaces& reply,
               bool with_output) {
    const bool sound = Vehicles::Advance(track, request, loads, reply, with_output || watch_.watching());
    const double interval_s = request.steps * request.dt_s;
    watch_.Follow(interval_s * static_cast<double>(request.exchange + 1), interval_s, *this);
    return sound;
  }
  void TellSlides(int first, bool ongoing, double time_s, std::vector<SlideEvent>& slides) {
    watch_.Tell(first, ongoing, time_s, *this, slides);
  }

  static constexpr int kNumbers = Vehicles::kNumbers + Watch::kSharedNumbers();
  void Save(int i, StateRow& row) const {
    Vehicles::Save(i, row);
    watch_.Save(i, row);
  }
  std::size_t Restore(int i, const StateRow& row) {
    const std::size_t own = Vehicles::Restore(i, row);
    if (own == 0 || !watch_.Restore(i, row.data() + own, row.size() - own)) return 0;
    return row.size();
  }

 private:
  Watch watch_;
};

/// A model over lanes is one more alternative here.
using Batch = std::variant<WatchedVehicles<EqualVehicles<Wagon>>, WatchedVehicles<EqualVehicles<SixAxleVehicle>>,
                           EqualVehicles<LtdVehicle>, WatchedVehicles<ProtectedVehicles<Wagon>>,
                           WatchedVehicles<ProtectedVehicles<SixAxleVehicle>>,
                           WatchedVehicles<SlipControlledVehicles<EqualVehicles<Wagon>>>,
                           WatchedVehicles<SlipControlledVehicles<EqualVehicles<SixAxleVehicle>>>,
                           WatchedVehicles<SlipControlledVehicles<ProtectedVehicles<Wagon>>>,
                           WatchedVehicles<SlipControlledVehicles<ProtectedVehicles<SixAxleVehicle>>>>;

/// @param centre_m  of each vehicle, at the start
template <class Vehicle>
EqualVehicles<Vehicle> MakeBatch(const Vehicle& vehicle, double speed_mps, const std::vector<double>& centre_m) {
  auto state = StartState(vehicle, 0.0, speed_mps);
  std::vector<typename VehicleBatch<Vehicle>::State> states;
  for (const double at : centre_m) {
    state.origin_m = at;
    states.push_back(state);
  }
  return EqualVehicles<Vehicle>(vehicle, BestLaneKernels(static_cast<int>(states.size())), states);
}

Batch MakeBatch(VehicleModel model, const VehicleParams& params, const ScenarioParams& scenario, double speed_mps,
                const std::vector<double>& centre_m) {
  if (model == VehicleModel::kTwoD) {
    return WithBogieVehicle(params, [&](const auto& vehicle) -> Batch {
      auto vehicles = MakeBatch(vehicle, speed_mps, centre_m);
      using Vehicle = std::decay_t<decltype(vehicle)>;
      using Protected = ProtectedVehicles<Vehicle>;
      const double dt = scenario.dt_s;
      const bool has_slip_control = params.traction && params.traction->slip_control;
      if (has_slip_control && params.wheel_slide_protection)
        return WatchedVehicles<SlipControlledVehicles<Protected>>(dt, std::move(vehicles), dt);
      if (has_slip_control)
        return WatchedVehicles<SlipControlledVehicles<EqualVehicles<Vehicle>>>(dt, std::move(vehicles));
      if (params.wheel_slide_protection) return WatchedVehicles<Protected>(std::move(vehicles), dt);
      return WatchedVehicles<EqualVehicles<Vehicle>>(std::move(vehicles));
    });
  }
  const bool with_inertia = model == VehicleModel::kLtd;
  return MakeBatch(LtdVehicle(params, with_inertia, scenario.integrator, scenario.adhesion_limit), speed_mps, centre_m);
}

/// Vehicles of this program's own models, in one batch for each run of equal vehicles.
class BatchedBlock : public VehicleBlock {
 public:
  BatchedBlock(const ScenarioParams& scenario, const Consist& consist, int first, int count)
      : track_(scenario.track), first_(first) {
    for (int i = first; i < first + count;) {
      const int group = consist.vehicle_type[i], begin = i;
      const VehicleModel model = scenario.ModelOfGroup(group);
      std::vector<double> centre_m;
      for (; i < first + count && consist.vehicle_type[i] == group; ++i) {
        centre_m.push_back(scenario.start_position_m + consist.centre_m[i]);
      }
      if (!scenario.train.consist[group].external.empty()) continue;
      runs_.push_back(
          {begin, model,
           MakeBatch(model, consist.vehicle_types[group], scenario, scenario.InitialSpeedOfGroup(group), centre_m)});
    }
  }

  bool Advance(const ExchangeRequest& request, int offset, ExchangeReply& reply) override {
    if (request.friction_patches.size() != patches_) TakePatches(request.friction_patches);
    bool sound = true;
    for (Run& run : runs_) {
      const std::size_t at = offset + run.begin - first_;
      sound &= std::visit(
          [&](auto& batch) {
            return batch.Advance(track_, request, PlacesOfThoseThatAct(request, at, batch.size()),
                                 PlacesOf(static_cast<ReplyArrays&>(reply), at), request.record);
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
            batch.Record(PlacesOf(static_cast<ReplyArrays&>(reply), at),
                         PlacesOf(static_cast<RecordArrays&>(reply), at));
            batch.Digests(&reply.state_digest[at]);
            FillWheelsetWork(batch, &reply.wheelset_work_j[at * 2 * kMostWheelsets]);
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

  void TellSlides(bool ongoing, double time_s, std::vector<SlideEvent>& slides) override {
    for (Run& run : runs_) {
      std::visit([&](auto& batch) { batch.TellSlides(run.begin + 1, ongoing, time_s, slides); }, run.batch);
    }
  }

  void Save(StateRow* rows) const override {
    for (const Run& run : runs_) {
      std::visit(
          [&](const auto& batch) {
            for (int i = 0; i < batch.size(); ++i) batch.Save(i, rows[run.begin - first_ + i]);
          },
          run.batch);
    }
  }

  void Restore(const StateRow* rows) override {
    for (Run& run : runs_) {
      std::visit(
          [&](auto& batch) {
            for (int i = 0; i < batch.size(); ++i) {
              const StateRow& row = rows[run.begin - first_ + i];
              if (batch.Restore(i, row) == row.size() && !row.empty()) continue;
              throw SnapshotError("has " + std::to_string(row.size()) + " numbers of vehicle " +
                                  std::to_string(run.begin + i + 1) + ", but one of the " + ModelName(run.model) +
                                  " model has, with its equipment, others");
            }
          },
          run.batch);
    }
  }

  VehicleFault FindFault() const override {
    for (const Run& run : runs_) {
      const VehicleFault fault = std::visit(
          [&run, this](const auto& batch) {
            for (int i = 0; i < batch.size(); ++i) {
              const auto state = batch.StateOf(i);
              if (IsSound(batch.vehicle(), track_, state)) continue;
              return VehicleFault{run.begin + i, FaultOf(batch.vehicle(), track_, state)};
            }
            return VehicleFault();
          },
          run.batch);
      if (fault.vehicle >= 0) return fault;
    }
    return {};
  }

 private:
  /// The new ones.
  void TakePatches(const std::vector<FrictionPatchParams>& patches) {
    track_.AddPatches({patches.begin() + static_cast<std::ptrdiff_t>(patches_), patches.end()});
    patches_ = patches.size();
  }

  /// Vehicles of one group, one behind the other.
  struct Run {
    int begin;  ///< index of the first in the train
    VehicleModel model;
    Batch batch;
  };

  Track track_;
  std::size_t patches_ = 0;  ///< that were given to the running train
  int first_;
  std::vector<Run> runs_;
};

template <class... Batches>
constexpr int MostNumbers(const std::variant<Batches...>*) {
  return std::max({Batches::kNumbers...});
}

}  // namespace

int MostStateNumbers() { return MostNumbers(static_cast<const Batch*>(nullptr)); }

std::unique_ptr<VehicleBlock> MakeVehicleBlock(const ScenarioParams& scenario, const Consist& consist, int first,
                                               int count) {
  return std::make_unique<BatchedBlock>(scenario, consist, first, count);
}

}  // namespace train_dynamics
