#include "train_brake_rviz/view_node.h"

#include <fmt/format.h>
#include <train_brake_msgs/ViewSelection.h>
#include <train_brake_msgs/wagon_detail.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "strict_config/reader.h"
#include "train_brake_rviz/board/layout.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/ranks.h"
#include "train_node/caller.h"

namespace train_brake_rviz {
namespace {

constexpr double kPeriod = 0.05;                   // [s] of wall time between two pictures
constexpr std::chrono::seconds kRefreshPeriod(1);  // a display that was added late or reset gets everything
constexpr const char* kTrackFrame = "track";
constexpr const char* kBoardFrame = "board";

std::string QuantityNames() {
  std::vector<std::string> names;
  for (const Quantity& quantity : Quantities()) names.push_back(quantity.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// One tf tree holds all trains under a ROS master, so only one of them can have frames of plain names.
std::string FramePrefix(const std::string& train_namespace) {
  return train_namespace == "/train" ? "" : train_namespace.substr(1) + (train_namespace == "/" ? "" : "/");
}

template <class From>
std::vector<double> Doubles(const std::vector<From>& values, size_t count) {
  if (values.size() != count) return {};
  return {values.begin(), values.end()};
}

}  // namespace

ViewNode::ViewNode(const ros::NodeHandle& train, const ros::NodeHandle& own, train_node::NodeParameters& parameters)
    : train_(train),
      own_(own),
      frame_prefix_(FramePrefix(train.getNamespace())),
      source_(parameters.Flag("live", true) ? "live/" : "") {
  options_.vertical_exaggeration = parameters.NonNegative("vertical_exaggeration", 0.0);
  options_.motion_exaggeration = parameters.NonNegative("motion_exaggeration", options_.motion_exaggeration);
  first_vehicle_ = parameters.Integer("vehicle", 0);
  const std::string quantity = parameters.Text("quantity", selection_.quantity->name);
  const std::string file = train_node::ExpandHome(parameters.Text("scenario", ""));
  selection_.quantity = FindQuantity(quantity);
  if (selection_.quantity == nullptr) parameters.Complain("quantity", "must be one of " + QuantityNames());
  parameters.ThrowIfWrong();

  geometry_msgs::TransformStamped board;
  board.header.frame_id = kBoardFrame;
  board.child_frame_id = frame_prefix_ + kTrackFrame;
  board.transform.rotation.w = 1.0;
  static_transforms_.sendTransform(board);

  markers_publisher_ = own_.advertise<visualization_msgs::MarkerArray>("markers", 5);
  selection_publisher_ = own_.advertise<train_brake_msgs::ViewSelection>("selection", 1, true);
  select_service_ = own_.advertiseService("select", &ViewNode::OnSelect, this);
  PublishSelection();

  if (!file.empty()) Begin(train_dynamics::config::LoadScenario(file, {}).params);
  constexpr int kQueue = 1;  // only the newest is drawn
  subscribers_ = {train_.subscribe("scenario", kQueue, &ViewNode::OnScenario, this),
                  train_.subscribe(source_ + "state", kQueue, &ViewNode::OnState, this),
                  train_.subscribe<train_brake_msgs::InTrainForces>(
                      source_ + "in_train_forces", kQueue,
                      [this](const train_brake_msgs::InTrainForcesConstPtr& message) { forces_ = message; }),
                  train_.subscribe<train_brake_msgs::BrakePressures>(
                      source_ + "brake_pressures", kQueue,
                      [this](const train_brake_msgs::BrakePressuresConstPtr& message) { pressures_ = message; })};
  timer_ = own_.createWallTimer(ros::WallDuration(kPeriod), [this](const ros::WallTimerEvent&) { Draw(); });
}

void ViewNode::OnScenario(const std_msgs::String& message) {
  strict_config::ErrorList errors;
  const auto scenario = strict_config::LoadText<train_dynamics::ScenarioParams>(message.data, "scenario", errors);
  if (!errors.empty()) {
    ROS_ERROR("the scenario on %s cannot be used:\n%s", train_.resolveName("scenario").c_str(), errors.Text().c_str());
    return;
  }
  Begin(scenario);
}

void ViewNode::Begin(const train_dynamics::ScenarioParams& scenario) {
  const int vehicles_before = board_ == nullptr ? 0 : board_->vehicles();
  scenario_ = scenario;
  board_ = std::make_unique<Board>(scenario_, options_);
  elevation_ = std::make_unique<Elevation>(scenario_.track);
  writer_.Refresh();
  wagons_.clear();
  const std::vector<int> detailed = scenario_.DetailedVehicles();
  wagon_subscribers_.clear();
  for (const int i : detailed) {
    wagon_subscribers_.push_back(train_.subscribe<train_brake_msgs::WagonState>(
        source_ + train_dynamics::VehicleName(i, board_->vehicles()) + "/state", 1,
        [this, i](const train_brake_msgs::WagonStateConstPtr& message) { wagons_[i] = message; }));
  }

  if (board_->vehicles() != vehicles_before) {
    const int wanted = train_dynamics::VehicleIndex(first_vehicle_, board_->vehicles());
    if (first_vehicle_ != 0 && wanted < 0) {
      ROS_WARN("parameter vehicle: %d is not in a train of %d vehicles", first_vehicle_, board_->vehicles());
    }
    const std::vector<int>& locomotives = board_->locomotives();
    const auto wagon = std::find_if(detailed.begin(), detailed.end(), [&](int i) {
      return std::find(locomotives.begin(), locomotives.end(), i) == locomotives.end();
    });
    selection_.vehicle = wanted >= 0               ? wanted
                         : wagon != detailed.end() ? *wagon
                         : detailed.empty()        ? 0
                                                   : detailed.front();
  }
  PublishSelection();
}

void ViewNode::OnState(const train_brake_msgs::TrainStateConstPtr& message) {
  if (state_ != nullptr && message->exchange < state_->exchange) {  // another run, or the bag once more
    if (board_ != nullptr) board_->Forget();
    last_second_.clear();
    wagons_.clear();
    writer_.Refresh();
  }
  state_ = message;  // perhaps before the scenario: it waits until that has come
}

bool ViewNode::OnSelect(train_brake_msgs::SelectView::Request& request,
                        train_brake_msgs::SelectView::Response& response) {
  const Quantity* quantity = request.quantity.empty() ? selection_.quantity : FindQuantity(request.quantity);
  const int vehicles = board_ == nullptr ? 0 : board_->vehicles();
  const int vehicle =
      request.vehicle == 0 ? selection_.vehicle : train_dynamics::VehicleIndex(request.vehicle, vehicles);
  if (quantity == nullptr) {
    response.message = fmt::format("quantity must be one of {}, got {}", QuantityNames(), request.quantity);
  } else if (vehicle < 0) {
    response.message = fmt::format("vehicle {} is not in a train of {} vehicles", request.vehicle, vehicles);
  } else {
    selection_ = {quantity, vehicle};
    PublishSelection();
    response.success = true;
  }
  return true;
}

void ViewNode::PublishSelection() {
  train_brake_msgs::ViewSelection message;
  message.quantity = selection_.quantity->name;
  for (const Quantity& quantity : Quantities()) message.quantities.push_back(quantity.name);
  if (board_ != nullptr) {
    message.vehicle = static_cast<std::uint32_t>(selection_.vehicle + 1);
    message.vehicles = static_cast<std::uint32_t>(board_->vehicles());
    for (const int i : scenario_.DetailedVehicles()) message.detailed.push_back(static_cast<std::uint32_t>(i + 1));
  }
  selection_publisher_.publish(message);
}

void ViewNode::Draw() {
  const Snapshot snapshot = MakeSnapshot();
  PublishTransforms(snapshot);
  const unsigned viewers = markers_publisher_.getNumSubscribers();
  const Clock::time_point now = Clock::now();
  if (viewers > viewers_ || now >= next_refresh_) {
    writer_.Refresh();
    next_refresh_ = now + kRefreshPeriod;
  }
  viewers_ = viewers;
  if (viewers == 0) return;

  Picture picture;
  if (board_ != nullptr) {
    picture = board_->Draw(snapshot, selection_);
  } else {
    picture.numbers.Write(layout::kBoard.Centre(), Align::kCentre, layout::kLargeText,
                          fmt::format("waiting for a train on {}", train_.resolveName("scenario")));
  }
  visualization_msgs::MarkerArray markers;
  writer_.Append("numbers", picture.numbers, markers);
  writer_.Append("plots", picture.plots, markers);
  writer_.Append("train", picture.train, markers);
  writer_.Append("close-up", picture.close_up, markers);
  writer_.Append("legend", picture.legend, markers);
  if (!markers.markers.empty()) markers_publisher_.publish(markers);
}

Snapshot ViewNode::MakeSnapshot() {
  Snapshot snapshot;
  if (state_ == nullptr || board_ == nullptr) return snapshot;
  const auto vehicles = static_cast<size_t>(board_->vehicles());
  if (state_->position_m.size() != vehicles) {
    ROS_WARN_THROTTLE(10.0, "%s has %zu vehicles, but the scenario has %zu: not shown",
                      train_.resolveName(source_ + "state").c_str(), state_->position_m.size(), vehicles);
    return snapshot;
  }
  snapshot.time_s = state_->header.stamp.toSec();
  snapshot.real_time_factor = RealTimeFactor(snapshot.time_s);
  snapshot.position_m = state_->position_m;
  snapshot.speed_mps = Doubles(state_->speed_mps, vehicles);
  snapshot.acceleration_mps2 = Doubles(state_->acceleration_mps2, vehicles);
  snapshot.creepage = Doubles(state_->creepage, vehicles);
  if (forces_ != nullptr) snapshot.coupler_force_n = Doubles(forces_->coupler_force_n, vehicles - 1);
  if (pressures_ != nullptr) snapshot.cylinder_pressure_pa = Doubles(pressures_->cylinder_pressure_pa, vehicles);
  if (pressures_ != nullptr && !pressures_->pipe_pressure_pa.empty())
    snapshot.pipe_pressure_pa = Doubles(pressures_->pipe_pressure_pa, vehicles);
  const auto wagon = wagons_.find(selection_.vehicle);
  if (wagon != wagons_.end()) {
    train_dynamics::WagonDetail detail;
    train_brake_msgs::MessageToDetail(*wagon->second, detail);
    snapshot.wagon = detail;
  }
  return snapshot;
}

double ViewNode::RealTimeFactor(double simulated_s) {
  const Clock::time_point now = Clock::now();
  last_second_.push_back({now, simulated_s});
  while (now - last_second_.front().wall > std::chrono::seconds(1)) last_second_.pop_front();
  const std::chrono::duration<double> wall = now - last_second_.front().wall;
  return wall.count() > 0.0 ? (simulated_s - last_second_.front().simulated_s) / wall.count() : 0.0;
}

void ViewNode::PublishTransforms(const Snapshot& snapshot) {
  if (snapshot.position_m.empty()) return;
  std::vector<int> shown = board_->locomotives();
  if (std::find(shown.begin(), shown.end(), selection_.vehicle) == shown.end()) shown.push_back(selection_.vehicle);
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (const int i : shown) {
    ros::Time& sent = transform_sent_[i];
    if (sent == state_->header.stamp) continue;  // tf warns of repeated transforms
    sent = state_->header.stamp;
    constexpr double kReach = 1.0;  // [m] over which the slope is taken
    const double position = snapshot.position_m[i];
    const double rise = (*elevation_)(position + 0.5 * kReach) - (*elevation_)(position - 0.5 * kReach);
    const double nose_down = -std::atan2(rise, kReach);
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = state_->header.stamp;
    transform.header.frame_id = frame_prefix_ + kTrackFrame;
    transform.child_frame_id = frame_prefix_ + train_dynamics::VehicleName(i, board_->vehicles());
    transform.transform.translation.x = position;
    transform.transform.translation.z = (*elevation_)(position);
    transform.transform.rotation.y = std::sin(0.5 * nose_down);
    transform.transform.rotation.w = std::cos(0.5 * nose_down);
    transforms.push_back(transform);
  }
  if (!transforms.empty()) transforms_.sendTransform(transforms);
}

}  // namespace train_brake_rviz
