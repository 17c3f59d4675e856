#include "train_dynamics/coupler/side_buffers.h"

namespace train_dynamics {
namespace {

/// Mean of loading and unloading [N].
double Mean(const HysteresisParams& tables, double travel_m) {
  return 0.5 * (tables.loading.At(travel_m) + tables.unloading.At(travel_m));
}

bool IsWhole(const ForceCurveParams& curve) {
  return !curve.travel_m.empty() && curve.travel_m.size() == curve.force_n.size();
}
bool IsWhole(const HysteresisParams& tables) { return IsWhole(tables.loading) && IsWhole(tables.unloading); }

}  // namespace

bool SideBuffersParams::PretensionIsReached() const {
  if (!IsWhole(buffer.tables) || !IsWhole(draw_gear.tables)) return true;  // there are other errors
  return Mean(draw_gear.tables, draw_gear.tables.loading.travel_m.back()) >=
         2.0 * Mean(buffer.tables, pretension_travel_m);
}

SideBuffers::SideBuffers(const SideBuffersParams& params)
    : buffer(params.buffer.Device()),
      draw_gear(params.draw_gear.Device()),
      pretension_travel_m(params.pretension_travel_m),
      pretension_n(2.0 * Mean(params.buffer.tables, params.pretension_travel_m)) {
  double low_m = 0.0, high_m = params.draw_gear.tables.loading.travel_m.back();
  for (int i = 0; i < 60; ++i) {
    const double middle_m = 0.5 * (low_m + high_m);
    (Mean(params.draw_gear.tables, middle_m) < pretension_n ? low_m : high_m) = middle_m;
  }
  draw_travel_m = high_m;
}

}  // namespace train_dynamics
