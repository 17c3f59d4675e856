#include "train_dynamics/brake/shoe_friction.h"

namespace train_dynamics {

void LookUpShoeFriction(const ShoeFrictionTableParams& table, int count, const double* speed_kmh,
                        const double* shoe_load_kn, double* friction_coefficient) {
  for (int lane = 0; lane < count; ++lane) {
    const auto at = [&](std::size_t curve) {
      return InterpolateLinearly(table.speed_kmh, table.curves[curve].friction_coefficient, speed_kmh[lane]);
    };
    const double load_kn = shoe_load_kn[lane];
    std::size_t above = 0;
    while (above < table.curves.size() && table.curves[above].shoe_load_kn <= load_kn) ++above;
    if (above == 0 || above == table.curves.size()) {
      friction_coefficient[lane] = at(above == 0 ? 0 : above - 1);
      continue;
    }
    const double low_kn = table.curves[above - 1].shoe_load_kn, high_kn = table.curves[above].shoe_load_kn;
    const double low = at(above - 1);
    friction_coefficient[lane] = low + (at(above) - low) * ((load_kn - low_kn) / (high_kn - low_kn));
  }
}

}  // namespace train_dynamics
