#include "train_dynamics/train/curving_loads.h"

#include <algorithm>
#include <utility>

#include "train_dynamics/resistance/curving.h"

namespace train_dynamics {

CurvingLoads::CurvingLoads(const TrackParams& track, const Consist& consist, double start_position_m)
    : type_(consist.vehicle_type) {
  const std::vector<StepValue> curvatures = track.Curvatures();
  if (curvatures.empty()) return;
  std::vector<double> cuts;
  cuts.reserve(curvatures.size());
  for (const StepValue& step : curvatures) cuts.push_back(step.from_m);
  pieces_ = Pieces(cuts);
  for (const VehicleParams& vehicle : consist.vehicle_types) {
    const auto force_in = [&vehicle](double curvature_per_m) {
      return 1e-3 * vehicle.TotalMass() * CurvingResistance(vehicle.curving_resistance, curvature_per_m);
    };
    std::vector<double> force_n = {force_in(curvatures.front().value)};  // the first also holds before it
    for (const StepValue& step : curvatures) force_n.push_back(force_in(step.value));
    types_.push_back(std::move(force_n));
  }
  for (const double centre_m : consist.centre_m) start_m_.push_back(start_position_m + centre_m);
}

void CurvingLoads::Evaluate(double interval_s, const std::vector<double>& head_displacement_m,
                            const std::vector<double>& head_velocity_mps, LoadArrays& loads) const {
  if (empty()) return;
  loads.curving_resistance_n.resize(type_.size());
  for (std::size_t i = 0; i < type_.size(); ++i) {
    const double from_m = start_m_[i] + head_displacement_m[i];
    loads.curving_resistance_n[i] = Mean(types_[type_[i]], from_m, from_m + interval_s * head_velocity_mps[i]);
  }
}

double CurvingLoads::Mean(const std::vector<double>& force_n, double from_m, double to_m) const {
  const int at = pieces_.NumberAt(from_m), then = pieces_.NumberAt(to_m);
  if (at == then) return force_n[at];
  const double low_m = std::min(from_m, to_m), high_m = std::max(from_m, to_m);
  double work = 0.0;
  for (int i = std::min(at, then); i <= std::max(at, then); ++i) {
    const Stretch piece = pieces_[i];
    work += force_n[i] * (std::min(high_m, piece.to_m) - std::max(low_m, piece.from_m));
  }
  return work / (high_m - low_m);
}

}  // namespace train_dynamics
