// Requests of strangers between those of the master: whatever they hold, the run goes on as if they had not come.
//
// The input is a program. Each step begins with a byte that says who speaks: the master, or a stranger whose request is
// the master's next one with some fields replaced by what follows in the input.

#include <ros/serialization.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "fuzz.h"
#include "strict_config/writer.h"
#include "train_dynamics/config/load_scenario.h"
#include "wagon_node/wagon_server.h"

namespace {

using train_brake_build::fuzz::Require;
using train_brake_msgs::ConfigureRequest;
using train_brake_msgs::ConfigureResponse;
using train_brake_msgs::StepRequest;
using train_brake_msgs::StepResponse;

constexpr std::uint64_t kRun = 7234981734512349871;
constexpr std::uint32_t kVehicles = 3;

/// The input, value by value; zeros beyond its end.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  bool empty() const { return left_ == 0; }

  template <class T>
  T Take() {
    T value{};
    const std::size_t size = std::min(sizeof value, left_);
    std::memcpy(&value, data_, size);
    data_ += size;
    left_ -= size;
    return value;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

const ConfigureRequest& RightConfigure() {
  static const ConfigureRequest request = [] {
    const auto scenario = train_dynamics::config::LoadScenario(
        std::string(TRAIN_BRAKE_CONFIG_DIR) + "/scenarios/emergency.yaml",
        {"model=ltd", "detail_vehicles=[]",
         "train={name: t, connection: calibrated, consist: [{vehicle: ore_wagon, count: 3}]}", "brake=single_vehicle",
         "record_interval_s=0.002", "duration_s=2"});
    ConfigureRequest right;
    right.protocol_version = ConfigureRequest::PROTOCOL_VERSION;
    right.run_id = kRun;
    right.first_vehicle = 1;
    right.vehicle_count = kVehicles;
    right.scenario = strict_config::Write(scenario.params);
    right.scenario_digest = train_dynamics::TextDigest(right.scenario);
    return right;
  }();
  return request;
}

StepRequest RightStep(std::uint64_t exchange) {
  StepRequest request;
  request.run_id = kRun;
  request.exchange = exchange;
  request.dt_s = 0.001;
  request.steps = 1;
  request.record = request.ledger = exchange % 2 == 1;
  request.coupler_force_n.assign(kVehicles + 1, 1e4);
  request.cylinder_pressure_pa.assign(kVehicles, 1e5);
  return request;
}

void Spoil(Input& input, StepRequest& request) {
  const auto fields = input.Take<std::uint8_t>();
  if (fields & 1u) request.run_id = input.Take<std::uint64_t>();
  if (fields & 2u) request.exchange = input.Take<std::uint64_t>();
  if (fields & 4u) request.dt_s = input.Take<double>();
  if (fields & 8u) request.steps = input.Take<std::uint32_t>();
  if (fields & 16u) request.coupler_force_n.resize(input.Take<std::uint16_t>());
  if (fields & 32u) request.cylinder_pressure_pa.resize(input.Take<std::uint16_t>());
  if (fields & 64u && !request.coupler_force_n.empty()) request.coupler_force_n.back() = input.Take<double>();
  if (fields & 128u && !request.cylinder_pressure_pa.empty())
    request.cylinder_pressure_pa.front() = input.Take<double>();
}

void Spoil(Input& input, ConfigureRequest& request) {
  const auto fields = input.Take<std::uint8_t>();
  if (fields & 1u) request.protocol_version = input.Take<std::uint32_t>();
  if (fields & 2u) request.run_id = input.Take<std::uint64_t>();
  if (fields & 4u) request.first_vehicle = input.Take<std::uint32_t>();
  if (fields & 8u) request.vehicle_count = input.Take<std::uint32_t>();
  if (fields & 16u) request.scenario.resize(input.Take<std::uint16_t>(), 'x');
  if (fields & 32u) request.scenario_digest = input.Take<std::uint64_t>();
  if (fields & 64u) request.scenario_digest = train_dynamics::TextDigest(request.scenario);
}

/// The rules of Step.srv, once more. @param last  the request that led to exchange `next`, if that is not 0
bool MayStep(const StepRequest& request, std::uint64_t next, const StepRequest& last) {
  if (request.run_id != kRun) return false;
  if (next > 0 && request.exchange == next - 1) {
    return request.dt_s == last.dt_s && request.steps == last.steps &&
           request.coupler_force_n == last.coupler_force_n && request.cylinder_pressure_pa == last.cylinder_pressure_pa;
  }
  const auto all_finite = [](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  };
  return request.exchange == next && request.dt_s == 0.001 && request.steps == 1 &&
         request.coupler_force_n.size() == kVehicles + 1 && request.cylinder_pressure_pa.size() == kVehicles &&
         all_finite(request.coupler_force_n) && all_finite(request.cylinder_pressure_pa);
}

template <class Message>
std::vector<std::uint8_t> Bytes(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  stream.next(message);
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kLongest = 1000;
  if (size > kLongest) return 0;
  wagon_node::WagonServer server(1), undisturbed(1);
  ConfigureResponse configured;
  for (wagon_node::WagonServer* each : {&server, &undisturbed}) {
    each->Configure(RightConfigure(), false, configured);
    Require(configured.ok, "the master may configure");
  }
  std::uint64_t next = 0;
  StepRequest last;
  const auto require_secret = [](std::uint64_t known_run, const std::string& message) {
    const bool is_told = message.find(std::to_string(kRun)) != std::string::npos;
    Require(known_run == kRun || !is_told, "the run id is never sent back");
  };
  const auto step = [&](const StepRequest& request) {
    const StepResponse reply = server.Step(request);
    Require(reply.ok == MayStep(request, next, last), "a request is refused if and only if the rules say so");
    require_secret(request.run_id, reply.message);
    if (!reply.ok) return;
    Require(Bytes(reply) == Bytes(undisturbed.Step(request)), "strangers have changed nothing");
    next = request.exchange + 1;
    last = request;
  };
  for (Input input(data, size); !input.empty();) {
    StepRequest request = RightStep(next);
    switch (input.Take<std::uint8_t>() % 4) {
      case 0:
        step(request);
        break;
      case 1:
        Spoil(input, request);
        step(request);
        break;
      case 3:  // the master again, unsure whether its last request arrived: a stranger's may have been it
        step(RightStep(next == 0 ? 0 : next - 1));
        break;
      default:
        ConfigureRequest configure = RightConfigure();
        Spoil(input, configure);
        if (next == 0 && configure.run_id == kRun) break;  // the master itself, which may begin again
        server.Configure(configure, true, configured);
        Require(!configured.ok, "a stranger may not take over a run");
        require_secret(configure.run_id, configured.message);
    }
  }
  step(RightStep(next));
  return 0;
}
