#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace train_sim {

/// Prints the tests of a scenario's pneumatic brake (brake/pneumatic/air_test.h), one table with the rule of each.
/// @param trials  of random service commands at each of 1, 2, 4 and 8 cells per vehicle, from which no valve may go
///                into emergency (brake/pneumatic/emergency_search.h); 0: none
/// @return kSuccess; kFailure if one fails
/// @throws strict_config::Error, std::invalid_argument if its brake is not pneumatic
int PrintAirTest(const std::string& scenario_file, const std::vector<std::string>& overrides, int trials,
                 std::uint32_t seed);

/// Prints the braked-weight percentage of a scenario's vehicles and how its train stops beside the model of ETCS:
///
///   1  one vehicle of the train's last group, alone, emergency from 100 and 120 km/h on level track: its stopping
///      distance s [m] and lambda [%] by UIC 544-1 [M]: s = 61300 / (lambda + 8.9) and 83634 / (lambda + 8.8)
///   2  the train, emergency from 100 km/h, beside ETCS's conversion model at that lambda (train/braked_weight.h)
///
/// @return kSuccess; kFailure if the train's stop differs by more than 10 %
int PrintBrakeWeight(const std::string& scenario_file, const std::vector<std::string>& overrides);

}  // namespace train_sim
