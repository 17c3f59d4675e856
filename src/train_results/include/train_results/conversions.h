#pragma once

#include <std_msgs/String.h>
#include <train_brake_msgs/BrakePressures.h>
#include <train_brake_msgs/DriverCommand.h>
#include <train_brake_msgs/DriverView.h>
#include <train_brake_msgs/EnergyLedger.h>
#include <train_brake_msgs/GivenCommand.h>
#include <train_brake_msgs/InTrainForces.h>
#include <train_brake_msgs/Slides.h>
#include <train_brake_msgs/TrainState.h>
#include <train_brake_msgs/WagonState.h>

#include "train_dynamics/train/ranks.h"
#include "train_dynamics/train/train_master.h"
#include "train_results/message_views.h"

/// Converts records of the physics to messages. A message keeps its memory from record to record.
namespace train_results {

void Convert(const train_dynamics::TrainRecord& record, train_brake_msgs::TrainState& message);
void Convert(const train_dynamics::TrainRecord& record, train_brake_msgs::InTrainForces& message);
void Convert(const train_dynamics::TrainRecord& record, train_brake_msgs::BrakePressures& message);
void Convert(const train_dynamics::TrainRecord& record, train_brake_msgs::Slides& message);
/// Views of a record, which must outlive them.
void Convert(const train_dynamics::TrainRecord& record, TrainStateView& view);
void Convert(const train_dynamics::TrainRecord& record, InTrainForcesView& view);
void Convert(const train_dynamics::TrainRecord& record, BrakePressuresView& view);
/// Of a record with a ledger.
void Convert(const train_dynamics::TrainRecord& record, train_brake_msgs::EnergyLedger& message);

void Convert(const train_dynamics::TrainRecord& record, const train_dynamics::WagonDetail& detail,
             train_brake_msgs::WagonState& message);

/// @param time_s  of the first record after it
void Convert(const train_dynamics::GivenCommand& given, double time_s, train_brake_msgs::GivenCommand& message);

void Convert(const train_dynamics::DriverView& view, train_brake_msgs::DriverView& message);

/// A command for the start of an exchange, from a message.
/// @throws std::invalid_argument if the kind is unknown, or its number is missing
train_dynamics::DriverCommand CommandOf(const train_brake_msgs::DriverCommand& message, std::uint64_t exchange);

/// Topic of the commands that were given to the running train, in its namespace.
inline constexpr const char* kGivenTopic = "driver/given";

/// Topic of the scenario, in the namespace of the train; once in a run.
inline constexpr const char* kScenarioTopic = "scenario";

/// "# train_brake VERSION": the first line of each scenario that this program writes.
std::string VersionLine();

/// The scenario with everything resolved, as YAML that can be run again, after VersionLine: for viewers of a run or of
/// a bag.
std_msgs::String ScenarioMessage(const train_dynamics::ScenarioParams& scenario);

}  // namespace train_results
