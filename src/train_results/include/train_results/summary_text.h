#pragma once

#include <stdexcept>
#include <string>

namespace train_results {

/// A text that is not the contents of a summary.json.
struct NoSummary : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// What a person wants to know of a run first, as lines: where it came to, largest forces, and what happened that
/// should not (couplings that broke, slides, an early end).
///
/// @param summary_json  the contents of a summary.json; what an older one does not have is left out
/// @throws NoSummary
std::string SummaryText(const std::string& summary_json);

}  // namespace train_results
