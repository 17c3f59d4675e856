#include "train_results/result_tables.h"

#include <fmt/format.h>

#include "train_dynamics/brake/pneumatic/brake_record.h"
#include "train_dynamics/vehicle/slide_event.h"
#include "train_dynamics/vehicle/vehicle_record.h"
#include "train_dynamics/vehicle/wagon.h"

namespace train_results {
namespace {

const ResultColumn kTime = {"time_s", "s", "simulated time"};
const ResultColumn kConnection = {"connection", "", "connection, from 1: between vehicles 1 and 2"};

}  // namespace

std::string ResultTable::Header(int vehicles) const {
  std::string line;
  const auto add = [&line](const std::string& name) { line += (line.empty() ? "" : ",") + name; };
  for (const ResultColumn& column : columns) {
    if (column.name.find("{}") == std::string::npos) {
      add(column.name);
    } else {
      for (int i = 1; i <= vehicles; ++i) add(fmt::format(fmt::runtime(column.name), i));
    }
  }
  return line + "\n";
}

ResultTable HistoryTable() {
  return {"train_history.csv",
          "with --csv: the train at each record",
          {kTime,
           {"mean_speed_kmh", "km/h", "mean speed of the vehicles, forward positive"},
           {"lead_speed_kmh", "km/h", "speed of the first vehicle"},
           {"tail_speed_kmh", "km/h", "speed of the last vehicle"},
           {"mean_position_m", "m", "mean position of the vehicles' centres along the track"},
           {"max_tension_n", "N", "largest coupler force of the train in this record, tension positive"},
           {"max_compression_n", "N", "least coupler force of the train in this record: compression is negative"},
           {"mean_cylinder_pressure_pa", "Pa", "mean pressure of the brake cylinders above the atmosphere"}}};
}

ResultTable PressureTable() {
  return {"pressures.csv",
          "with --csv: the brake cylinder of every vehicle at each record; serves as a `pressure_table`",
          {kTime, {"vehicle_{}_pa", "Pa", "pressure in the vehicle's brake cylinder above the atmosphere"}}};
}

std::vector<ResultTable> BrakeTables() {
  std::vector<ResultTable> tables;
#define TRAIN_RESULTS_TABLE(name, unit, meaning)                                 \
  tables.push_back(                                                              \
      {#name ".csv",                                                             \
       "with --csv and a brake of kind pneumatic: every vehicle at each record", \
       {kTime,                                                                   \
        {std::string(unit) == "-" ? "vehicle_{}" : "vehicle_{}_pa", std::string(unit) == "-" ? "" : unit, meaning}}});
  TRAIN_DYNAMICS_BRAKE_RECORD(TRAIN_RESULTS_TABLE)
#undef TRAIN_RESULTS_TABLE
  return tables;
}

ResultTable WagonTable() {
  ResultTable table = {"wagon_NNN.csv",
                       "with --csv: a wagon of the 2D model that `detail_vehicles` names, at each record",
                       {kTime, {"speed_mps", "m/s", "speed of the carbody, forward positive"}}};
  const auto add_wheelsets = [&table](const char* name, const char* unit, const char* meaning) {
    for (int i = 1; i <= train_dynamics::kWheelsets; ++i) {
      table.columns.push_back({fmt::format(fmt::runtime(name), fmt::format("wheelset_{}", i)), unit, meaning});
    }
  };
  add_wheelsets("normal_force_{}_n", "N", "rail on the wheelset, compression positive; 0: lifted off");
  add_wheelsets("creepage_{}", "", "(v - omega r) / sqrt(v^2 + v0^2); braking positive");
  add_wheelsets("creep_force_{}_n", "N", "rail on the wheelset along the track; backwards positive");
  add_wheelsets("shoe_force_{}_n", "N", "brake shoes on the treads, tangential; backwards positive");
  for (const char* body : {"carbody", "front_bolster", "rear_bolster", "front_frame", "rear_frame"}) {
    table.columns.push_back({fmt::format("{}_pitch_rad", body), "rad", "pitch angle of the body; nose down positive"});
  }
  const auto add_quarters = [&table](const char* name, const char* unit, const char* meaning) {
    for (const char* quarter : {"front_front", "front_rear", "rear_front", "rear_rear"}) {
      table.columns.push_back({fmt::format(fmt::runtime(name), quarter), unit, meaning});
    }
  };
  add_quarters("nest_compression_{}_m", "m",
               "half of a bogie's spring nest from unloaded, compression positive: bogie, then half of it");
  add_quarters("wedge_friction_{}_n", "N", "vertical friction of the wedges on the bolster; upward positive");
  table.columns.push_back({"front_coupler_force_n", "N", "tension positive; 0 without a vehicle in front"});
  table.columns.push_back({"rear_coupler_force_n", "N", "tension positive; 0 without a vehicle behind"});
  table.columns.push_back({"cylinder_pressure_pa", "Pa", "brake cylinder, above the atmosphere"});
  return table;
}

ResultTable VehicleTable() {
  ResultTable table = {"vehicles.csv",
                       "with --csv: the last record of every vehicle; `nan`: not computed by its model",
                       {{"vehicle", "", "vehicle, from 1 at the front"}}};
  train_dynamics::ForEachRecordField([&table](const train_dynamics::RecordInfo& field) {
    for (int i = 1; i <= field.numbers; ++i) {
      table.columns.push_back({field.numbers == 1 ? field.name : fmt::format("{}_{}", field.name, i),
                               std::string(field.unit) == "1" ? "" : field.unit, field.meaning});
    }
  });
  return table;
}

ResultTable CouplerTable() {
  return {"couplers.csv",
          "always: the largest forces of every connection, of all exchanges and not only of the records",
          {kConnection,
           {"max_tension_n", "N", "largest coupler force, tension positive; 0 where it never was in tension"},
           {"max_tension_time_s", "s", "when it was"},
           {"max_compression_n", "N", "least coupler force: compression is negative"},
           {"max_compression_time_s", "s", "when it was"}}};
}

ResultTable SlideTable() {
  ResultTable table = {"slides.csv", "where wheelsets slid: every slide, with its wheelset", {}};
  train_dynamics::SlideEvent of_names;
  train_dynamics::ForEachSlideField(
      [&table](const char* name, const char* unit, double) {
        table.columns.push_back({name, std::string(unit) == "1" ? "" : unit, ""});
      },
      of_names);
  std::size_t i = 0;
#define TRAIN_RESULTS_MEANING(name, unit, text) table.columns[i++].meaning = text;
  TRAIN_DYNAMICS_SLIDE_EVENT(TRAIN_RESULTS_MEANING)
#undef TRAIN_RESULTS_MEANING
  return table;
}

ResultTable TrackWearTable() {
  return {"track_wear.csv",
          "where wheelsets slid: work on each metre of the track",
          {{"from_m", "m", "where the metre begins along the track"},
           {"to_m", "m", "where it ends"},
           {"creep_j", "J", "energy lost in creep on this metre"},
           {"brake_j", "J", "work of the longitudinal forces on the rail over this metre, braking positive"}}};
}

std::vector<ResultTable> ResultTables() {
  std::vector<ResultTable> tables = {CouplerTable(), HistoryTable(), PressureTable(), VehicleTable(),
                                     WagonTable(),   SlideTable(),   TrackWearTable()};
  for (ResultTable& table : BrakeTables()) tables.push_back(std::move(table));
  return tables;
}

const std::vector<ResultFile>& ResultFiles() {
  static const std::vector<ResultFile> files = {
      {"config.yaml", "the scenario with everything resolved: runs again to the same bits"},
      {"train.bag",
       "the records as they come; topics and fields: [ros_interface.md](ros_interface.md), "
       "[analysis.md](analysis.md); `train.bag.active` while the run goes on"},
      {"checkpoint", "where the run can be resumed: `train_sim run --resume FOLDER`"},
      {"branched_from", "of a run that left another one: its checkpoint there"},
      {"replay.yaml", "of a run with live commands: the scenario with them, runs again to the same bits"},
      {"pressure_table.csv", "of a run with a `pressure_table`: a copy of it"},
      {"summary.json", "at the end, what the run came to: [below](#summaryjson); a run without it was cut off"},
      {"report.html", "the [report](report.md), where one was made"},
  };
  return files;
}

const std::vector<ResultColumn>& SummaryFields() {
  static const std::vector<ResultColumn> fields = {
      {"version", "", "of the program"},
      {"scenario", "", "its name"},
      {"model", "", "models of the vehicles: ltd, 2d, or how many of each"},
      {"vehicles", "", "number of vehicles"},
      {"external[].node", "", "only with vehicles of nodes of their own: the node"},
      {"external[].first_vehicle", "", "the first vehicle that it moves, from 1"},
      {"external[].vehicles", "", "how many it moves"},
      {"external_covered.*", "", "what the digest and the ledger cover of such vehicles"},
      {"dt_s", "s", "time step of the vehicles"},
      {"exchange_interval_s", "s", "time from exchange to exchange of coupler forces and motions"},
      {"simulated_s", "s", "time at the end"},
      {"resumed_at_s", "s", "where this process went on from a checkpoint; null: it began at 0"},
      {"wall_s", "s", "time that this process took for its part"},
      {"real_time_factor", "", "simulated over taken time of this process"},
      {"ns_per_vehicle_step", "ns", "taken time per vehicle and step"},
      {"complete", "", "true: the run came to its end; false: interrupted, or ended by a fault"},
      {"ended_by", "", "until, duration_s, or null where it is not complete"},
      {"commands[].time_s", "s", "commands given by a condition or to the running train: when"},
      {"commands[].exchange", "", "the exchange after which it holds"},
      {"commands[].command", "", "the command, as text"},
      {"commands[].live", "", "true: given to the running train"},
      {"fault", "", "why the run failed; null: it did not"},
      {"distance_m", "m", "mean distance run from time 0 to the end"},
      {"final_speed_kmh.mean", "km/h", "mean speed of the vehicles at the end"},
      {"final_speed_kmh.lead", "km/h", "of the first vehicle"},
      {"final_speed_kmh.tail", "km/h", "of the last vehicle"},
      {"stopped", "", "true: the train stands at the end"},
      {"stop_time_s", "s", "when it came to the stand in which it ends; null: it does not stand"},
      {"stop_distance_m", "m", "mean distance run until then"},
      {"stops[].time_s", "s", "every stand: when it began"},
      {"stops[].distance_m", "m", "mean distance run until then"},
      {"stops[].until_s", "s", "when the train was under way again; null: it was not"},
      {"rolled_back", "", "true: the train came back by more than 0.5 m from its furthest place"},
      {"left_route_s", "s", "when an end of the train first was beyond an end of its route; null: never"},
      {"rolled_back_m", "m", "by how far it lies behind its furthest place at the end"},
      {"max_tension_n.value", "N", "largest coupler force of all exchanges; max_tension_n is null without connections"},
      {"max_tension_n.connection", "", "where it was, from 1"},
      {"max_tension_n.time_s", "s", "when it was"},
      {"max_compression_n.value", "N", "largest compression, as a negative force"},
      {"max_compression_n.connection", "", "where it was, from 1"},
      {"max_compression_n.time_s", "s", "when it was"},
      {"partings[].connection", "", "connections that broke, from 1"},
      {"partings[].time_s", "s", "when they did"},
      {"twin.start_offset_kmh", "km/h",
       "with --twin: by how much the start of a second run differed; twin is null without"},
      {"twin.max_tension_spread_n", "N", "largest difference of a connection's largest tension between the two"},
      {"twin.max_compression_spread_n", "N", "the same of compression"},
      {"twin.distance_spread_m", "m", "difference of the mean distances run"},
      {"twin.final_speed_spread_kmh", "km/h", "difference of the mean speeds at the end"},
      {"slides.slides", "", "number of slides of all wheelsets (slides.csv)"},
      {"slides.energy_j", "J", "lost in them"},
      {"slides.flat_risks", "", "number of wheelsets with a risk of a flat"},
      {"slides.wheelsets[].vehicle", "", "each wheelset that slid: its vehicle, from 1"},
      {"slides.wheelsets[].wheelset", "", "its number in the vehicle, from 1"},
      {"slides.wheelsets[].slides", "", "number of its slides"},
      {"slides.wheelsets[].slid_s", "s", "time in slides"},
      {"slides.wheelsets[].slid_m", "m", "distance the tread slid over the rail"},
      {"slides.wheelsets[].locked_s", "s", "time with locked wheels"},
      {"slides.wheelsets[].locked_m", "m", "distance run with locked wheels"},
      {"slides.wheelsets[].longest_lock_s", "s", "the longest lock in one piece"},
      {"slides.wheelsets[].energy_j", "J", "lost in creep over its slides"},
      {"slides.wheelsets[].largest_lock_j", "J", "lost in the lock that took most"},
      {"slides.wheelsets[].largest_adhesion", "", "largest share of creep force in normal force"},
      {"slides.wheelsets[].flat_risk", "", "true: a lock took more than 30 kJ"},
      {"energy.time_s", "s", "time of the energy ledger"},
      {"energy.initial_j", "J", "stored at time 0: kinetic, elastic"},
      {"energy.final_j", "J", "stored at that time"},
      {"energy.gravity_work_j", "J", "work of gravity on the train since the start"},
      {"energy.traction_work_j", "J", "work of traction on the train"},
      {"energy.taken_j", "J", "with locomotives of known supply: taken from tank and line"},
      {"energy.fuel_kg", "kg", "with them: fuel burnt"},
      {"energy.dissipated_j.*", "J", "lost in each kind of element"},
      {"energy.residual_j", "J", "what the ledger does not account for"},
      {"energy.residual_share", "", "the same over the energy turned over"},
      {"state_digest", "", "digest of all states: equal where two runs agree to the bit"},
  };
  return fields;
}

}  // namespace train_results
