#include "train_results/summary_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace train_results {
namespace {

using Json = nlohmann::json;

/// Whether there is something under this key.
bool Has(const Json& json, const char* key) { return json.contains(key) && !json.at(key).is_null(); }

bool Holds(const Json& json, const char* key) { return Has(json, key) && json.at(key).get<bool>(); }

double Number(const Json& json, const char* key) { return json.at(key).get<double>(); }

std::string Count(std::size_t number, const char* what) {
  return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
}

std::string Place(const Json& of_connection) {
  return fmt::format("connection {} at {:.1f} s", of_connection.at("connection").get<int>(),
                     Number(of_connection, "time_s"));
}

/// Position and speed of the train at the end.
std::string End(const Json& summary) {
  if (Holds(summary, "stopped")) {
    return fmt::format("stands after {:.1f} s and {:.1f} m", Number(summary, "stop_time_s"),
                       Number(summary, "stop_distance_m"));
  }
  std::string text = fmt::format("ends after {:.1f} s", Number(summary, "simulated_s"));
  if (Has(summary, "distance_m")) text += fmt::format(" and {:.1f} m", Number(summary, "distance_m"));
  if (Has(summary.at("final_speed_kmh"), "mean"))
    text += fmt::format(" at {:.1f} km/h", Number(summary.at("final_speed_kmh"), "mean"));
  return text;
}

std::string Forces(const Json& summary) {
  std::string text;
  for (const char* kind : {"tension", "compression"}) {
    const std::string key = fmt::format("max_{}_n", kind);
    if (!Has(summary, key.c_str()) || !Has(summary.at(key), "value")) continue;
    const Json& largest = summary.at(key);
    text += fmt::format("{}largest {} {:.0f} kN in {}", text.empty() ? "  " : ", ", kind,
                        1e-3 * std::abs(Number(largest, "value")), Place(largest));
  }
  return text.empty() ? "" : text + "\n";
}

std::string Partings(const Json& summary) {
  std::string text;
  if (!Has(summary, "partings")) return text;
  for (const Json& parting : summary.at("partings"))
    text += (text.empty() ? "  the train parted: " : ", ") + Place(parting);
  return text.empty() ? "" : text + "\n";
}

std::string Slides(const Json& summary) {
  if (!Has(summary, "slides")) return "";
  const Json& slides = summary.at("slides");
  const auto number = slides.at("slides").get<std::size_t>();
  if (number == 0) return "";
  const auto flats = slides.at("flat_risks").get<std::size_t>();
  return fmt::format("  {} slid, {} in all{}\n", Count(slides.at("wheelsets").size(), "wheelset"),
                     Count(number, "slide"), flats == 0 ? "" : fmt::format(", with a risk of a flat on {}", flats));
}

std::string Twin(const Json& summary) {
  if (!Has(summary, "twin")) return "";
  const Json& twin = summary.at("twin");
  return fmt::format(
      "  a start {:g} km/h faster changes the largest forces by up to {:.3g} N and the distance by {:.3g} "
      "m\n",
      Number(twin, "start_offset_kmh"),
      std::max(Number(twin, "max_tension_spread_n"), Number(twin, "max_compression_spread_n")),
      Number(twin, "distance_spread_m"));
}

std::string Text(const Json& summary) {
  std::string text = fmt::format("{}: {}, {} model, {}\n", summary.at("scenario").get<std::string>(),
                                 Count(summary.at("vehicles").get<std::size_t>(), "vehicle"),
                                 summary.at("model").get<std::string>(), End(summary));
  if (!Holds(summary, "stopped") && Has(summary, "ended_by") && summary.at("ended_by") == "duration_s") {
    text +=
        "  (duration_s is over; with a greater one and `until: {standing: true}` it ends when the train "
        "stands)\n";
  }
  text += Forces(summary) + Partings(summary);
  if (Holds(summary, "rolled_back"))
    text += fmt::format("  it rolled back, at the end by {:.1f} m\n", Number(summary, "rolled_back_m"));
  if (Has(summary, "left_route_s"))
    text += fmt::format("  it left its route at {:.1f} s\n", Number(summary, "left_route_s"));
  text += Slides(summary) + Twin(summary);
  if (!summary.at("complete").get<bool>()) {
    text +=
        "  INCOMPLETE: " + (Has(summary, "fault") ? summary.at("fault").get<std::string>() : "the run was stopped") +
        "\n";
  }
  return text;
}

}  // namespace

std::string SummaryText(const std::string& summary_json) {
  try {
    return Text(Json::parse(summary_json));
  } catch (const Json::exception& e) {
    throw NoSummary(e.what());
  }
}

}  // namespace train_results
