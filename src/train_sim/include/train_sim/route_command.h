#pragma once

#include <string>
#include <vector>

namespace train_sim {

struct RouteOptions {
  std::string file;                    ///< a track (YAML or CSV) or a scenario that has one
  std::vector<std::string> overrides;  ///< "path=value", as given to --set
  std::string plot;                    ///< SVG file to draw it in; empty: none
  std::string csv;                     ///< file to write it to as a table of points; empty: none
};

/// Checks a route, describes it, draws it and writes it as a table. An allowed but implausible entry (a grade that no
/// railway has, a curve that is shorter than a vehicle) is a warning.
/// @throws strict_config::Error
int ShowRoute(const RouteOptions& options);

}  // namespace train_sim
