#pragma once

#include <boost/align/aligned_allocator.hpp>
#include <cstddef>
#include <cstring>
#include <vector>

#include "train_dynamics/vehicle/wagon.h"

namespace train_dynamics {

/// What the train needs of a wagon after every exchange.
template <class T>
struct WagonHeads {
  T displacement_m{};  ///< of the coupler heads since the start, see CouplerHead
  T velocity_mps{};
  T sound{};  ///< 1, or 0 if not IsSound
};

/// A kernel steps `lanes` wagons of one type side by side, in the registers of one instruction set.
///
/// Loads, state, heads and output of a pack lie in memory as [field][lane] of doubles, the fields in the
/// order of VehicleLoads, WagonState, WagonHeads and WagonOutput; 64-byte aligned.
struct WagonKernel {
  const char* instruction_set;
  int lanes;
  /// Advances a pack by `steps` steps of dt. @param output  what the last step shows; may be null
  void (*step)(const Wagon& wagon, const TrackParams& track, double dt, int steps, const std::byte* loads,
               std::byte* state, std::byte* heads, std::byte* output);
};

/// The kernels that were built and that this machine can run, fastest first. All give the same bits.
const std::vector<WagonKernel>& WagonKernels();

/// Wagons of one type in packs of lanes. The last pack is filled up with copies of its first wagon; nobody
/// looks at them.
class WagonBatch {
 public:
  WagonBatch(const Wagon& wagon, const WagonKernel& kernel, const std::vector<WagonState<double>>& states);

  int size() const { return size_; }
  const Wagon& wagon() const { return wagon_; }

  /// What acts on wagon i in the next Advance.
  void SetLoads(int i, double front_coupler_n, double rear_coupler_n, double cylinder_pressure_pa);
  /// Advances all wagons by `steps` steps. @param with_output  keep what the last step shows
  void Advance(const TrackParams& track, double dt, int steps, bool with_output);

  WagonState<double> State(int i) const;
  WagonOutput<double> Output(int i) const;

  double HeadDisplacement(int i) const { return Field(heads_, kHeadFields, 0, i); }
  double HeadVelocity(int i) const { return Field(heads_, kHeadFields, 1, i); }
  bool IsSound(int i) const { return Field(heads_, kHeadFields, 2, i) == 1.0; }

 private:
  using Bytes = std::vector<std::byte, boost::alignment::aligned_allocator<std::byte, 64>>;

  static constexpr int kHeadFields = sizeof(WagonHeads<double>) / sizeof(double);

  /// Address of a field of wagon i in `packed` structs of `fields` fields.
  std::size_t Offset(int fields, int field, int i) const {
    const std::size_t pack = i / kernel_.lanes, lane = i % kernel_.lanes;
    return ((pack * fields + field) * kernel_.lanes + lane) * sizeof(double);
  }
  double Field(const Bytes& packed, int fields, int field, int i) const {
    double value;
    std::memcpy(&value, &packed[Offset(fields, field, i)], sizeof value);
    return value;
  }
  void SetField(Bytes& packed, int fields, int field, int i, double value) const {
    std::memcpy(&packed[Offset(fields, field, i)], &value, sizeof value);
  }
  template <class Struct>
  Struct Unpack(const Bytes& packed, int i) const;
  template <class Struct>
  void Pack(const Struct& value, int i, Bytes& packed) const;

  Wagon wagon_;
  WagonKernel kernel_;
  int size_;
  int packs_;
  Bytes states_, loads_, heads_, outputs_;
};

}  // namespace train_dynamics
