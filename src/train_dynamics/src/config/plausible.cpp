#include "train_dynamics/config/plausible.h"

#include <cstring>
#include <limits>

namespace train_dynamics::config {
namespace {

constexpr double kAny = std::numeric_limits<double>::infinity();

struct Size {
  const char* ending;  ///< of the path: keys, or the last words of one
  double least, largest;
};

// The longest match counts: keys before units.
constexpr Size kSizes[] = {
    {"wheel_radius_m", 0.1, 2.0},
    {"wheel_lateral_radius_m", 0.01, 1e6},
    {"rail_lateral_radius_m", 0.01, 10.0},
    {"radius_m", 10.0, 1e7},
    {"cg_height_m", 0.05, 10.0},
    {"coupler_height_m", 0.05, 5.0},
    {"bolster_guide_height_m", 0.02, 5.0},
    {"half_bogie_spacing_m", 0.2, 40.0},
    {"half_wheelset_spacing_m", 0.1, 10.0},
    {"slack_m", 1e-4, 1.0},
    {"preload_travel_m", 1e-5, 0.5},
    {"travel_m", 1e-4, 2.0},
    {"rebound_clearance_m", 0.0, 1.0},
    {"offset_m", 0.0, 5.0},
    {"depth_m", 0.0, 10.0},
    {"friction_length_m", 0.0, 0.1},
    {"height_m", 0.0, 1e4},
    {"vehicle.length_m", 1.0, 200.0},
    {"length_m", 0.1, 1e6},
    {"_m", 0.0, 1e7},
    {"inner_diameter_mm", 3.0, 300.0},
    {"frontal_area_ft2", 5.0, 2000.0},
    {"piston_area_m2", 1e-3, 10.0},
    {"_reservoir_l", 1.0, 1e4},
    {"wedge_mass_kg", 0.05, 1000.0},
    {"rotating_mass_kg", 1.0, 1e5},
    {"carbody.mass_kg", 500.0, 1e6},
    {"vehicle.mass_kg", 500.0, 1e6},
    {"bogie_frame.mass_kg", 50.0, 5e4},
    {"wheelset.mass_kg", 50.0, 2e4},
    {"mass_kg", 10.0, 1e6},
    {"drive_inertia_kgm2", 0.1, 1e5},
    {"carbody.pitch_inertia_kgm2", 1e3, 1e8},
    {"wheelset.pitch_inertia_kgm2", 3.0, 1e4},
    {"_kgm2", 0.1, 1e8},
    {"_kpa", 0.5, 3000.0},
    {"youngs_modulus_pa", 1e9, 1e13},
    {"shear_modulus_pa", 1e9, 1e13},
    {"wave_speed_mps", 10.0, 2000.0},
    {"_mps", 0.0, 2000.0},
    {"_kmh", 0.0, 1000.0},
    {"constant_n_per_kn", 0.01, 100.0},
    {"_n_per_kn", 0.0, 100.0},
    {"_n_per_kn_kmh", 0.0, 1.0},
    {"_n_per_kn_kmh2", 0.0, 0.1},
    {"starting_effort_n", 1e3, 1e7},
    {"largest_effort_n", 1e3, 1e7},
    {"effort_n", 1.0, 1e7},
    {"strength_n", 1e4, 1e8},
    {"preload_n", 100.0, 1e6},
    {"_n", 0.0, 1e8},
    {"_n_per_s", 100.0, 1e8},
    {"outer_stiffness_n_per_m", 1e4, 1e8},
    {"inner_stiffness_n_per_m", 1e4, 1e8},
    {"spring_stiffness_n_per_m", 1e5, 1e9},
    {"stick_stiffness_n_per_m", 1e7, 1e11},
    {"_stiffness_n_per_m", 1e5, 1e11},
    {"stiffness_n_per_m", 1e5, 1e10},
    {"_n_per_m", 1e3, 1e11},
    {"_ns_per_m", 0.0, 1e9},
    {"shoe_load_per_pressure_n_per_pa", 1e-3, 100.0},
    {"leverage_ratio", 0.05, 100.0},
    {"rim_power_w", 1e3, 1e8},
    {"_w", 1.0, 1e8},
    {"fuel_energy_j_per_kg", 1e6, 1e9},
    {"friction_decay_s_per_m", 0.0, 100.0},
    {"_deg", 0.0, 90.0},
    {"_percent", 0.0, 100.0},
    {"_delay_s", 0.0, 1e4},
    {"_s", 0.0, 1e7},
};

bool EndsIn(const std::string& path, const std::string& ending) {
  if (path.size() < ending.size() || path.compare(path.size() - ending.size(), ending.size(), ending) != 0)
    return false;
  // Whole words: travel_m is the end of preload_travel_m, and length_m not that of wavelength_m.
  if (path.size() == ending.size() || ending[0] == '_') return true;
  const char before = path[path.size() - ending.size() - 1];
  return before == '_' || before == '.';
}

}  // namespace

Range PlausibleSize(const std::string& path) {
  const Size* longest = nullptr;
  for (const Size& size : kSizes) {
    if (EndsIn(path, size.ending) && (longest == nullptr || std::strlen(size.ending) > std::strlen(longest->ending)))
      longest = &size;
  }
  if (longest == nullptr) return {0.0, kAny, false, true};
  return {longest->least, longest->largest, false, false};
}

}  // namespace train_dynamics::config
