#include "train_brake_rviz/board/along_train.h"

#include <cmath>

#include "train_brake_rviz/board/layout.h"

namespace train_brake_rviz {

std::vector<double> VehicleEdges(const std::vector<double>& centre_m, double first_length_m, double last_length_m) {
  std::vector<double> edges = {centre_m.front() + 0.5 * first_length_m};
  for (size_t i = 1; i < centre_m.size(); ++i) edges.push_back(0.5 * (centre_m[i - 1] + centre_m[i]));
  edges.push_back(centre_m.back() - 0.5 * last_length_m);
  return edges;
}

void AlongPlot::DrawAxes(Drawing& drawing, const std::string& title, const std::vector<double>& grid_m) const {
  constexpr int kTicks = 4;
  const std::vector<double> ticks = values_.Ticks(kTicks);
  drawing.On(Layer::kLine);
  for (const double position : grid_m) {
    const double right = abscissa_(position);
    drawing.Line({right, area_.bottom}, {right, area_.top}, layout::kThin, palette::kGrid);
  }
  for (const double tick : ticks) {
    const double up = values_(tick);
    drawing.Line({area_.left, up}, {area_.right, up}, layout::kThin, tick == 0.0 ? palette::kDark : palette::kGrid);
    drawing.Write({area_.left - 1.0, up}, Align::kRight, layout::kSmallText, TickText(tick, ticks[1] - ticks[0]));
  }
  drawing.Frame(area_, layout::kThin, palette::kAxis);
  drawing.Write({area_.left, area_.top + 1.6}, Align::kLeft, layout::kText, title);
}

void AlongPlot::DrawBars(Drawing& drawing, const std::vector<double>& edge_m, const std::vector<double>& low,
                         const std::vector<double>& high, Color color) const {
  for (size_t i = 0; i < low.size(); ++i) {
    const double bottom = values_.Clamped(low[i]), top = values_.Clamped(high[i]);
    if (!std::isfinite(bottom) || !std::isfinite(top) || top <= bottom) continue;
    drawing.Box({abscissa_(edge_m[i]), abscissa_(edge_m[i + 1]), bottom, top}, color);
  }
}

}  // namespace train_brake_rviz
