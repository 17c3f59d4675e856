#include "train_results/slide_tables.h"

#include <fmt/format.h>

#include <string>

#include "train_results/plain_file.h"
#include "train_results/result_tables.h"

namespace train_results {

void WriteSlideTables(const std::filesystem::path& folder, const train_dynamics::SlideResults& results) {
  std::string table = SlideTable().Header();
  for (const train_dynamics::SlideEvent& slide : results.Slides()) {
    const char* separator = "";
    train_dynamics::ForEachSlideField(
        [&](const char*, const char*, double number) {
          table += fmt::format("{}{:.9g}", separator, number);
          separator = ",";
        },
        slide);
    table += '\n';
  }
  if (!results.Slides().empty()) WriteFile(folder / "slides.csv", table);

  const train_dynamics::TrackWork track = results.Track();
  table = TrackWearTable().Header();
  for (std::size_t i = 0; i < track.creep_j.size(); ++i) {
    const long from_m = track.from_m + static_cast<long>(i);
    table += fmt::format("{},{},{:.9g},{:.9g}\n", from_m, from_m + 1, track.creep_j[i], track.brake_j[i]);
  }
  if (!track.creep_j.empty()) WriteFile(folder / "track_wear.csv", table);
}

}  // namespace train_results
