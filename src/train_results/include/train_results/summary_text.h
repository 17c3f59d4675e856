#pragma once

#include <stdexcept>
#include <string>

namespace train_results {

/// A text that is not the contents of a summary.json.
struct NoSummary : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// The main results of a run as lines of text: its end, largest forces, and irregular events (broken couplings, slides,
/// an early end).
///
/// @param summary_json  the contents of a summary.json; values that an older one lacks are left out
/// @throws NoSummary
std::string SummaryText(const std::string& summary_json);

}  // namespace train_results
