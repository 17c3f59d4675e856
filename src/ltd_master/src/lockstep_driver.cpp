#include "ltd_master/lockstep_driver.h"

#include <fmt/format.h>
#include <ros/console.h>
#include <ros/master.h>
#include <ros/names.h>
#include <ros/service_manager.h>
#include <ros/service_traits.h>
#include <ros/this_node.h>

#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "ltd_master/patience.h"
#include "ltd_master/ranks/rank_caller.h"

namespace ltd_master {
namespace {

using train_brake_msgs::Drive;

constexpr double kHandshake = 1.0;         // [s] for a node that has advertised to accept a connection
constexpr double kSecondsPerReport = 5.0;  // on a driver that has not started yet
constexpr std::chrono::milliseconds kRetry(100);

const char* ConsequenceOf(OnLostDriver on_lost) {
  switch (on_lost) {
    case OnLostDriver::kEmergency:
      return "The emergency brake is applied.";
    case OnLostDriver::kHold:
      return "The train continues with the driver's last commands.";
    case OnLostDriver::kStop:
      break;
  }
  return "The run ends.";
}

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Drivers that may have been started in another namespace or under another name, as a clause; empty: none.
std::string ServedElsewhere() {
  const std::string end = "/drive";
  XmlRpc::XmlRpcValue request, response, state;  // publishers, subscribers, services; of each [name, [nodes]]
  request[0] = ros::this_node::getName();
  if (!ros::master::execute("getSystemState", request, response, state, false) || state.size() < 3) return "";
  for (int i = 0; i < state[2].size(); ++i) {
    const std::string service = state[2][i][0];
    if (EndsWith(service, end))
      return fmt::format(", but {} is: for that driver say driver:={}", service,
                         service.substr(0, service.size() - end.size()));
  }
  return "";
}

}  // namespace

LockstepDriver::LockstepDriver(LockstepDriverOptions options, std::uint64_t run_id, double exchange_interval_s)
    : options_(std::move(options)) {
  options_.node = ros::names::resolve(options_.node);
  const double exchanges = options_.control_period_s / exchange_interval_s;
  if (!(exchanges > 0.5 && std::abs(exchanges - std::round(exchanges)) < 1e-6)) {
    throw std::invalid_argument(
        fmt::format("parameter control_period_s must be a multiple of the exchange interval, {:g} s, got {:g}",
                    exchange_interval_s, options_.control_period_s));
  }
  exchanges_ = static_cast<std::uint64_t>(std::lround(exchanges));
  call_.request.protocol_version = train_brake_msgs::DriveRequest::PROTOCOL_VERSION;
  call_.request.run_id = run_id;
  call_.request.control_period_s = options_.control_period_s;
}

void LockstepDriver::Connect() {
  const std::string service = options_.node + "/drive";
  const auto start = std::chrono::steady_clock::now();
  double next_report_s = kSecondsPerReport;
  while (true) {
    bool is_advertised = true;
    std::string why_not;
    std::string host;
    std::uint32_t port = 0;
    try {
      if (ros::ServiceManager::instance()->lookupService(service, host, port)) {
        link_ = std::make_unique<ServiceLink>(service, host, port, ros::service_traits::md5sum<Drive>(), kHandshake);
        return;
      }
      is_advertised = false;
      why_not = ros::master::check() ? "is not advertised" : WhyNotFound();
    } catch (const LinkRefused& e) {
      throw DriverFailure(fmt::format("the driver {} cannot be asked: {}", options_.node, e.what()));
    } catch (const LinkError& e) {
      why_not = e.what();
    }
    if (options_.interrupted()) throw WaitInterrupted();
    const double waited_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const bool in_vain = options_.start_timeout_s > 0.0 && waited_s > options_.start_timeout_s;
    if (in_vain || waited_s > next_report_s) {
      if (!is_advertised && ros::master::check()) why_not += ServedElsewhere();
      if (in_vain)
        throw DriverFailure(fmt::format("the driver {} is missing after {:.0f} s: its service {} {}", options_.node,
                                        waited_s, service, why_not));
      ROS_WARN("waiting for %.0f s already for the driver %s: its service %s %s", waited_s, options_.node.c_str(),
               service.c_str(), why_not.c_str());
      next_report_s += kSecondsPerReport;
    }
    std::this_thread::sleep_for(kRetry);
  }
}

LockstepDriver::Commands LockstepDriver::Ask(const train_brake_msgs::DriverView& view) {
  if (link_ == nullptr) Connect();
  call_.request.view = view;
  call_.request.exchange = view.exchange;
  try {
    Call(view.exchange);
  } catch (const WaitInterrupted&) {
    throw;
  } catch (const std::exception& e) {  // of the link, or of an answer that cannot be read
    Lose(view.exchange, e.what());
    return {};
  }
  const train_brake_msgs::DriveResponse& answer = call_.response;
  if (answer.protocol_version != train_brake_msgs::DriveRequest::PROTOCOL_VERSION) {
    throw DriverFailure(fmt::format(
        "the master speaks version {} of Drive.srv, the driver {} version {}: both must be of the same build",
        std::uint32_t{train_brake_msgs::DriveRequest::PROTOCOL_VERSION}, options_.node, answer.protocol_version));
  }
  if (!answer.ok) {
    Lose(view.exchange, answer.message.empty() ? "gives up" : "gives up: " + answer.message);
  } else if (answer.exchange != view.exchange) {
    Lose(view.exchange, fmt::format("answered exchange {}", answer.exchange));
  }
  call_.request.refused.clear();
  return IsLost() ? Commands() : answer.commands;
}

void LockstepDriver::Call(std::uint64_t exchange) {
  link_->ExpectSilence();
  link_->Send(call_.request);
  Patience patience(options_.deadline_s, options_.interrupted);
  while (!link_->Receive(call_.response)) {
    link_->Wait(Patience::kCheckPeriod);
    const bool in_time = patience.Look([&](double waited_s) {
      ROS_WARN("exchange %lu: waiting for %.0f s already for the driver %s", exchange, waited_s, options_.node.c_str());
    });
    if (!in_time) throw LinkError(fmt::format("no answer within {:g} s", options_.deadline_s));
  }
  if (patience.has_warned()) ++late_answers_;
}

void LockstepDriver::Lose(std::uint64_t exchange, const std::string& why) {
  link_.reset();
  lost_ = fmt::format("{}, exchange {}: {}", options_.node, exchange, why);
  if (options_.on_lost == OnLostDriver::kStop) throw DriverFailure("the driver is lost: " + lost_);
  ROS_WARN("the driver is lost: %s. %s", lost_.c_str(), ConsequenceOf(options_.on_lost));
}

void LockstepDriver::Refuse(const std::string& sentence) {
  if (!call_.request.refused.empty()) call_.request.refused += "\n";
  call_.request.refused += sentence;
}

}  // namespace ltd_master
