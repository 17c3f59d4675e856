#include "wagon_node/wagon_node.h"

#include <ros/ros.h>

#include "train_console/console.h"
#include "train_dynamics/train/ranks.h"

namespace wagon_node {
namespace {

using train_console::Presentable;

constexpr double kTick = 0.25;              // [s] between two checks for a master, while there are no calls
constexpr int kQueue = 100;                 // one second of simulated time
constexpr double kQuestionsPerTimeout = 3;  // to the ROS master, by a node that waits for its first run

std::string CallerOf(const ros::M_string& connection_header) {
  const auto caller = connection_header.find("callerid");
  return caller == connection_header.end() ? "an unnamed caller" : caller->second;
}

}  // namespace

WagonOptions WagonOptions::FromParameters(train_node::NodeParameters& parameters) {
  WagonOptions options;
  options.threads = parameters.Integer("threads", options.threads, 1);
  options.master_timeout_s = parameters.NonNegative("master_timeout_s", options.master_timeout_s);
  options.shared_memory = parameters.Flag("shared_memory", options.shared_memory);
  parameters.ThrowIfWrong();
  return options;
}

WagonNode::WagonNode(const WagonOptions& options)
    : private_("~"),
      server_(options.threads),
      last_contact_(Clock::now()),
      next_question_(last_contact_),
      timeout_(options.master_timeout_s),
      may_share_memory_(options.shared_memory) {
  ros::AdvertiseServiceOptions configure;
  configure.initBySpecType<ConfigureSpec>("configure", [this](ConfigureCall& call) { return Configure(call); });
  configure.callback_queue = &queue_;
  configure_ = private_.advertiseService(configure);

  step_ = std::make_unique<StepService>(private_.resolveName("step"),
                                        [this](std::uint8_t* request, std::uint32_t size,
                                               std::vector<std::uint8_t>& reply) { Step(request, size, reply); });
  constexpr std::chrono::seconds kPeriod(10);  // rare: there may be hundreds of nodes for one ROS master
  registration_ = std::make_unique<train_node::RegistrationWatch>(
      kPeriod,
      std::map<std::string, std::string>{{configure_.getService(), ""}, {private_.resolveName("step"), step_->uri()}});
}

void WagonNode::Run() {
  while (ros::ok() && !IsLeftAlone()) ServeSlot();
  // Their threads end before what they use is destroyed.
  registration_.reset();
  step_.reset();
  ros::shutdown();
}

bool WagonNode::Configure(ConfigureCall& call) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::string caller = CallerOf(*call.connection_header);
  const boost::shared_ptr<const ros::M_string> session = session_.lock();
  server_.Configure(*call.request, session && CallerOf(*session) != caller, *call.response);
  if (!call.response->ok) {
    ROS_WARN("refused to be configured by %s: %s", Presentable(caller).c_str(),
             Presentable(call.response->message).c_str());
    return true;
  }
  UseSlot(*call.request);
  call.response->memory_used = slot_ != nullptr;
  session_ = call.connection_header;
  last_contact_ = Clock::now();
  publishers_.clear();
  for (const train_brake_msgs::WagonState& detail : call.response->record.details) {
    const std::string name =
        train_dynamics::VehicleName(static_cast<int>(detail.vehicle) - 1, server_.vehicles_in_train());
    publishers_[detail.vehicle] = node_.advertise<train_brake_msgs::WagonState>(name + "/state", kQueue, true);
  }
  ROS_DEBUG("configured by %s: %s", Presentable(caller).c_str(), call.response->message.c_str());
  Publish(call.response->record);
  return true;
}

void WagonNode::Step(std::uint8_t* request, std::uint32_t size, std::vector<std::uint8_t>& reply) {
  const std::lock_guard<std::mutex> lock(mutex_);
  train_brake_msgs::ReadMessage(request, size, request_);
  const train_brake_msgs::StepResponse& response = Serve(request_);
  if (response.ok) last_contact_ = Clock::now();
  train_brake_msgs::AppendMessage(response, reply);
}

const train_brake_msgs::StepResponse& WagonNode::Serve(const train_brake_msgs::StepRequest& request) {
  const train_brake_msgs::StepResponse& response = server_.Step(request);
  if (response.ok) {
    Publish(response.record);
  } else {
    ROS_WARN("refused a step: %s", Presentable(response.message).c_str());
  }
  return response;
}

/// Takes the offer of a master that has just configured this node, if it can.
void WagonNode::UseSlot(const train_brake_msgs::ConfigureRequest& offer) {
  const std::shared_ptr<SharedSlot> old = std::move(slot_);
  slot_ = nullptr;
  try {
    if (offer.memory_pid != 0 && may_share_memory_) slot_ = std::make_shared<SharedSlot>(offer);
  } catch (const std::exception& e) {
    ROS_DEBUG("shares no memory with the master: %s", e.what());
  }
  if (old != nullptr) old->Wake();
  configured_.notify_one();
}

/// Serves the calls in the slot until none has arrived for a tick.
void WagonNode::ServeSlot() {
  std::unique_lock<std::mutex> lock(mutex_);
  const std::shared_ptr<SharedSlot> slot = slot_;
  if (slot == nullptr) {
    configured_.wait_for(lock, std::chrono::duration<double>(kTick));
    return;
  }
  const auto is_called = [&] {
    lock.unlock();
    const bool is_there = slot->Wait(kTick);
    lock.lock();
    return is_there && slot == slot_;  // the node may have been configured once more
  };
  // Where many ranks share a core, each exchange finds what it touches in no cache: it asks roscpp now and then only.
  constexpr unsigned kExchangesPerQuestion = 4;
  unsigned served = 0;
  for (; is_called() && (served % kExchangesPerQuestion != 0 || ros::ok()); ++served) {
    try {
      slot->Read(request_);
      slot->Reply(Serve(request_));
    } catch (const std::exception& e) {
      train_brake_msgs::StepResponse refusal;
      refusal.message = std::string("the request cannot be read: ") + e.what();
      slot->Reply(refusal);
    }
  }
  if (served > 0) last_contact_ = Clock::now();
}

void WagonNode::Publish(const train_brake_msgs::RankRecord& record) {
  for (const train_brake_msgs::WagonState& detail : record.details) publishers_[detail.vehicle].publish(detail);
}

bool WagonNode::IsLeftAlone() {
  const Clock::time_point now = Clock::now();
  std::unique_lock<std::mutex> lock(mutex_);
  const bool has_run = server_.run_id() != 0;
  if (!session_.expired()) last_contact_ = now;
  if (!has_run && now >= next_question_) {
    next_question_ = now + std::chrono::duration_cast<Clock::duration>(timeout_ / kQuestionsPerTimeout);
    lock.unlock();  // the answer may take long
    const bool is_there = ros::master::check();
    lock.lock();
    if (is_there) last_contact_ = now;
  }
  if (timeout_.count() <= 0.0 || now - last_contact_ <= timeout_) return false;
  ROS_WARN("%s has been gone for %.1f s: this wagon node leaves", has_run ? "the train's master" : "the ROS master",
           timeout_.count());
  return true;
}

}  // namespace wagon_node
