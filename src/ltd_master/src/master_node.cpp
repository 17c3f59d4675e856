#include "ltd_master/master_node.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <random>
#include <sstream>
#include <stdexcept>

#include "ltd_master/ranks/mixed_transport.h"
#include "ltd_master/settings.h"
#include "train_console/console.h"
#include "train_dynamics/train/in_process_train.h"
#include "train_dynamics/train/ranks.h"
#include "train_node/caller.h"
#include "train_node/running_node.h"
#include "train_results/summary_text.h"
#include "train_run/exit_code.h"
#include "train_run/interrupt.h"

namespace ltd_master {
namespace {

using train_console::Presentable;
using train_dynamics::TrainMaster;
using train_dynamics::TrainRecord;

bool Ending() { return train_run::Interrupt() != 0 || !ros::ok(); }

std::vector<std::string> Words(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// "2026-11-28 09:30:00", as clocks on all machines of a train have it.
std::string UtcText(const ros::WallTime& time) {
  const auto seconds = static_cast<std::time_t>(time.sec);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[32];
  const std::size_t size = std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &parts);
  return {text, size};
}

/// Converts a record when the message is wanted.
template <class Message>
auto As(const TrainRecord& record, Message& message) {
  return [&record, &message]() -> const Message& {
    train_results::Convert(record, message);
    return message;
  };
}

template <class Response>
void Answer(const RunControl::Reply& reply, Response& response) {
  response.success = reply.success;
  response.message = reply.message;
}

constexpr int kQueue = 100;  // one second of simulated time

/// Unique, so that messages of a late process of another run are recognised; random, so that it cannot be guessed.
std::uint64_t NewRunId() {
  std::random_device random;
  return (static_cast<std::uint64_t>(random()) << 32 | random()) | 1u;
}

}  // namespace

MasterOptions MasterOptions::FromParameters(train_node::NodeParameters& parameters,
                                            const std::string& train_namespace) {
  using train_node::ExpandHome;
  MasterOptions options;
  options.resume = ExpandHome(parameters.Text("resume", ""));
  options.scenario = ExpandHome(parameters.Text("scenario", ""));
  options.vehicles = parameters.Integer("vehicles", 0, 0);
  options.ranks = parameters.Integer("ranks", 0, 0);
  options.nodes = parameters.Words("nodes");
  const bool is_number = options.nodes.find_first_not_of("0123456789") == std::string::npos;
  const bool is_zero = !options.nodes.empty() && options.nodes.find_first_not_of('0') == std::string::npos;
  if (is_zero || (!is_number && options.nodes != "auto"))
    parameters.Complain("nodes", "must be auto or a whole number >= 1");
  parameters.Integer("threads", 1, 1);  // of the wagon nodes, which roslaunch would start again and again
  const std::string settings = parameters.Text("set", "");
  const std::string model = parameters.Text("model", "");
  const double interval_s = parameters.NonNegative("exchange_interval_s", 0.0);
  const std::vector<std::string> detail = Words(parameters.Words("detail"));
  options.output.folder = ExpandHome(parameters.Text("out", ""));
  options.output.record_bag = parameters.Flag("record", true);
  options.output.checkpoint_interval_s = parameters.NonNegative("checkpoint_interval_s", 10.0);
  options.output.on_write_error = parameters.IsFirstOf("on_write_error", "stop", "go_on")
                                      ? train_results::OnWriteError::kStop
                                      : train_results::OnWriteError::kGoOn;
  options.output.complain = [](const std::string& what) { ROS_WARN("%s", Presentable(what).c_str()); };
  options.real_time_factor = parameters.NonNegative("real_time_factor", 0.0);
  options.start_paused = parameters.Flag("start_paused", false);
  options.startup_timeout_s = parameters.NonNegative("startup_timeout_s", 60.0);
  options.exchange_timeout_s = parameters.NonNegative("exchange_timeout_s", 30.0);
  options.recover = parameters.IsFirstOf("on_lost_node", "recover", "stop");
  options.recovery_timeout_s = parameters.NonNegative("recovery_timeout_s", 60.0);
  options.shared_memory = parameters.Flag("shared_memory", true);
  options.driver.node = parameters.Text("driver", "");
  options.driver.control_period_s = parameters.NonNegative("control_period_s", 0.1);
  options.driver.deadline_s = parameters.NonNegative("driver_timeout_s", 30.0);
  const std::string on_lost_driver = parameters.Choice("on_lost_driver", {"emergency", "hold", "stop"});
  options.driver.on_lost = on_lost_driver == "emergency" ? OnLostDriver::kEmergency
                           : on_lost_driver == "hold"    ? OnLostDriver::kHold
                                                         : OnLostDriver::kStop;
  options.driver.sight_m = parameters.NonNegative("driver_sight_m", 5000.0);
  options.driver.sees_couplers = parameters.Flag("driver_sees_couplers", false);
  options.driver.start_timeout_s = options.startup_timeout_s;
  const std::string global_clock = parameters.Choice("global_clock", {"auto", "true", "false"});
  options.global_clock =
      global_clock == "auto" ? SimulatedClock::OwnsGlobalClock(train_namespace) : global_clock == "true";
  parameters.ThrowIfWrong();
  if (options.scenario.empty() && options.resume.empty())
    throw std::invalid_argument("parameter scenario is missing: the scenario file to run");

  options.overrides = SplitSettings(settings);
  if (!model.empty()) options.overrides.push_back("model=" + model);
  if (interval_s > 0.0) options.overrides.push_back(fmt::format("exchange_interval_s={}", interval_s));
  if (!detail.empty()) options.overrides.push_back(fmt::format("detail_vehicles=[{}]", fmt::join(detail, ", ")));
  return options;
}

MasterNode::MasterNode(const MasterOptions& options, ros::NodeHandle node, ros::NodeHandle own)
    : options_(options),
      resumed_(options.resume.empty()
                   ? std::nullopt
                   : std::make_optional(train_results::LoadResumedRun(options.resume, options.overrides))),
      scenario_(resumed_ ? resumed_->scenario
                         : train_dynamics::config::LoadScenario(options.scenario, options.overrides)),
      control_(options.start_paused, options.real_time_factor),
      run_id_(NewRunId()),
      live_(node),
      clock_(node, options.global_clock),
      state_topic_(node, "state", kQueue),
      forces_topic_(node, "in_train_forces", kQueue),
      pressures_topic_(node, "brake_pressures", kQueue),
      commands_(scenario_.params) {
  for (const std::string& warning : scenario_.warnings) ROS_WARN("%s", Presentable(warning).c_str());
  const int vehicles = scenario_.consist.vehicles();
  if (options.vehicles != 0 && options.vehicles != vehicles) {
    throw std::invalid_argument(
        fmt::format("the launch file expects {} vehicles, but the train of {} has {}: launch "
                    "with vehicles:={}",
                    options.vehicles, resumed_ ? options.resume : options.scenario, vehicles, vehicles));
  }
  if (options.ranks < 0 || options.ranks > vehicles) {
    throw std::invalid_argument(
        fmt::format("parameter ranks must be in [0, {}], the number of vehicles, got {}", vehicles, options.ranks));
  }
  ledger_publisher_ = node.advertise<train_brake_msgs::EnergyLedger>("energy_ledger", kQueue, true);
  slides_publisher_ = node.advertise<train_brake_msgs::Slides>("slides", kQueue, true);
  scenario_publisher_ = node.advertise<std_msgs::String>(train_results::kScenarioTopic, 1, true);
  scenario_publisher_.publish(train_results::ScenarioMessage(scenario_.params));
  given_publisher_ = node.advertise<train_brake_msgs::GivenCommand>(train_results::kGivenTopic, kQueue, true);
  view_publisher_ = node.advertise<train_brake_msgs::DriverView>("live/driver_view", 1, true);
  command_subscriber_ = node.subscribe("driver/command", kQueue, &MasterNode::OnCommand, this);
  services_.push_back(node.advertiseService("driver/give", &MasterNode::OnGive, this));
  diagnostics_publisher_ = node.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10);
  services_.push_back(own.advertiseService("pause", &MasterNode::OnPause, this));
  services_.push_back(own.advertiseService("resume", &MasterNode::OnResume, this));
  services_.push_back(own.advertiseService("step", &MasterNode::OnStep, this));
  services_.push_back(own.advertiseService("set_real_time_factor", &MasterNode::OnSetRealTimeFactor, this));
  services_.push_back(own.advertiseService(train_node::kIdentifyService, &MasterNode::OnIdentify, this));
  TellWhatIsNotUsed();

  std::map<std::string, std::string> services;
  for (const ros::ServiceServer& service : services_) services[service.getService()] = "";
  constexpr std::chrono::seconds kPeriod(1);
  registration_ = std::make_unique<train_node::RegistrationWatch>(kPeriod, services, [this] { clock_.TellUse(); });
}

/// Logs the settings that this run does not use, and where its results go.
void MasterNode::TellWhatIsNotUsed() const {
  const int vehicles = scenario_.consist.vehicles();
  const bool is_2d = scenario_.params.model == train_dynamics::VehicleModel::kTwoD;
  if (is_2d && options_.vehicles == 0 && options_.ranks == 0) {
    ROS_WARN("all %d vehicles are in the master, on one core; vehicles:=%d puts them on wagon nodes", vehicles,
             vehicles);
  }
  if (options_.ranks > 0 && !scenario_.params.Uses(train_dynamics::VehicleModel::kTwoD)) {
    ROS_WARN(
        "no vehicle of this train is 2d: on %d wagon nodes it runs slower than in the master alone, which "
        "on_nodes:=false gives",
        options_.ranks);
  }
  if (!options_.nodes.empty() && options_.nodes != "auto" && options_.nodes != std::to_string(options_.ranks)) {
    ROS_WARN("nodes:=%s is not used: %s", Presentable(options_.nodes).c_str(),
             options_.ranks > 0
                 ? fmt::format("the train has {} vehicles and runs on {} wagon nodes", vehicles, options_.ranks).c_str()
                 : "all vehicles are in the master");
  }
  const LockstepDriverOptions& driver = options_.driver;
  const LockstepDriverOptions defaults;
  if (driver.node.empty() && (driver.control_period_s != defaults.control_period_s ||
                              driver.deadline_s != defaults.deadline_s || driver.on_lost != defaults.on_lost ||
                              driver.sight_m != defaults.sight_m || driver.sees_couplers != defaults.sees_couplers))
    ROS_WARN(
        "control_period, driver_timeout, on_lost_driver, driver_sight and driver_sees_couplers are not used: "
        "there is no driver in lockstep (driver:=NODE)");
  const std::string& folder = options_.output.folder.empty() ? options_.resume : options_.output.folder;
  if (folder.empty()) {
    ROS_INFO("no results are kept (out:=FOLDER keeps them)");
  } else {
    ROS_INFO("results go to %s", Presentable(std::filesystem::absolute(folder).lexically_normal().string()).c_str());
  }
}

std::unique_ptr<train_dynamics::Transport> MasterNode::MakeTransport() {
  const train_dynamics::ScenarioParams& scenario = scenario_.params;
  std::vector<train_dynamics::Rank> external = train_dynamics::ExternalRanks(scenario.train);
  std::unique_ptr<train_dynamics::Transport> built_in;
  if (options_.ranks == 0) {
    built_in = std::make_unique<train_dynamics::InProcessTransport>(scenario, scenario_.consist, 1, true);
  } else {
    auto ranks = MakeRosTransport(train_dynamics::SplitRanks(scenario_.consist.vehicles(), options_.ranks));
    ranks_ = ranks.get();
    last_count_.assign(ranks->ranks().size(), 0);
    built_in = std::move(ranks);
  }
  if (external.empty()) return built_in;
  return std::make_unique<MixedTransport>(std::move(built_in), MakeRosTransport(std::move(external)));
}

std::unique_ptr<RosTransport> MasterNode::MakeRosTransport(std::vector<train_dynamics::Rank> ranks) const {
  const train_dynamics::ScenarioParams& scenario = scenario_.params;
  RosTransportOptions transport;
  transport.start_timeout_s = options_.startup_timeout_s;
  transport.exchange_deadline_s = options_.exchange_timeout_s;
  transport.shared_memory = options_.shared_memory;
  transport.recover = options_.recover;
  transport.recovery_timeout_s = options_.recovery_timeout_s;
  constexpr double kSnapshotInterval = 1.0;  // [s] of simulated time
  constexpr double kMostExchanges = 1000.0;  // limits the loads kept since, and the repetition by a lost rank
  transport.snapshot_exchanges =
      std::lround(std::clamp(kSnapshotInterval / scenario.exchange_interval_s, 1.0, kMostExchanges));
  transport.interrupted = [this] { return Ending() && Clock::now() > finishing_until_; };
  return std::make_unique<RosTransport>(std::move(ranks), run_id_, scenario, transport);
}

std::unique_ptr<LockstepDriver> MasterNode::MakeDriver() {
  if (options_.driver.node.empty()) return nullptr;
  LockstepDriverOptions options = options_.driver;
  options.interrupted = [this] { return Ending() && Clock::now() > finishing_until_; };
  if (options.on_lost == OnLostDriver::kEmergency && !scenario_.params.pressure_table.empty()) {
    throw std::invalid_argument(
        "parameter on_lost_driver must be hold or stop: the pressures of the brake come from pressure_table, "
        "which obeys "
        "no emergency");
  }
  return std::make_unique<LockstepDriver>(options, run_id_, scenario_.params.exchange_interval_s);
}

int MasterNode::Run() {
  const train_dynamics::ScenarioParams& scenario = scenario_.params;
  driver_ = MakeDriver();
  const std::unique_ptr<train_results::RunOutput> output =
      resumed_ ? std::make_unique<train_results::RunOutput>(options_.output, *resumed_)
               : std::make_unique<train_results::RunOutput>(options_.output, scenario_.files, scenario);
  const std::unique_ptr<train_dynamics::Transport> transport = MakeTransport();
  train_run::TrainRun run(scenario, scenario_.consist, *transport, scenario_.pressures,
                          resumed_ ? &resumed_->checkpoint : nullptr, output.get());
  const TrainMaster& master = run.master();
  std::unique_ptr<train_run::Progress> progress;
  run.AddObserver([&](const TrainRecord& record) { Publish(record); });
  run.AddObserver([&](const TrainRecord& record) {
    if (progress == nullptr)
      progress = std::make_unique<train_run::Progress>(scenario.duration_s,
                                                       run.start_s());  // the start-up is over
    progress->Show(record.time_s, record.mean_speed_mps);
  });

  ros::AsyncSpinner spinner(4);  // steps and a pause may wait while another service is called
  spinner.start();
  std::string rank_fault;
  try {
    Go(run);
  } catch (const WaitInterrupted&) {  // for the reason that Ending gives
  } catch (const RankFailure& e) {
    if (!Ending()) rank_fault = e.what();
  } catch (const DriverFailure& e) {
    if (!Ending()) rank_fault = e.what();
  }
  control_.End();
  spinner.stop();
  LiveTopics::Pace pace = PaceNow();
  pace.state = train_brake_msgs::RunStatus::ENDED;
  live_.Settle(pace);

  if (progress != nullptr) progress->Finish();
  const double wall_s = progress == nullptr ? 0.0 : progress->WallSeconds();
  const std::string json = run.Finish(wall_s, rank_fault);
  for (const std::string& warning : run.Warnings()) ROS_WARN("%s", Presentable(warning).c_str());
  int exit_code = run.exit_code();
  if (exit_code != train_run::kFailure && !rank_fault.empty()) exit_code = train_run::kRankFailure;
  std::string fault = rank_fault.empty() ? run.fault() : rank_fault;
  if (exit_code == train_run::kFailure) fault = "the results could not be written: " + run.write_error();
  PublishDiagnostics(master, exit_code == train_run::kSuccess ? "complete" : "ended early");
  ros::WallDuration(0.2).sleep();  // the last messages are still being sent to subscribers
  train_console::Print("{}", train_results::SummaryText(json));
  if (exit_code == train_run::kFailure) train_console::Print("{}", json);  // the result may exist nowhere else
  train_console::FinishOutput();                                           // for people: the result is summary.json
  if (exit_code == train_run::kInterrupted) {
    ROS_WARN("interrupted at %.3f s of %g s", master.time_s(), scenario.duration_s);
  } else if (!fault.empty()) {
    ROS_FATAL("the run failed: %s", Presentable(fault).c_str());
  }
  return exit_code;
}

void MasterNode::Go(train_run::TrainRun& run) {
  constexpr std::chrono::seconds kPatience(2);
  const TrainMaster& master = run.master();
  simulated_s_ = run.start_s();
  Clock::time_point last_diagnostics = Clock::now();
  double simulated_then_s = run.start_s();
  train_run::RunHooks hooks;
  hooks.ends = [this, kPatience] {
    if (!Ending()) return false;
    finishing_until_ = Clock::now() + kPatience;
    return true;
  };
  hooks.admits = [&] {
    if (control_.Admit(master.time_s())) return true;
    Settle(master.time_s());
    return false;
  };
  hooks.begins = [&] { GiveCommands(run); };
  hooks.exchanged = [&](double wall_s) {
    statistics_.Add(wall_s);
    if (ranks_ != nullptr) {
      ++last_count_[ranks_->timing().last_rank];
      if (ranks_->timing().was_late) ++late_exchanges_;
    }
    simulated_s_ = master.time_s();
    control_.Completed(master.time_s());
  };
  hooks.turned = [&] {
    ShowView(run);
    const double elapsed_s = std::chrono::duration<double>(Clock::now() - last_diagnostics).count();
    if (elapsed_s < 1.0) return;
    real_time_factor_ = (master.time_s() - simulated_then_s) / elapsed_s;
    PublishDiagnostics(master, control_.paused() ? "paused" : "running");
    simulated_then_s = master.time_s();
    last_diagnostics = Clock::now();
  };
  run.Go(hooks, kPatience);
}

void MasterNode::GiveCommands(train_run::TrainRun& run) {
  const std::uint64_t exchange = run.master().exchange();
  for (const train_dynamics::DriverCommand& command : commands_.Take(exchange, run.master().patches())) {
    try {
      run.Command(command);
    } catch (const std::invalid_argument& e) {
      ROS_WARN("the command %s is not given: %s", command.Text().c_str(), Presentable(e.what()).c_str());
    }
  }
  if (driver_ != nullptr && driver_->IsDue(exchange)) AskDriver(run);
}

train_brake_msgs::DriverView MasterNode::ViewOf(train_run::TrainRun& run, bool sees_couplers) const {
  train_brake_msgs::DriverView view;
  train_results::Convert(run.View(options_.driver.sight_m, sees_couplers), view);
  const train_dynamics::Locomotives& locomotives = run.master().locomotives();
  if (locomotives.empty()) return view;
  const train_dynamics::TractionParams& lead = locomotives.traction(0);
  view.throttle_notches = lead.tractive_effort.throttle.Notches();
  view.dynamic_brake_notches = lead.dynamic_brake ? lead.dynamic_brake->Notches() : 0;
  return view;
}

void MasterNode::ShowView(train_run::TrainRun& run) {
  constexpr std::chrono::milliseconds kPeriod(50);
  const Clock::time_point now = Clock::now();
  if (now < next_view_) return;
  next_view_ = now + kPeriod;
  if (view_publisher_.getNumSubscribers() > 0) view_publisher_.publish(ViewOf(run, false));
}

void MasterNode::AskDriver(train_run::TrainRun& run) {
  const LockstepDriverOptions& options = driver_->options();
  const train_brake_msgs::DriverView view = ViewOf(run, options.sees_couplers);
  LockstepDriver::Commands commands = driver_->Ask(view);
  if (driver_->IsLost() && options.on_lost == OnLostDriver::kEmergency) {
    train_brake_msgs::DriverCommand command;
    if (!run.master().locomotives().empty()) {
      command.kind = "throttle";  // notch 0: the dynamic brake is off, too
      commands.push_back(command);
    }
    command.kind = "emergency";
    commands.push_back(command);
  }
  for (const train_brake_msgs::DriverCommand& message : commands) {
    try {
      run.Command(commands_.Judge(message, view.exchange));
    } catch (const std::invalid_argument& e) {
      ROS_WARN("exchange %lu: a command of the driver %s is refused: %s", view.exchange, driver_->name().c_str(),
               e.what());
      driver_->Refuse(e.what());
    }
  }
}

void MasterNode::Publish(const TrainRecord& record) {
  clock_.Show(record.time_s);
  state_topic_.Publish(As(record, state_));
  forces_topic_.Publish(As(record, forces_));
  pressures_topic_.Publish(As(record, pressures_));
  if (record.ledger) {
    train_results::Convert(record, ledger_);
    ledger_publisher_.publish(ledger_);
  }
  if (!record.slides.empty()) {
    train_results::Convert(record, slides_);
    slides_publisher_.publish(slides_);
  }
  for (const train_dynamics::GivenCommand& given : record.given) {
    train_brake_msgs::GivenCommand message;
    train_results::Convert(given, record.time_s, message);
    given_publisher_.publish(message);
  }
  live_.Show(record, PaceNow());
}

void MasterNode::Settle(double simulated_s) {
  live_.Settle(PaceNow());
  if (!control_.paused()) return;  // it only waits for its pace
  clock_.Settle(simulated_s);
  const std::optional<TrainRecord> last = live_.last();
  if (!last) return;
  state_topic_.Hold(As(*last, state_));
  forces_topic_.Hold(As(*last, forces_));
  pressures_topic_.Hold(As(*last, pressures_));
}

LiveTopics::Pace MasterNode::PaceNow() const {
  using train_brake_msgs::RunStatus;
  const std::uint8_t state = control_.paused() ? RunStatus::PAUSED : RunStatus::RUNNING;
  return {state, real_time_factor_, control_.real_time_factor()};
}

void MasterNode::PublishDiagnostics(const TrainMaster& master, const char* state) {
  diagnostic_msgs::DiagnosticArray array;
  array.header.stamp.fromSec(master.time_s());
  diagnostic_msgs::DiagnosticStatus status;
  status.level = late_exchanges_ > 0 ? diagnostic_msgs::DiagnosticStatus::WARN : diagnostic_msgs::DiagnosticStatus::OK;
  status.name = ros::this_node::getName() + ": lockstep";
  status.hardware_id = scenario_.params.name;
  status.message = state;
  const auto add = [&status](const char* key, const std::string& value) {
    diagnostic_msgs::KeyValue pair;
    pair.key = key;
    pair.value = value;
    status.values.push_back(pair);
  };
  add("simulated_s", fmt::format("{:.3f}", master.time_s()));
  add("real_time_factor", fmt::format("{:.2f}", real_time_factor_));
  add("exchange_p50_ms", fmt::format("{:.3f}", 1e3 * statistics_.Quantile(0.50)));
  add("exchange_p99_ms", fmt::format("{:.3f}", 1e3 * statistics_.Quantile(0.99)));
  if (commands_.count() > 0) {
    add("live_commands", std::to_string(commands_.count()));
    add("live_command_latency_max_exchanges", std::to_string(commands_.largest_latency()));
  }
  if (driver_ != nullptr) {
    add("driver", driver_->IsLost() ? "lost: " + driver_->lost() : driver_->name());
    add("driver_late_answers", std::to_string(driver_->late_answers()));
    if (driver_->IsLost()) status.level = diagnostic_msgs::DiagnosticStatus::WARN;
  }
  if (ranks_ != nullptr) {
    const auto slowest = std::max_element(last_count_.begin(), last_count_.end()) - last_count_.begin();
    add("ranks", std::to_string(last_count_.size()));
    add("slowest_rank", ranks_->ranks()[slowest].name);
    add("late_exchanges", std::to_string(late_exchanges_));
    add("recoveries", std::to_string(ranks_->recoveries()));
  }
  array.status.push_back(status);
  diagnostics_publisher_.publish(array);
}

bool MasterNode::OnPause(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  Answer(control_.Pause(), response);
  return true;
}

bool MasterNode::OnResume(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  Answer(control_.Resume(), response);
  return true;
}

bool MasterNode::OnStep(train_brake_msgs::StepExchanges::Request& request,
                        train_brake_msgs::StepExchanges::Response& response) {
  if (request.exchanges == 0) {
    response.message = "exchanges must be >= 1, got 0";
  } else {
    Answer(control_.Step(request.exchanges), response);
  }
  response.simulated_s = simulated_s_;
  return true;
}

bool MasterNode::OnSetRealTimeFactor(train_brake_msgs::SetRealTimeFactor::Request& request,
                                     train_brake_msgs::SetRealTimeFactor::Response& response) {
  const double factor = request.real_time_factor;
  if (factor >= 0.0 && std::isfinite(factor)) {
    Answer(control_.SetRealTimeFactor(factor), response);
  } else {
    response.message = fmt::format("real_time_factor must be >= 0, got {}", factor);
  }
  return true;
}

void MasterNode::OnCommand(const train_brake_msgs::DriverCommand& message) {
  try {
    commands_.Receive(message);
  } catch (const std::invalid_argument& e) {
    ROS_WARN("a command on driver/command is refused: %s", Presentable(e.what()).c_str());
  }
}

bool MasterNode::OnGive(train_brake_msgs::GiveCommand::Request& request,
                        train_brake_msgs::GiveCommand::Response& response) {
  try {
    response.exchange = commands_.Receive(request.command);
    response.success = true;
    response.message = fmt::format("given at the start of exchange {} or, in a pause, later", response.exchange);
  } catch (const std::invalid_argument& e) {
    response.message = e.what();
  }
  return true;
}

bool MasterNode::OnIdentify(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  response.success = true;
  const std::string& source = options_.resume.empty() ? options_.scenario : options_.resume;
  response.message = fmt::format("{}, since {} UTC, at {:.3f} s of {:g} s", source, UtcText(started_),
                                 simulated_s_.load(), scenario_.params.duration_s);
  return true;
}

}  // namespace ltd_master
