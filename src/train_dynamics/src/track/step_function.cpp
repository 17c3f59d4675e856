#include "train_dynamics/track/step_function.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace train_dynamics {

StepFunction::StepFunction(const std::vector<StepValue>& steps, double without_steps) {
  std::vector<double> cuts;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (i > 0) cuts.push_back(steps[i].from_m);
    values_.push_back(steps[i].value);
  }
  if (steps.empty()) values_.push_back(without_steps);
  pieces_ = Pieces(std::move(cuts));
}

StepFunction::Held StepFunction::From(double position_m) const {
  const int piece = pieces_.NumberAt(position_m);
  return {pieces_[piece], values_[piece]};
}

double StepFunction::At(double position_m) const { return values_[pieces_.NumberAt(position_m)]; }

void StepFunction::At(int count, const double* position_m, double* value) const {
  for (int i = 0; i < count; ++i) value[i] = At(position_m[i]);
}

double StepFunction::SmallestOn(double from_m, double to_m) const {
  const auto [first, last] = std::minmax({pieces_.NumberAt(from_m), pieces_.NumberAt(to_m)});
  return *std::min_element(values_.begin() + first, values_.begin() + last + 1);
}

}  // namespace train_dynamics
