#pragma once

#include <train_brake_msgs/Configure.h>
#include <train_brake_msgs/Step.h>

#include <cstdint>
#include <memory>
#include <string>

namespace wagon_node {

/// Handles the requests of Configure.srv and Step.srv in a wagon node: checks each, moves the vehicles, keeps the last
/// reply. Depends on the messages, but not on sockets or nodes.
///
///   request     | no run yet     | run A, whose next exchange is k           | from another run
///   ------------+----------------+-------------------------------------------+-------------------------------
///   Configure   | starts the run | k = 0 or `again`: starts again;           | refused while A is driven,
///               |                | else refused                              | else starts the other run
///   Step k      | refused        | moves the vehicles                        | refused
///   Step k - 1  | refused        | the same reply again, nothing moves;      | refused
///               |                | with other inputs refused                 |
///   other Step  | refused        | refused, with both numbers                | refused
///
/// A refusal is a reply with ok = false and a message for people; it leaves the run and its vehicles as they
/// are; it does not disclose the run's id, which only its master shall know. The services' comments list what else is
/// refused, and in which order.
class WagonServer {
 public:
  /// @param threads  that share the vehicles; any number gives the same bits
  explicit WagonServer(int threads);
  ~WagonServer();

  /// @param driven  whether another node drives the present run: the connection that configured it is open
  void Configure(const train_brake_msgs::ConfigureRequest& request, bool driven,
                 train_brake_msgs::ConfigureResponse& response);

  /// @return valid until the next call
  const train_brake_msgs::StepResponse& Step(const train_brake_msgs::StepRequest& request);

  std::uint64_t run_id() const;   ///< 0: no run yet
  int vehicles_in_train() const;  ///< of the run

 private:
  struct Run;

  std::unique_ptr<Run> Begin(const train_brake_msgs::ConfigureRequest& request, bool driven,
                             std::uint64_t digest) const;
  std::string WhyNot(const train_brake_msgs::StepRequest& request) const;

  const int threads_;
  std::unique_ptr<Run> run_;
  train_brake_msgs::StepResponse refusal_;
};

}  // namespace wagon_node
