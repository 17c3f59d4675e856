#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <train_brake_msgs/GiveCommand.h>
#include <train_brake_msgs/GivenCommand.h>
#include <train_brake_msgs/SetRealTimeFactor.h>
#include <train_brake_msgs/StepExchanges.h>

#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ltd_master/exchange_statistics.h"
#include "ltd_master/live_commands.h"
#include "ltd_master/live_topics.h"
#include "ltd_master/lockstep_driver.h"
#include "ltd_master/ranks/ros_transport.h"
#include "ltd_master/record_topic.h"
#include "ltd_master/run_control.h"
#include "ltd_master/simulated_clock.h"
#include "train_dynamics/config/load_scenario.h"
#include "train_node/node_parameters.h"
#include "train_node/registration.h"
#include "train_results/conversions.h"
#include "train_results/run_output.h"
#include "train_run/progress.h"
#include "train_run/train_run.h"

namespace ltd_master {

/// The private parameters of the node; launch/train.launch documents them.
struct MasterOptions {
  std::string scenario;
  int vehicles = 0;          ///< number of vehicles that the launch file expects; 0 = any
  int ranks = 0;             ///< wagon nodes; 0 = the vehicles are in the master's own process
  std::string nodes;         ///< wagon nodes that the user requested from the launch file; "auto" or empty: any number
  bool global_clock = true;  ///< this train's time is also that of /clock
  std::vector<std::string> overrides;
  train_results::OutputOptions output;
  std::string resume;  ///< folder of a run to resume from its checkpoint
  double real_time_factor = 0.0;
  bool start_paused = false;
  double startup_timeout_s = 60.0;
  double exchange_timeout_s = 30.0;
  bool recover = true;  ///< bring lost wagon nodes back
  double recovery_timeout_s = 60.0;
  bool shared_memory = true;
  LockstepDriverOptions driver;

  /// @param train_namespace  of the node
  /// @throws std::invalid_argument if parameters are wrong or unknown; names all of them
  static MasterOptions FromParameters(train_node::NodeParameters& parameters, const std::string& train_namespace);
};

/// The master of a train as a ROS node: runs it once, publishes and records it, and can be paused.
///
///   publishes   state  in_train_forces  brake_pressures  energy_ledger  (every record)   /diagnostics
///               clock, /clock (see SimulatedClock)
///               scenario (once, with everything resolved)   live/... (see LiveTopics)
///               driver/given (commands that took effect)
///   subscribes  driver/command (see LiveCommands)
///   services    driver/give   ~pause  ~resume  ~step  ~set_real_time_factor   ~identify (what runs here, since when)
class MasterNode {
 public:
  MasterNode(const MasterOptions& options, ros::NodeHandle node, ros::NodeHandle own);

  /// From time 0 to the end. @return the process's exit code
  int Run();

 private:
  void TellWhatIsNotUsed() const;
  std::unique_ptr<train_dynamics::Transport> MakeTransport();
  std::unique_ptr<RosTransport> MakeRosTransport(std::vector<train_dynamics::Rank> ranks) const;
  std::unique_ptr<LockstepDriver> MakeDriver();
  /// Paced by control_, with diagnostics each second. @throws WaitInterrupted, RankFailure, DriverFailure
  void Go(train_run::TrainRun& run);
  /// Gives the drivers' commands for the start of the next exchange: live commands first, then the driver in lockstep.
  void GiveCommands(train_run::TrainRun& run);
  void AskDriver(train_run::TrainRun& run);
  train_brake_msgs::DriverView ViewOf(train_run::TrainRun& run, bool sees_couplers) const;
  /// Publishes the driver's view for cabs: at most 20 times per second of wall time, and only while there are
  /// subscribers.
  void ShowView(train_run::TrainRun& run);
  void Publish(const train_dynamics::TrainRecord& record);
  /// During a pause: publishes what new subscribers need.
  void Settle(double simulated_s);
  void PublishDiagnostics(const train_dynamics::TrainMaster& master, const char* state);
  LiveTopics::Pace PaceNow() const;
  bool OnPause(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);
  bool OnResume(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);
  bool OnStep(train_brake_msgs::StepExchanges::Request& request, train_brake_msgs::StepExchanges::Response& response);
  bool OnSetRealTimeFactor(train_brake_msgs::SetRealTimeFactor::Request& request,
                           train_brake_msgs::SetRealTimeFactor::Response& response);
  void OnCommand(const train_brake_msgs::DriverCommand& message);
  bool OnGive(train_brake_msgs::GiveCommand::Request& request, train_brake_msgs::GiveCommand::Response& response);
  bool OnIdentify(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);

  using Clock = std::chrono::steady_clock;

  MasterOptions options_;
  Clock::time_point finishing_until_;  ///< until then, an interruption does not end a wait
  std::optional<train_results::ResumedRun> resumed_;
  train_dynamics::config::LoadedScenario scenario_;
  RunControl control_;
  std::uint64_t run_id_;
  RosTransport* ranks_ = nullptr;           ///< null: no wagon nodes
  std::unique_ptr<LockstepDriver> driver_;  ///< null: no driver in lockstep
  ExchangeStatistics statistics_;
  std::vector<unsigned> last_count_;  ///< [rank] how often it was the last to reply
  unsigned late_exchanges_ = 0;
  double real_time_factor_ = 0.0;  ///< over the last second of wall time
  std::atomic<double> simulated_s_{0.0};

  const ros::WallTime started_ = ros::WallTime::now();
  LiveTopics live_;
  SimulatedClock clock_;
  RecordTopic<train_brake_msgs::TrainState> state_topic_;
  RecordTopic<train_brake_msgs::InTrainForces> forces_topic_;
  RecordTopic<train_brake_msgs::BrakePressures> pressures_topic_;
  LiveCommands commands_;
  ros::Subscriber command_subscriber_;
  ros::Publisher given_publisher_, view_publisher_;
  Clock::time_point next_view_;
  ros::Publisher ledger_publisher_, slides_publisher_, scenario_publisher_, diagnostics_publisher_;
  std::vector<ros::ServiceServer> services_;
  train_brake_msgs::TrainState state_;
  train_brake_msgs::InTrainForces forces_;
  train_brake_msgs::BrakePressures pressures_;
  train_brake_msgs::EnergyLedger ledger_;
  train_brake_msgs::Slides slides_;
  std::unique_ptr<train_node::RegistrationWatch> registration_;
};

}  // namespace ltd_master
