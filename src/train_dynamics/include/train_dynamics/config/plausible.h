#pragma once

#include <string>

#include "train_dynamics/parameters.h"

namespace train_dynamics::config {

/// The sizes that a quantity of a real train or track can have, by its key in a configuration (and by the enclosing
/// part where one key has several meanings), or else by its unit. Wide enough for anything that runs on rails, and
/// narrow enough to show a value in another unit (430000 kPa, 920 N/kN, a wheel of 460 m). Zero, where a key's own
/// range allows it, means that the element is absent and is not judged.
///
/// @param path  "train.consist[0].vehicle.carbody.mass_kg", or less of it
/// @return the interval of the value's size; unbounded where nothing is known. Source [A]: about 30 times beyond what
///   is built.
Range PlausibleSize(const std::string& path);

}  // namespace train_dynamics::config
