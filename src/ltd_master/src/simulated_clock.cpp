#include "ltd_master/simulated_clock.h"

#include <fmt/format.h>
#include <ros/master.h>
#include <ros/param.h>
#include <ros/this_node.h>
#include <rosgraph_msgs/Clock.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "train_node/running_node.h"

namespace ltd_master {
namespace {

constexpr const char* kGlobal = "/clock";
constexpr const char* kGlobalUse = "/use_sim_time";

/// Calls the ROS master with this node's name first; does not wait for one that is gone.
template <class... Arguments>
bool Call(const char* method, XmlRpc::XmlRpcValue& payload, const Arguments&... arguments) {
  XmlRpc::XmlRpcValue request, response;
  int i = 0;
  request[i++] = ros::this_node::getName();
  ((request[i++] = arguments), ...);
  return ros::master::execute(method, request, response, payload, false);
}

void SetTrue(const std::string& parameter) {
  XmlRpc::XmlRpcValue payload;
  Call("setParam", payload, parameter, XmlRpc::XmlRpcValue(true));
}

bool IsTrue(const std::string& parameter) {
  XmlRpc::XmlRpcValue payload;
  return Call("getParam", payload, parameter) && payload.getType() == XmlRpc::XmlRpcValue::TypeBoolean &&
         static_cast<bool>(payload);
}

void Delete(const std::string& parameter) {
  XmlRpc::XmlRpcValue payload;
  Call("deleteParam", payload, parameter);
}

/// Another node that publishes /clock and is alive; empty: none.
std::string OtherPublisher() {
  constexpr std::chrono::milliseconds kPatience(2000);
  XmlRpc::XmlRpcValue state;
  if (!Call("getSystemState", state)) return "";
  XmlRpc::XmlRpcValue& topics = state[0];
  // NOLINTNEXTLINE(modernize-loop-convert): XmlRpcValue has no iterators
  for (int i = 0; i < topics.size(); ++i) {
    if (static_cast<std::string>(topics[i][0]) != kGlobal) continue;
    for (int k = 0; k < topics[i][1].size(); ++k) {
      std::string node = topics[i][1][k];
      if (node == ros::this_node::getName()) continue;
      if (train_node::FindRunningNode(node, kPatience).state != train_node::RunningNode::State::kNone) return node;
    }
  }
  return "";
}

}  // namespace

SimulatedClock::SimulatedClock(ros::NodeHandle& train, bool is_global) : is_global_(is_global) {
  constexpr int kQueue = 100;  // one second
  if (is_global) {
    const std::string other = OtherPublisher();
    if (!other.empty()) {
      throw std::invalid_argument(
          fmt::format("{} publishes /clock already, and a ROS master has one simulated time: with global_clock:=false "
                      "this train's time is on {} only",
                      other, train.resolveName("clock")));
    }
    global_ = {kGlobalUse, train.advertise<rosgraph_msgs::Clock>(kGlobal, kQueue, true), IsTrue(kGlobalUse)};
  }
  own_ = {train.resolveName("use_sim_time"), train.advertise<rosgraph_msgs::Clock>("clock", kQueue, true), false};
  TellUse();
}

SimulatedClock::~SimulatedClock() {
  Delete(own_.use_parameter);
  if (is_global_ && !global_.was_used) Delete(global_.use_parameter);
}

void SimulatedClock::TellUse() const {
  SetTrue(own_.use_parameter);
  if (is_global_) SetTrue(global_.use_parameter);
}

void SimulatedClock::Show(double simulated_s) {
  constexpr double kPeriod = 0.01;
  const double tick = simulated_s / kPeriod;
  if (std::abs(tick - std::round(tick)) <= 1e-6 * std::max(1.0, tick)) Publish(simulated_s);
}

void SimulatedClock::Settle(double simulated_s) {
  if (simulated_s != last_s_) Publish(simulated_s);
}

void SimulatedClock::Publish(double simulated_s) {
  last_s_ = simulated_s;
  rosgraph_msgs::Clock clock;
  clock.clock.fromSec(simulated_s);
  if (clock.clock.isZero()) clock.clock.nsec = 1;
  own_.publisher.publish(clock);
  if (is_global_) global_.publisher.publish(clock);
}

}  // namespace ltd_master
