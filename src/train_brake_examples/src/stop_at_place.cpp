/// A driver in lockstep, in C++: stops the first vehicle's centre at a place with the air brake. See docs/driving.md.
///
///   needed deceleration    a = v^2 / (2 (place - position - v settle_s))
///
/// v settle_s is the distance that the train covers before a change of the brake has acted. The first reduction of the
/// brake pipe is made when a reaches `plan_mps2`. Afterwards it is deepened step by step, each when the train slows
/// down by less than a, and not before the step before it has had `settle_s` to act. A deeper reduction is never taken
/// back: a brake that releases step by step is not assumed. The stopping error is therefore the effect of one step too
/// many, or of a last step too late: with the freight train of config/scenarios/drive_and_stop.yaml 6 m beyond it from
/// 40 km/h, 23 m short of it from 60 km/h.
#include <ros/ros.h>
#include <train_brake_msgs/Drive.h>

#include <algorithm>
#include <limits>

namespace {

using train_brake_msgs::Drive;
using train_brake_msgs::DriveRequest;
using train_brake_msgs::DriverView;

class StopAtPlace {
 public:
  explicit StopAtPlace(const ros::NodeHandle& own) {
    if (!own.getParam("place_m", place_m_)) ROS_FATAL("the parameter place_m is missing: where to stop");
    own.getParam("plan_mps2", plan_mps2_);
    own.getParam("first_reduction_kpa", first_reduction_kpa_);
    own.getParam("step_kpa", step_kpa_);
    own.getParam("full_reduction_kpa", full_reduction_kpa_);
    own.getParam("settle_s", settle_s_);
  }

  bool Answer(Drive::Request& request, Drive::Response& answer) {
    answer.protocol_version = DriveRequest::PROTOCOL_VERSION;
    answer.exchange = request.exchange;
    answer.ok = request.protocol_version == DriveRequest::PROTOCOL_VERSION;
    if (!answer.ok) return true;
    if (request.run_id != run_id_) {
      run_id_ = request.run_id;
      reduction_kpa_ = 0.0;
      last_mps_ = request.view.speed_mps;
    }
    const DriverView& view = request.view;
    const double slowing_mps2 = (last_mps_ - view.speed_mps) / request.control_period_s;
    last_mps_ = view.speed_mps;
    const double left_m = place_m_ - view.position_m - view.speed_mps * settle_s_;
    const double needed_mps2 =
        left_m > 0.0 ? view.speed_mps * view.speed_mps / (2.0 * left_m) : std::numeric_limits<double>::infinity();
    if (view.speed_mps <= 0.0 || needed_mps2 < plan_mps2_) return true;
    if (reduction_kpa_ == 0.0) {
      if (view.effort_n > 0.0) Throttle(0.0, answer);
      Apply(first_reduction_kpa_, view.time_s, answer);
    } else if (view.time_s >= last_step_s_ + settle_s_ && slowing_mps2 < needed_mps2 &&
               reduction_kpa_ < full_reduction_kpa_) {
      Apply(std::min(reduction_kpa_ + step_kpa_, full_reduction_kpa_), view.time_s, answer);
    }
    return true;
  }

 private:
  void Apply(double reduction_kpa, double time_s, Drive::Response& answer) {
    train_brake_msgs::DriverCommand command;
    command.kind = "apply";
    command.reduction_kpa = reduction_kpa_ = reduction_kpa;
    last_step_s_ = time_s;
    answer.commands.push_back(command);
  }
  static void Throttle(double notch, Drive::Response& answer) {
    train_brake_msgs::DriverCommand command;
    command.kind = "throttle";
    command.notch = notch;
    answer.commands.push_back(command);
  }

  double place_m_ = 0.0;
  double plan_mps2_ = 0.2;
  double first_reduction_kpa_ = 100.0, step_kpa_ = 20.0, full_reduction_kpa_ = 150.0;  // [kPa] in total
  double settle_s_ = 6.0;
  std::uint64_t run_id_ = 0;
  double reduction_kpa_ = 0.0, last_step_s_ = 0.0, last_mps_ = 0.0;
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "stop_at_place");
  ros::NodeHandle own("~");
  StopAtPlace driver(own);
  const ros::ServiceServer service = own.advertiseService("drive", &StopAtPlace::Answer, &driver);
  ros::spin();
}
