/// Own vehicles in a train, in C++: point masses with friction brakes, as own_vehicle in Python, and with snapshots, so
/// that the train's master can bring a lost node back and leave checkpoints. See docs/own_vehicle.md.
#include <ros/ros.h>
#include <train_brake_msgs/Configure.h>
#include <train_brake_msgs/Step.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace {

using train_brake_msgs::Configure;
using train_brake_msgs::ConfigureRequest;
using train_brake_msgs::Step;

bool AreFinite(const std::vector<double>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
}

class OwnVehicles {
 public:
  explicit OwnVehicles(const ros::NodeHandle& own) { own.getParam("brake_n_per_pa", brake_n_per_pa_); }

  bool OnConfigure(Configure::Request& request, Configure::Response& answer) {
    answer.protocol_version = ConfigureRequest::PROTOCOL_VERSION;
    if (request.protocol_version != ConfigureRequest::PROTOCOL_VERSION) {
      answer.message = "another version of the protocol";
      return true;
    }
    run_id_ = request.run_id;
    next_ = request.exchange;
    mass_kg_ = request.mass_kg;
    displacement_m_.assign(request.vehicle_count, 0.0);
    velocity_mps_ = request.speed_mps;
    if (!request.snapshot.empty() && !Restore(request.snapshot)) {
      answer.message = "the snapshot is not one of these vehicles";
      return true;
    }
    answer.ok = true;
    answer.gives_snapshots = true;
    answer.head_displacement_m = displacement_m_;
    answer.head_velocity_mps = velocity_mps_;
    return true;
  }

  bool OnStep(Step::Request& request, Step::Response& answer) {
    answer.exchange = request.exchange;
    if (request.run_id != run_id_ || (request.exchange != next_ && request.exchange + 1 != next_)) {
      answer.message = "this is not the next exchange of this run";
      return true;
    }
    if (!AreFinite(request.coupler_force_n) || !AreFinite(request.cylinder_pressure_pa)) {
      answer.message = "the loads are not finite";
      return true;
    }
    if (request.exchange == next_) {  // else the last one: the same reply again, nothing moves
      for (std::size_t i = 0; i < mass_kg_.size(); ++i) {
        const double pull_n = request.coupler_force_n[i] - request.coupler_force_n[i + 1];
        Move(i, pull_n, brake_n_per_pa_ * request.cylinder_pressure_pa[i], request.dt_s, request.steps);
      }
      ++next_;
    }
    answer.ok = true;
    answer.head_displacement_m = displacement_m_;
    answer.head_velocity_mps = velocity_mps_;
    if (request.snapshot) answer.snapshot = Snapshot();
    return true;
  }

 private:
  void Move(std::size_t i, double pull_n, double brake_n, double dt_s, unsigned steps) {
    for (unsigned step = 0; step < steps; ++step) {
      const double free_mps = velocity_mps_[i] + dt_s * pull_n / mass_kg_[i];  // without the brake
      const double speed_mps = std::max(std::abs(free_mps) - dt_s * brake_n / mass_kg_[i], 0.0);
      const double now_mps = std::copysign(speed_mps, free_mps);
      displacement_m_[i] += dt_s * (velocity_mps_[i] + now_mps) / 2.0;
      velocity_mps_[i] = now_mps;
    }
  }

  /// The state as bytes, in a format of this program only.
  std::vector<std::uint8_t> Snapshot() const {
    const std::size_t half = displacement_m_.size() * sizeof(double);
    std::vector<std::uint8_t> bytes(2 * half);
    std::memcpy(bytes.data(), displacement_m_.data(), half);
    std::memcpy(bytes.data() + half, velocity_mps_.data(), half);
    return bytes;
  }
  bool Restore(const std::vector<std::uint8_t>& bytes) {
    const std::size_t half = displacement_m_.size() * sizeof(double);
    if (bytes.size() != 2 * half) return false;
    std::memcpy(displacement_m_.data(), bytes.data(), half);
    std::memcpy(velocity_mps_.data(), bytes.data() + half, half);
    return true;
  }

  double brake_n_per_pa_ = 0.2;  ///< retarding force over cylinder pressure
  std::uint64_t run_id_ = 0, next_ = 0;
  std::vector<double> mass_kg_, displacement_m_, velocity_mps_;
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "own_vehicle");
  ros::NodeHandle own("~");
  OwnVehicles vehicles(own);
  const ros::ServiceServer step = own.advertiseService("step", &OwnVehicles::OnStep, &vehicles);
  const ros::ServiceServer configure = own.advertiseService("configure", &OwnVehicles::OnConfigure, &vehicles);
  ros::spin();
}
