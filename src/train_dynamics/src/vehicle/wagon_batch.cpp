#include "train_dynamics/vehicle/wagon_batch.h"

#include <cstring>
#include <limits>

#include "kernels/wagon_kernel.h"

namespace train_dynamics {
namespace {

constexpr int kDouble = sizeof(double);

template <class Struct>
constexpr int Fields() {
  return sizeof(Struct) / kDouble;
}

/// What a wagon shows before its first step.
WagonOutput<double> NotComputed() {
  WagonOutput<double> output;
  for (auto* quantity : {&output.normal_force_n, &output.creepage, &output.creep_force_n,
                         &output.shoe_force_n, &output.wedge_friction_n}) {
    quantity->fill(std::numeric_limits<double>::quiet_NaN());
  }
  return output;
}

}  // namespace

const std::vector<WagonKernel>& WagonKernels() {
  static const std::vector<WagonKernel> kernels = [] {
    std::vector<WagonKernel> usable;
#if defined(TRAIN_BRAKE_X86_KERNELS)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl")) {
      usable.push_back(kAvx512WagonKernel);
    }
    if (__builtin_cpu_supports("avx2")) usable.push_back(kAvx2WagonKernel);
#endif
    usable.push_back(kBaseWagonKernel);
    usable.push_back(kScalarWagonKernel);
    return usable;
  }();
  return kernels;
}

template <class Struct>
Struct WagonBatch::Unpack(const Bytes& packed, int i) const {
  Struct value;
  auto* to = reinterpret_cast<std::byte*>(&value);
  for (int field = 0; field < Fields<Struct>(); ++field) {
    std::memcpy(to + field * kDouble, &packed[Offset(Fields<Struct>(), field, i)], kDouble);
  }
  return value;
}

template <class Struct>
void WagonBatch::Pack(const Struct& value, int i, Bytes& packed) const {
  const auto* from = reinterpret_cast<const std::byte*>(&value);
  for (int field = 0; field < Fields<Struct>(); ++field) {
    std::memcpy(&packed[Offset(Fields<Struct>(), field, i)], from + field * kDouble, kDouble);
  }
}

WagonBatch::WagonBatch(const Wagon& wagon, const WagonKernel& kernel,
                       const std::vector<WagonState<double>>& states)
    : wagon_(wagon),
      kernel_(kernel),
      size_(static_cast<int>(states.size())),
      packs_((size_ + kernel.lanes - 1) / kernel.lanes) {
  const std::size_t places = static_cast<std::size_t>(packs_) * kernel.lanes;
  states_.resize(places * sizeof(WagonState<double>));
  loads_.resize(places * sizeof(VehicleLoads<double>));
  heads_.resize(places * sizeof(WagonHeads<double>));
  outputs_.resize(places * sizeof(WagonOutput<double>));
  for (int i = 0; i < packs_ * kernel.lanes; ++i) {
    const int source = i < size_ ? i : i / kernel.lanes * kernel.lanes;
    Pack(states[source], i, states_);
    Pack(VehicleLoads<double>{}, i, loads_);
    Pack(NotComputed(), i, outputs_);
  }
}

WagonState<double> WagonBatch::State(int i) const { return Unpack<WagonState<double>>(states_, i); }
WagonOutput<double> WagonBatch::Output(int i) const { return Unpack<WagonOutput<double>>(outputs_, i); }

void WagonBatch::SetLoads(int i, double front_coupler_n, double rear_coupler_n, double cylinder_pressure_pa) {
  constexpr int kFields = Fields<VehicleLoads<double>>();
  static_assert(offsetof(VehicleLoads<double>, front_coupler_n) == 0 * kDouble);
  static_assert(offsetof(VehicleLoads<double>, rear_coupler_n) == 1 * kDouble);
  static_assert(offsetof(VehicleLoads<double>, cylinder_pressure_pa) == 2 * kDouble);
  SetField(loads_, kFields, 0, i, front_coupler_n);
  SetField(loads_, kFields, 1, i, rear_coupler_n);
  SetField(loads_, kFields, 2, i, cylinder_pressure_pa);
}

void WagonBatch::Advance(const TrackParams& track, double dt, int steps, bool with_output) {
  const std::size_t lanes = kernel_.lanes;
  for (int pack = 0; pack < packs_; ++pack) {
    kernel_.step(wagon_, track, dt, steps, &loads_[pack * lanes * sizeof(VehicleLoads<double>)],
                 &states_[pack * lanes * sizeof(WagonState<double>)],
                 &heads_[pack * lanes * sizeof(WagonHeads<double>)],
                 with_output ? &outputs_[pack * lanes * sizeof(WagonOutput<double>)] : nullptr);
  }
}

}  // namespace train_dynamics
