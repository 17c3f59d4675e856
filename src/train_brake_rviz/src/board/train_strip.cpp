#include "train_brake_rviz/board/train_strip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "train_brake_rviz/board/layout.h"

namespace train_brake_rviz {
namespace {

constexpr double kLabelRoom = 3.2;  // on the board, for the numbers under the track

}  // namespace

double TrainStrip::RoomForTrack(const Rectangle& area) { return area.height() - kVehicleHeight - kLabelRoom; }

double TrainStrip::Rail(const Abscissa& abscissa, double position_m) const {
  // The middle of what is seen is drawn at a fixed height.
  const double middle_m = abscissa.head_m - 0.5 * area_.width() / abscissa.scale;
  const double middle_up = area_.bottom + kLabelRoom + 0.5 * RoomForTrack(area_);
  return middle_up + (elevation_(position_m) - elevation_(middle_m)) * exaggeration_ * abscissa.scale;
}

void TrainStrip::DrawTrack(Drawing& drawing, const Abscissa& abscissa) const {
  constexpr int kPieces = 200;
  constexpr double kBallast = 0.9, kPost = 0.7;
  const double seen_m = area_.width() / abscissa.scale, end_m = abscissa.head_m - seen_m;
  const auto rail_at = [&](double position) { return Point{abscissa(position), Rail(abscissa, position)}; };
  for (int i = 0; i < kPieces; ++i) {
    const Point a = rail_at(abscissa.head_m - seen_m * i / kPieces);
    const Point b = rail_at(abscissa.head_m - seen_m * (i + 1) / kPieces);
    drawing.On(Layer::kBack);
    drawing.Polygon({{a.right, a.up - kBallast}, {b.right, b.up - kBallast}, b, a}, palette::kGrid);
    drawing.On(Layer::kLine);
    drawing.Line(a, b, layout::kThick, palette::kDark);
  }
  // Posts along the track show that the train moves.
  const Axis metres = {end_m, abscissa.head_m, 0.0, 1.0};
  const std::vector<double> posts = metres.Ticks(6);
  for (const double post : posts) {
    const Point foot = rail_at(post);
    drawing.Line({foot.right, foot.up - kBallast - kPost}, foot, layout::kThick, palette::kDark);
    const std::string place = seen_m > 1000.0 ? TickText(1e-3 * post, 1e-3 * (posts[1] - posts[0])) + " km"
                                              : TickText(post, posts[1] - posts[0]) + " m";
    const double half = 0.5 * layout::kSmallText * TextWidth(place);
    if (foot.right - half < area_.left || foot.right + half > area_.right) continue;
    drawing.Write({foot.right, foot.up - kBallast - kPost - 1.0}, Align::kCentre, layout::kSmallText, place,
                  palette::kDark);
  }
}

void TrainStrip::DrawVehicles(Drawing& drawing, const Abscissa& abscissa, const std::vector<double>& edge_m,
                              const std::vector<Color>& color) const {
  constexpr double kGap = 0.08, kWidestGap = 0.5;  // between vehicles: of their length, on the board
  for (size_t i = 0; i < color.size(); ++i) {
    const double left = abscissa(edge_m[i]), right = abscissa(edge_m[i + 1]);
    const double gap = 0.5 * std::min(kGap * (right - left), kWidestGap);
    const double floor = Rail(abscissa, 0.5 * (edge_m[i] + edge_m[i + 1])) + 0.5;
    const Rectangle body = {left + gap, right - gap, floor, floor + kVehicleHeight - 0.5};
    drawing.On(Layer::kFill);
    drawing.Box(body, color[i]);
    // Sill and roof in dark, so that pale vehicles stand out from the paper.
    drawing.On(Layer::kLine);
    drawing.Line({left, body.top}, {right, body.top}, layout::kThin, palette::kDark);
    drawing.Line({left, body.bottom}, {right, body.bottom}, layout::kThin, palette::kDark);
  }
}

void TrainStrip::DrawLocomotives(Drawing& drawing, const Abscissa& abscissa, const std::vector<double>& edge_m,
                                 const std::vector<int>& locomotives) const {
  constexpr double kGap = 0.5;  // between two names
  const std::string name = "locomotive";
  const double half = 0.5 * layout::kSmallText * TextWidth(name);
  double free = area_.left;
  drawing.On(Layer::kFront);
  for (const int i : locomotives) {
    const double middle_m = 0.5 * (edge_m[i] + edge_m[i + 1]);
    const double middle = abscissa(middle_m), roof = Rail(abscissa, middle_m) + kVehicleHeight;
    drawing.Triangle({middle - 0.7, roof + 1.1}, {middle, roof + 0.1}, {middle + 0.7, roof + 1.1}, palette::kDark);
    const double centre = std::max(middle, area_.left + half);
    if (centre - half < free) continue;
    drawing.Write({centre, roof + 2.1}, Align::kCentre, layout::kSmallText, name, palette::kDark);
    free = centre + half + kGap;
  }
}

void TrainStrip::DrawZoom(Drawing& drawing, const Abscissa& abscissa, double front_m, double rear_m,
                          const Rectangle& close_up) const {
  const double left = abscissa(front_m), right = abscissa(rear_m);
  const double rail = Rail(abscissa, 0.5 * (front_m + rear_m));
  drawing.On(Layer::kFront);
  drawing.Frame({left, right, rail, rail + kVehicleHeight + 0.6}, layout::kThick, palette::kInk);
  drawing.On(Layer::kBeam);
  drawing.Polygon({{left, rail}, {close_up.left, close_up.top}, {close_up.right, close_up.top}, {right, rail}},
                  palette::kShade);
}

}  // namespace train_brake_rviz
