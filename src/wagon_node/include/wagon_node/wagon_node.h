#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>
#include <train_brake_msgs/Configure.h>
#include <train_brake_msgs/Step.h>

#include <boost/weak_ptr.hpp>
#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>

#include "train_node/node_parameters.h"
#include "train_node/registration.h"
#include "wagon_node/inline_callback_queue.h"
#include "wagon_node/shared_slot.h"
#include "wagon_node/step_service.h"
#include "wagon_node/wagon_server.h"

namespace wagon_node {

/// The private parameters of the node.
struct WagonOptions {
  int threads = 1;
  double master_timeout_s = 8.0;  ///< leave after so long without a master; 0: never
  bool shared_memory = true;      ///< share memory with a master on the same machine

  /// @throws std::invalid_argument if parameters are wrong or unknown; names all of them
  static WagonOptions FromParameters(train_node::NodeParameters& parameters);
};

/// A process of the distributed train. The train's master assigns its vehicles.
///
///   services    ~configure, ~step   see Configure.srv, Step.srv
///   publishes   wagon_NNN/state     its vehicles in full detail, at every record; in the node's namespace
///   parameters  see WagonOptions
///
/// Calls of ~step come by TCP or, if the master is on the same machine, through memory that it shares: those are
/// served by the thread that called Run().
///
/// The master counts as present while the connection over which it configured this node is open. This costs nothing to
/// monitor, and also holds for a master that is paused, stopped in a debugger or slow. A node that has not been
/// configured checks the ROS master instead. An accepted request is a sign of life, too.
class WagonNode {
 public:
  explicit WagonNode(const WagonOptions& options);
  /// Serves until the node is shut down or has been left alone.
  void Run();

 private:
  using Clock = std::chrono::steady_clock;
  using ConfigureCall =
      ros::ServiceSpecCallParams<train_brake_msgs::ConfigureRequest, train_brake_msgs::ConfigureResponse>;

  /// The callback of ~configure is also given the connection it came over.
  struct ConfigureSpec {
    using RequestType = train_brake_msgs::ConfigureRequest;
    using ResponseType = train_brake_msgs::ConfigureResponse;
    using RequestPtr = boost::shared_ptr<RequestType>;
    using ResponsePtr = boost::shared_ptr<ResponseType>;
    using CallbackType = boost::function<bool(ConfigureCall&)>;
    static bool call(const CallbackType& callback, ConfigureCall& params) { return callback(params); }
  };

  bool Configure(ConfigureCall& call);
  void Step(std::uint8_t* request, std::uint32_t size, std::vector<std::uint8_t>& reply);
  const train_brake_msgs::StepResponse& Serve(const train_brake_msgs::StepRequest& request);
  void UseSlot(const train_brake_msgs::ConfigureRequest& offer);
  void ServeSlot();
  void Publish(const train_brake_msgs::RankRecord& record);
  bool IsLeftAlone();

  InlineCallbackQueue queue_;
  ros::NodeHandle node_, private_;
  std::mutex mutex_;  ///< of what the threads of roscpp, of ~step and of Run() use
  WagonServer server_;
  std::shared_ptr<SharedSlot> slot_;  ///< null: the master's calls of ~step come by TCP only
  std::condition_variable configured_;
  train_brake_msgs::StepRequest request_;
  boost::weak_ptr<ros::M_string> session_;  ///< header of the connection that configured the present run
  Clock::time_point last_contact_;
  Clock::time_point next_question_;  ///< to the ROS master
  std::chrono::duration<double> timeout_;
  bool may_share_memory_;
  std::map<std::uint32_t, ros::Publisher> publishers_;  ///< by vehicle
  ros::ServiceServer configure_;
  std::unique_ptr<StepService> step_;
  std::unique_ptr<train_node::RegistrationWatch> registration_;
};

}  // namespace wagon_node
