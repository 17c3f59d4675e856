#include "train_brake_rviz/board/board.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "train_brake_rviz/board/layout.h"

namespace train_brake_rviz {
namespace {

constexpr double kLeastWindow = 60.0;      // [m] of track that is seen, however short the train
constexpr double kWindowPerTrain = 1.012;  // room for slack that is pulled out
constexpr double kLeastForce = 100.0;      // [kN], end of the axis while nothing happens
constexpr double kLeastPressure = 100.0;   // [kPa]
constexpr double kKilo = 1e-3, kKmhPerMps = 3.6;

double LengthOf(const train_dynamics::Consist& consist) {
  const int last = consist.vehicles() - 1;
  return consist.centre_m.front() - consist.centre_m.back() +
         0.5 * (consist.vehicle(0).length_m + consist.vehicle(last).length_m);
}

std::vector<double> Scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

/// The size that a share of the values does not exceed.
double SizeOf(double share, std::vector<double> values) {
  for (double& value : values) value = std::isfinite(value) ? std::abs(value) : 0.0;
  if (values.empty()) return 0.0;
  const auto place = values.begin() + static_cast<long>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

std::string ModelText(const train_dynamics::ScenarioParams& scenario) {
  const std::string names = scenario.ModelNames();
  return names == "2d" ? "2D model" : (names.find(',') == std::string::npos ? "model " : "models ") + names;
}

}  // namespace

void Board::Seen::Include(const std::vector<double>& values) {
  low.resize(values.size(), 0.0);
  high.resize(values.size(), 0.0);
  for (size_t i = 0; i < values.size(); ++i) {
    low[i] = std::min(low[i], values[i]);
    high[i] = std::max(high[i], values[i]);
  }
}

Board::Board(const train_dynamics::ScenarioParams& scenario, const BoardOptions& options)
    : scenario_(scenario),
      consist_(scenario.train),
      options_(options),
      elevation_(scenario.track),
      window_m_(std::max(kLeastWindow, kWindowPerTrain * LengthOf(consist_))),
      vertical_exaggeration_(options.vertical_exaggeration),
      force_limit_kn_(kLeastForce),
      pressure_limit_kpa_(kLeastPressure) {
  for (int i = 0; i < vehicles(); ++i) masses_kg_.push_back(consist_.vehicle(i).TotalMass());
  if (vertical_exaggeration_ <= 0.0) {
    // The track that comes into view if the train does not gain speed.
    const double way = scenario.MeanInitialSpeed() * scenario.duration_s;
    const double front = scenario.start_position_m;
    vertical_exaggeration_ =
        FittingExaggeration(elevation_, front + std::min(0.0, way) - window_m_, front + std::max(0.0, way), window_m_,
                            layout::kTrain.width() / window_m_, TrainStrip::RoomForTrack(layout::kTrain));
  }
  for (std::size_t type = 0; type < consist_.vehicle_types.size(); ++type) {
    at_rest_.emplace_back();
    if (scenario.ModelOfGroup(type) != train_dynamics::VehicleModel::kTwoD) continue;
    at_rest_.back() = train_dynamics::WithBogieVehicle(consist_.vehicle_types[type], [](const auto& wagon) {
      return CloseUp::BodiesOf(train_dynamics::StaticEquilibrium(wagon, 0.0, 0.0).position);
    });
  }
  Forget();
}

void Board::Forget() {
  forces_seen_ = pressures_seen_ = {};
  force_limit_kn_ = GrowingLimit(kLeastForce);
  pressure_limit_kpa_ = GrowingLimit(kLeastPressure);
  color_limit_.clear();
  for (const Quantity& quantity : Quantities()) color_limit_.emplace(quantity.name, quantity.least_limit);
}

void Board::Remember(const Snapshot& snapshot, const Selection& selection) {
  forces_seen_.Include(Scaled(snapshot.coupler_force_n, kKilo));
  pressures_seen_.Include(Scaled(snapshot.cylinder_pressure_pa, kKilo));
  force_limit_kn_.Include(kKilo * SizeOf(1.0, snapshot.coupler_force_n));
  pressure_limit_kpa_.Include(kKilo * SizeOf(1.0, snapshot.cylinder_pressure_pa));
  const Quantity& quantity = *selection.quantity;
  // Not all vehicles: one that meets a shock shall not pale all the others.
  constexpr double kShare = 0.95;
  color_limit_.at(quantity.name).Include(quantity.per_si * SizeOf(kShare, quantity.values(snapshot)));
}

Abscissa Board::AbscissaOf(const Snapshot& snapshot) const {
  const double spare = 0.5 * (window_m_ - LengthOf(consist_));
  const double head = snapshot.position_m.front() + 0.5 * consist_.vehicle(0).length_m + spare;
  return {head, layout::kLeft, layout::kTrain.width() / window_m_};
}

std::vector<double> Board::VehicleGrid(const Snapshot& snapshot) const {
  const int last = vehicles();
  const Axis numbers = {1.0, std::max(2.0, static_cast<double>(last)), 0.0, 1.0};
  std::vector<double> grid;
  for (const double number : numbers.Ticks(8)) {
    const bool is_vehicle = number >= 1.0 && number <= last && number == std::floor(number);
    if (is_vehicle) grid.push_back(snapshot.position_m[static_cast<size_t>(number) - 1]);
  }
  return grid;
}

Picture Board::Draw(const Snapshot& snapshot, const Selection& selection) {
  Picture picture;
  Remember(snapshot, selection);
  DrawNumbers(picture.numbers, snapshot);
  DrawLegend(picture.legend, selection);
  if (snapshot.position_m.empty()) return picture;
  const Abscissa abscissa = AbscissaOf(snapshot);
  DrawForces(picture.plots, snapshot, abscissa);
  DrawPressures(picture.plots, snapshot, abscissa);
  DrawTrain(picture.train, snapshot, selection, abscissa);
  DrawCloseUp(picture.close_up, snapshot, selection);
  return picture;
}

void Board::DrawNumbers(Drawing& drawing, const Snapshot& snapshot) const {
  const Rectangle& area = layout::kHeader;
  const double upper = area.top - 1.6, lower = area.bottom + 2.2;
  drawing.Write({area.left, upper}, Align::kLeft, 1.2 * layout::kText, scenario_.name);
  drawing.Write({area.left, upper - 3.0}, Align::kLeft, layout::kSmallText,
                fmt::format("{} vehicle{}, {}", vehicles(), vehicles() == 1 ? "" : "s", ModelText(scenario_)),
                palette::kDark);

  double place = 66.0;
  const auto card = [&](const std::string& caption, const std::string& value, double width) {
    drawing.Write({place, upper}, Align::kCentre, layout::kSmallText, caption, palette::kDark);
    drawing.Write({place, lower}, Align::kCentre, layout::kLargeText, value);
    place += width;
  };
  card("time", fmt::format("{:.2f} s", snapshot.time_s), 22.0);
  if (!snapshot.speed_mps.empty()) {
    const double momentum = std::inner_product(masses_kg_.begin(), masses_kg_.end(), snapshot.speed_mps.begin(), 0.0);
    const double mean = momentum / std::accumulate(masses_kg_.begin(), masses_kg_.end(), 0.0);
    card("speed", fmt::format("{:.1f} km/h", kKmhPerMps * mean), 25.0);
    card("distance", fmt::format("{:.0f} m", snapshot.position_m.front() - scenario_.start_position_m), 21.0);
  }
  card("real-time factor", fmt::format("{:.2f}", snapshot.real_time_factor), 0.0);
}

void Board::DrawForces(Drawing& drawing, const Snapshot& snapshot, const Abscissa& abscissa) const {
  const Rectangle& area = layout::kForcePlot;
  const double limit = force_limit_kn_.value();
  const AlongPlot plot(area, {-limit, limit, area.bottom, area.top}, abscissa);
  plot.DrawAxes(drawing, "coupler force [kN]; grey: seen so far", VehicleGrid(snapshot));
  if (snapshot.coupler_force_n.empty()) {
    drawing.Write(area.Centre(), Align::kCentre, layout::kText, vehicles() == 1 ? "no couplers" : "not recorded",
                  palette::kDark);
    return;
  }

  const std::vector<double> force = Scaled(snapshot.coupler_force_n, kKilo), zero(force.size(), 0.0);
  const std::vector<double>& edges = snapshot.position_m;  // a connection's bar ends at the vehicles' centres
  drawing.On(Layer::kBack);
  plot.DrawBars(drawing, edges, forces_seen_.low, forces_seen_.high, palette::kShade);
  drawing.On(Layer::kFill);
  plot.DrawBars(drawing, edges, zero, force, palette::kTension);
  plot.DrawBars(drawing, edges, force, zero, palette::kCompression);

  const auto [lowest, highest] = std::minmax_element(force.begin(), force.end());
  const auto between = [&force](auto at) {
    const auto vehicle = at - force.begin() + 1;
    return fmt::format("{:.0f} kN at {}-{}", std::abs(*at), vehicle, vehicle + 1);
  };
  const double up = area.top + 1.6;
  constexpr double kWorthNaming = 0.5;  // [kN]
  if (*highest > kWorthNaming)
    drawing.Write({area.right - 44.0, up}, Align::kRight, layout::kText, "tension " + between(highest),
                  palette::kTension);
  if (*lowest < -kWorthNaming)
    drawing.Write({area.right, up}, Align::kRight, layout::kText, "compression " + between(lowest),
                  palette::kCompression);
}

void Board::DrawPressures(Drawing& drawing, const Snapshot& snapshot, const Abscissa& abscissa) const {
  const Rectangle& area = layout::kPressurePlot;
  const AlongPlot plot(area, {0.0, pressure_limit_kpa_.value(), area.bottom, area.top}, abscissa);
  const std::vector<double> grid = VehicleGrid(snapshot);
  constexpr double kNumberBelow = 1.9;
  plot.DrawAxes(drawing, "brake cylinder pressure [kPa]", grid);
  for (const double position : grid) {
    const auto vehicle = std::find(snapshot.position_m.begin(), snapshot.position_m.end(), position);
    drawing.Write({abscissa(position), area.bottom - kNumberBelow}, Align::kCentre, layout::kSmallText,
                  std::to_string(vehicle - snapshot.position_m.begin() + 1));
  }
  drawing.Write({area.left - 1.0, area.bottom - kNumberBelow}, Align::kRight, layout::kSmallText, "vehicle");
  if (snapshot.cylinder_pressure_pa.empty()) {
    drawing.Write(area.Centre(), Align::kCentre, layout::kText, "not recorded", palette::kDark);
    return;
  }

  const std::vector<double> pressure = Scaled(snapshot.cylinder_pressure_pa, kKilo), zero(pressure.size(), 0.0);
  const std::vector<double> edges =
      VehicleEdges(snapshot.position_m, consist_.vehicle(0).length_m, consist_.vehicle(vehicles() - 1).length_m);
  drawing.On(Layer::kBack);
  plot.DrawBars(drawing, edges, zero, pressures_seen_.high, palette::kShade);
  drawing.On(Layer::kFill);
  plot.DrawBars(drawing, edges, zero, pressure, palette::kGreen);
  const auto [lowest, highest] = std::minmax_element(pressure.begin(), pressure.end());
  drawing.Write({area.right, area.top + 1.6}, Align::kRight, layout::kText,
                fmt::format("{:.0f} ... {:.0f} kPa", *lowest, *highest), palette::kGreen);
}

std::vector<Color> Board::Colors(const Snapshot& snapshot, const Selection& selection) const {
  const Quantity& quantity = *selection.quantity;
  const double limit = color_limit_.at(quantity.name).value();
  std::vector<Color> colors(consist_.vehicle_type.size(), palette::kUnknown);
  const std::vector<double> values = quantity.values(snapshot);
  for (size_t i = 0; i < values.size(); ++i) colors[i] = ColorOf(quantity, quantity.per_si * values[i], limit);
  return colors;
}

void Board::DrawTrain(Drawing& drawing, const Snapshot& snapshot, const Selection& selection,
                      const Abscissa& abscissa) const {
  const TrainStrip strip(layout::kTrain, elevation_, vertical_exaggeration_);
  const std::vector<double> edges =
      VehicleEdges(snapshot.position_m, consist_.vehicle(0).length_m, consist_.vehicle(vehicles() - 1).length_m);
  strip.DrawTrack(drawing, abscissa);
  strip.DrawVehicles(drawing, abscissa, edges, Colors(snapshot, selection));
  strip.DrawLocomotives(drawing, abscissa, edges, consist_.locomotives);
  const auto followed = static_cast<size_t>(selection.vehicle);
  strip.DrawZoom(drawing, abscissa, edges[followed], edges[followed + 1], layout::kCloseUp);

  if (!elevation_.IsLevel()) {
    drawing.Write({layout::kTrain.right, layout::kTrain.bottom - 1.0}, Align::kRight, layout::kSmallText,
                  fmt::format("heights of the track × {:g}", vertical_exaggeration_), palette::kDark);
  }

  const double up = strip.Rail(abscissa, edges.front()) + 0.5 * TrainStrip::kVehicleHeight;
  const double left = std::min(abscissa(edges.front()) - 1.0, layout::kLeft + 8.0);
  drawing.On(Layer::kTop);
  drawing.Arrow({left, up}, {left - 5.0, up}, 0.8, palette::kDark);
}

void Board::DrawCloseUp(Drawing& drawing, const Snapshot& snapshot, const Selection& selection) const {
  const int followed = selection.vehicle;
  const CloseUp close_up(layout::kCloseUp, consist_.vehicle(followed),
                         at_rest_[static_cast<size_t>(consist_.vehicle_type[followed])], options_.motion_exaggeration);
  const std::vector<double>& force = snapshot.coupler_force_n;
  CloseUp::Sight sight{};
  sight.title = fmt::format("vehicle {}", followed + 1);
  sight.remark = snapshot.wagon ? fmt::format("motion × {:g}", options_.motion_exaggeration)
                 : scenario_.model == train_dynamics::VehicleModel::kTwoD ? "drawn at rest: not in detail_vehicles"
                                                                          : "drawn at rest: a point mass";
  sight.centre_m = snapshot.position_m[followed];
  sight.detail = snapshot.wagon ? &*snapshot.wagon : nullptr;
  if (followed > 0 && !force.empty()) sight.front_force_n = force[followed - 1];
  if (followed + 1 < vehicles() && !force.empty()) sight.rear_force_n = force[followed];
  sight.color = Colors(snapshot, selection)[followed];
  close_up.Draw(drawing, elevation_.track(), sight);
}

void Board::DrawLegend(Drawing& drawing, const Selection& selection) const {
  const Rectangle& area = layout::kLegend;
  const Quantity& quantity = *selection.quantity;
  const double limit = color_limit_.at(quantity.name).value();
  const Rectangle bar = {area.left + 2.0, area.right - 2.0, area.top - 7.0, area.top - 4.5};
  drawing.Write({area.left, area.top - 2.0}, Align::kLeft, layout::kText,
                fmt::format("vehicles: {} [{}]", quantity.label, quantity.unit));
  const Axis axis = {quantity.diverging ? -limit : 0.0, limit, bar.left, bar.right};
  constexpr int kShades = 60;
  drawing.On(Layer::kFill);
  for (int i = 0; i < kShades; ++i) {
    const double low = axis.min + (axis.max - axis.min) * i / kShades;
    const double high = axis.min + (axis.max - axis.min) * (i + 1) / kShades;
    drawing.Box({axis(low), axis(high), bar.bottom, bar.top}, ColorOf(quantity, 0.5 * (low + high), limit));
  }
  drawing.On(Layer::kLine);
  drawing.Frame(bar, layout::kThin, palette::kAxis);
  const std::vector<double> ticks = axis.Ticks(4);
  for (const double tick : ticks) {
    drawing.Line({axis(tick), bar.bottom}, {axis(tick), bar.bottom - 0.5}, layout::kThin, palette::kAxis);
    drawing.Write({axis(tick), bar.bottom - 1.6}, Align::kCentre, layout::kSmallText,
                  TickText(tick, ticks[1] - ticks[0]));
  }
  if (quantity.diverging) {
    drawing.Write({bar.left, bar.bottom - 3.8}, Align::kLeft, layout::kSmallText, quantity.negative, palette::kDark);
    drawing.Write({bar.right, bar.bottom - 3.8}, Align::kRight, layout::kSmallText, quantity.positive, palette::kDark);
  }

  // Arrows of the close-up.
  double up = area.bottom + 9.2;
  const auto arrow = [&](const std::string& name, double length, Color color) {
    drawing.On(Layer::kFill);
    drawing.Arrow({area.left + 2.0, up}, {area.left + 2.0 + length, up}, 0.6, color);
    drawing.Write({area.left + 12.0, up}, Align::kLeft, layout::kSmallText, name, palette::kDark);
    up -= 2.6;
  };
  arrow("wheel load, 400 kN", CloseUp::kLoadScale * 400e3, palette::kGreen);
  arrow("creep force, 10 kN", CloseUp::kFrictionScale * 10e3, palette::kOrange);
  arrow("brake shoe force, 10 kN", CloseUp::kFrictionScale * 10e3, palette::kPurple);
  arrow("coupler force, 500 kN", CloseUp::kCouplerScale * 500e3, palette::kTension);
}

}  // namespace train_brake_rviz
