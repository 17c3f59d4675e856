#include "train_brake_rviz/board/close_up.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "train_brake_rviz/board/axis.h"
#include "train_brake_rviz/board/layout.h"
#include "train_dynamics/vehicle/slide_event.h"

namespace train_brake_rviz {
namespace {

using train_dynamics::kCarbody;
using train_dynamics::kFrontBolster;
using train_dynamics::kFrontFrame;
using train_dynamics::kWheelset1;

constexpr double kSpan = 49.0;                      // width of the wagon on the board
constexpr double kRailUp = 10.0;                    // of the rail over the area's bottom
constexpr double kLoadText = 3.3, kSlipText = 1.3;  // heights of the numbers over the area's bottom
constexpr double kSliding = 0.1;                    // creepage from which a wheel counts as sliding
constexpr double kUndergear = 0.62;                 // height of a carbody's floor, of that of its centre of gravity

/// Whether a wheelset is locked, as train_dynamics/vehicle/slide_event.h says it.
bool IsLocked(const train_dynamics::WagonDetail& detail, int wheelset) {
  const double speed = std::abs(detail.velocity.x[kWheelset1 + wheelset]);
  return speed > train_dynamics::slide::kSlowest &&
         std::abs(detail.output.creepage[wheelset]) >= 1.0 - train_dynamics::slide::kLocked;
}

double MeanOfWheelsets(const CloseUp::Bodies& position, int wheelsets) {
  const double* first = &position.x[kWheelset1];
  return std::accumulate(first, first + wheelsets, 0.0) / wheelsets;
}

std::string Kilonewtons(double force_n) { return Rounded(1e-3 * force_n, 0) + " kN"; }

/// The bodies drawn for a vehicle; for one given as one mass, bodies of usual sizes.
train_dynamics::VehicleParams WithBodies(train_dynamics::VehicleParams vehicle) {
  if (!vehicle.IsOneMass()) return vehicle;
  vehicle.mass_kg.reset();
  vehicle.load.reset();
  vehicle.carbody.cg_height_m = 1.8;
  vehicle.bolster.cg_height_m = 0.7;
  vehicle.bogie_frame.cg_height_m = 0.55;
  vehicle.wheelset.wheel_radius_m = 0.46;
  vehicle.half_wheelset_spacing_m = std::min(0.9, 0.08 * vehicle.length_m);
  vehicle.half_bogie_spacing_m = 0.33 * vehicle.length_m;
  vehicle.coupler_height_m = 1.0;
  vehicle.bolster_guide_height_m = 0.7;
  vehicle.centre_plate.height_m = 0.9;
  vehicle.centre_plate.rim_offset_m = 0.3;
  vehicle.spring_nest.offset_m = 0.3;
  return vehicle;
}

}  // namespace

CloseUp::CloseUp(const Rectangle& area, const train_dynamics::VehicleParams& of_train, const Bodies& at_rest,
                 double motion_exaggeration)
    : area_(area),
      vehicle_(WithBodies(of_train)),
      at_rest_(at_rest),
      exaggeration_(motion_exaggeration),
      scale_(kSpan / of_train.length_m),
      rail_(area.bottom + kRailUp) {
  const train_dynamics::VehicleParams& vehicle = vehicle_;
  forward_m_[kCarbody] = 0.0;
  height_m_[kCarbody] = vehicle.LoadedCarbody().cg_height_m;
  for (int bogie = 0; bogie < train_dynamics::kBogies; ++bogie) {
    const double sign = bogie == 0 ? 1.0 : -1.0;
    const double centre = sign * vehicle.half_bogie_spacing_m;
    forward_m_[kFrontBolster + bogie] = forward_m_[kFrontFrame + bogie] = centre;
    height_m_[kFrontBolster + bogie] = vehicle.bolster.cg_height_m;
    height_m_[kFrontFrame + bogie] = vehicle.bogie_frame.cg_height_m;
    const int wheelsets = vehicle.wheelsets_per_bogie;
    for (int axle = 0; axle < wheelsets; ++axle) {
      const int wheelset = kWheelset1 + wheelsets * bogie + axle;
      double offset = sign * vehicle.middle_wheelset_offset_m;
      if (axle == 0) offset = vehicle.half_wheelset_spacing_m;
      if (axle == wheelsets - 1) offset = -vehicle.half_wheelset_spacing_m;
      forward_m_[wheelset] = centre + offset;
      height_m_[wheelset] = vehicle.wheelset.wheel_radius_m;
    }
  }
}

Point CloseUp::PlaceOf(const Bodies& position, int body, double offset_forward_m, double offset_up_m) const {
  const bool turns = body >= kWheelset1;  // wheels turn as they do, the others tilt as much as all moves
  const double angle = turns ? position.pitch[body] : exaggeration_ * (position.pitch[body] - at_rest_.pitch[body]);
  const double forward = forward_m_[body] +
                         exaggeration_ * (position.x[body] - MeanOfWheelsets(position, vehicle_.Wheelsets())) +
                         std::cos(angle) * offset_forward_m + std::sin(angle) * offset_up_m;
  const double up = height_m_[body] + exaggeration_ * (position.z[body] - at_rest_.z[body]) +
                    std::cos(angle) * offset_up_m - std::sin(angle) * offset_forward_m;
  return {0.5 * (area_.left + area_.right) - scale_ * forward, rail_ + scale_ * up};
}

void CloseUp::Draw(Drawing& drawing, const train_dynamics::Track& track, const Sight& sight) const {
  drawing.On(Layer::kBack);
  drawing.Box(area_, palette::kPaper);
  drawing.On(Layer::kLine);
  drawing.Frame(area_, layout::kThin, palette::kAxis);
  const double left = area_.left + 1.5;
  drawing.Write({left, area_.top - 2.0}, Align::kLeft, layout::kText, sight.title);
  drawing.Write({left, area_.top - 4.6}, Align::kLeft, layout::kSmallText, sight.remark, palette::kDark);
  DrawRail(drawing, track, sight.centre_m);

  Bodies position = at_rest_;
  for (int i = 0; i < vehicle_.Wheelsets(); ++i) {
    position.pitch[kWheelset1 + i] = sight.centre_m / vehicle_.wheelset.wheel_radius_m;
  }
  if (sight.detail != nullptr) position = BodiesOf(sight.detail->position);
  DrawBodies(drawing, position, sight.color);
  for (int i = 0; i < vehicle_.Wheelsets(); ++i) {
    const bool slides = sight.detail != nullptr && std::abs(sight.detail->output.creepage[i]) >= kSliding;
    DrawWheelset(drawing, position, i, slides, sight.detail != nullptr && IsLocked(*sight.detail, i));
  }
  DrawCouplerForce(drawing, position, 1.0, sight.front_force_n);
  DrawCouplerForce(drawing, position, -1.0, sight.rear_force_n);
  if (sight.detail == nullptr) return;
  drawing.Write({left, area_.bottom + kLoadText}, Align::kLeft, layout::kSmallText, "wheel load", palette::kDark);
  drawing.Write({left, area_.bottom + kSlipText}, Align::kLeft, layout::kSmallText, "slip", palette::kDark);
  DrawContactForces(drawing, *sight.detail);
}

void CloseUp::DrawRail(Drawing& drawing, const train_dynamics::Track& track, double centre_m) const {
  constexpr int kPieces = 60;
  const double half_m = 0.62 * vehicle_.length_m;
  const auto rail_at = [&](int piece) {
    const double forward = half_m * (1.0 - 2.0 * piece / kPieces);
    const double height = train_dynamics::RailHeightAt(track, centre_m + forward).height;
    return Point{0.5 * (area_.left + area_.right) - scale_ * forward, rail_ + scale_ * exaggeration_ * height};
  };
  drawing.On(Layer::kLine);
  for (int i = 0; i < kPieces; ++i) {
    Point a = rail_at(i), b = rail_at(i + 1);
    a.up -= 0.5 * layout::kThick;
    b.up -= 0.5 * layout::kThick;
    drawing.Line(a, b, layout::kThick, palette::kDark);
  }
}

void CloseUp::DrawBodies(Drawing& drawing, const Bodies& position, Color body) const {
  const auto outline = [&](int b, const std::vector<Point>& corners_m, Color fill, Layer layer) {
    std::vector<Point> corners;
    corners.reserve(corners_m.size() + 1);
    for (const Point& corner : corners_m) corners.push_back(PlaceOf(position, b, corner.right, corner.up));
    drawing.On(layer);
    drawing.Polygon(corners, fill);
    corners.push_back(corners.front());
    drawing.Polyline(corners, layout::kThin, palette::kDark);
  };
  // In metres from each body's centre: (forward, up).
  const double half = 0.5 * vehicle_.length_m - 0.45;
  const double floor = (kUndergear - 1.0) * vehicle_.LoadedCarbody().cg_height_m, roof = -1.1 * floor;
  outline(kCarbody,
          {{half, floor + 0.3},
           {half - 0.3, floor},
           {0.3 - half, floor},
           {-half, floor + 0.3},
           {-half, roof},
           {half, roof}},
          body, Layer::kFill);
  const double coupler = vehicle_.coupler_height_m - vehicle_.LoadedCarbody().cg_height_m;
  for (const double end : {1.0, -1.0}) {
    const double inner = end * (half - 0.8), outer = end * 0.5 * vehicle_.length_m;
    outline(kCarbody,
            {{inner, coupler - 0.12}, {outer, coupler - 0.12}, {outer, coupler + 0.12}, {inner, coupler + 0.12}},
            palette::kAxis, Layer::kBack);
  }
  const double plate = vehicle_.centre_plate.height_m - vehicle_.bolster.cg_height_m;
  const double axle = vehicle_.half_wheelset_spacing_m;
  for (int bogie = 0; bogie < train_dynamics::kBogies; ++bogie) {
    outline(kFrontBolster + bogie,
            {{0.28, -0.2}, {0.28, plate}, {0.16, plate + 0.35}, {-0.16, plate + 0.35}, {-0.28, plate}, {-0.28, -0.2}},
            palette::kAxis, Layer::kTop);
    outline(kFrontFrame + bogie,
            {{axle + 0.18, -0.08},
             {axle + 0.18, 0.1},
             {0.55, 0.34},
             {-0.55, 0.34},
             {-axle - 0.18, 0.1},
             {-axle - 0.18, -0.08},
             {-0.55, -0.26},
             {0.55, -0.26}},
            palette::kSkyBlue, Layer::kFront);
  }
}

void CloseUp::DrawWheelset(Drawing& drawing, const Bodies& position, int wheelset, bool slides, bool locked) const {
  const int body = kWheelset1 + wheelset;
  const double radius = vehicle_.wheelset.wheel_radius_m;
  const Point axle = PlaceOf(position, body, 0.0, 0.0);
  drawing.On(Layer::kFill);
  drawing.Disc(axle, scale_ * radius, slides ? palette::kVermillion : palette::kDark);
  drawing.On(Layer::kLine);
  drawing.Disc(axle, scale_ * 0.82 * radius, locked ? palette::kVermillion : palette::kShade);
  drawing.On(Layer::kTop);  // over the bogie frame, which would hide that the wheel turns
  drawing.Line(PlaceOf(position, body, 0.0, -0.1 * radius), PlaceOf(position, body, 0.0, 0.8 * radius), 0.55,
               palette::kInk);
  drawing.Disc(axle, scale_ * 0.2 * radius, palette::kInk);
}

void CloseUp::DrawContactForces(Drawing& drawing, const train_dynamics::WagonDetail& detail) const {
  constexpr double kWidth = 0.5;
  const double radius = vehicle_.wheelset.wheel_radius_m;
  for (int i = 0; i < train_dynamics::kWheelsets; ++i) {
    const int body = kWheelset1 + i;
    const Point axle = PlaceOf(BodiesOf(detail.position), body, 0.0, 0.0);
    const Point contact = {axle.right, axle.up - scale_ * radius};
    drawing.On(Layer::kTop);
    const double load = detail.output.normal_force_n[i], creep = detail.output.creep_force_n[i];
    const auto arrow = [&](Point from, Point to, Color color) {
      const bool is_known = std::isfinite(from.up) && std::isfinite(to.right) && std::isfinite(to.up);
      if (is_known) drawing.Arrow(from, to, kWidth, color);
    };
    arrow({contact.right, contact.up - kLoadScale * load}, contact, palette::kGreen);
    arrow({contact.right, contact.up - 0.1}, {contact.right + kFrictionScale * creep, contact.up - 0.1},
          palette::kOrange);

    // The shoe is on the bogie's inner side of the wheel. Its friction acts along the tread: against a forward turning
    // wheel, upwards on the front half of the wheel and downwards on the rear half.
    const bool on_front_half = i % 2 == 1;
    const double side = (on_front_half ? -1.0 : 1.0) * scale_ * radius;
    const double shoe = (on_front_half ? 1.0 : -1.0) * kFrictionScale * detail.output.shoe_force_n[i];
    const Point tread = {axle.right + side, axle.up};
    arrow(tread, {tread.right, tread.up + shoe}, palette::kPurple);

    drawing.Write({contact.right, area_.bottom + kLoadText}, Align::kCentre, layout::kSmallText, Kilonewtons(load));
    const bool locked = IsLocked(detail, i);
    drawing.Write({contact.right, area_.bottom + kSlipText}, Align::kCentre, layout::kSmallText,
                  locked ? "LOCKED" : Rounded(100.0 * detail.output.creepage[i], 2) + " %",
                  locked ? palette::kVermillion : palette::kInk);
  }
}

void CloseUp::DrawCouplerForce(Drawing& drawing, const Bodies& position, double end, double force_n) const {
  if (force_n == 0.0 || !std::isfinite(force_n)) return;
  constexpr double kWidth = 0.8, kGap = 0.6, kNumberAway = 8.0, kNumberUp = 2.4;
  const double coupler = vehicle_.coupler_height_m - vehicle_.LoadedCarbody().cg_height_m;
  const double outwards = -end;  // to the right on the board
  const Point face = PlaceOf(position, kCarbody, end * 0.5 * vehicle_.length_m, coupler);
  const Point near = {face.right + outwards * kGap, face.up};
  const Point far = {near.right + outwards * kCouplerScale * std::abs(force_n), face.up};
  const bool pulls = force_n > 0.0;
  const Color color = pulls ? palette::kTension : palette::kCompression;
  drawing.On(Layer::kTop);
  drawing.Arrow(pulls ? near : far, pulls ? far : near, kWidth, color);
  drawing.Write({face.right + outwards * kNumberAway, face.up + kNumberUp}, Align::kCentre, layout::kText,
                Kilonewtons(force_n), color);
}

}  // namespace train_brake_rviz
