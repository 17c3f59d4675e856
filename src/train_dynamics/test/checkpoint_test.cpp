// A run that goes on from a checkpoint is the run that was never broken off: the same bits in every record, and
// the same summary. Whatever the model, the number of threads, and what the parts of the train remember.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "simulate.h"
#include "strict_config/writer.h"
#include "train_dynamics/train/run_summary.h"
#include "train_dynamics/train/snapshot.h"

namespace train_dynamics {
namespace {

// What an observer sees of a record, bit for bit.
struct Seen {
  std::uint64_t exchange, digest;
  std::vector<double> coupler_force_n, acceleration_mps2, speed_mps, shoe_force_n;
  bool operator==(const Seen& other) const {
    return exchange == other.exchange && digest == other.digest && coupler_force_n == other.coupler_force_n &&
           acceleration_mps2 == other.acceleration_mps2 && speed_mps == other.speed_mps &&
           shoe_force_n == other.shoe_force_n;
  }
};

struct TestRun {
  TestRun(const std::string& scenario, const std::vector<std::string>& overrides, int threads)
      : loaded(config::LoadScenario(ScenarioFile(scenario), overrides)),
        transport(loaded.params, loaded.consist, threads),
        master(loaded.params, loaded.consist, transport, loaded.pressures),
        summary(loaded.params) {
    master.AddObserver([this](const TrainRecord& record) {
      summary.Observe(record);
      if (record.exchange == 0) first_position_m = record.mean_position_m;
      zero = record.at_time_zero;
      seen.push_back({record.exchange, record.state_digest, record.held.coupler_force_n, record.acceleration_mps2,
                      record.vehicles.speed_mps, record.vehicles.shoe_force_n});
    });
  }
  // Runs on; leaves the checkpoint of an exchange.
  void Go(std::uint64_t checkpoint_at = 0) {
    while (!master.Done()) {
      if (master.exchange() + 1 == checkpoint_at) master.AskForCheckpoint();
      master.Exchange();
      if (master.exchange() != checkpoint_at) continue;
      checkpoint = master.Checkpoint();
      checkpoint.summary = summary.Memory();
    }
  }
  /// All that a summary tells, as text: numbers that are not there are equal, too.
  std::string Summary() const {
    std::string text = std::to_string(summary.state_digest());
    const auto add = [&text](double number) { text += " " + ShortestDecimal(number); };
    for (const double number : summary.Memory()) add(number);
    for (const double number : {summary.mean_speed_mps(), summary.lead_speed_mps(), summary.tail_speed_mps(),
                                summary.mean_distance_m(), summary.ResidualShare(master), summary.left_route_s()})
      add(number);
    for (const ForceExtremes& of : master.in_train_forces().Extremes()) {
      for (const double number : {of.tension_n, of.tension_time_s, of.compression_n, of.compression_time_s})
        add(number);
    }
    for (const auto& [element, energy_j] : summary.ledger().dissipated_j) add(energy_j);
    for (const GivenCommand& given : master.schedule().Given())
      text += " " + std::to_string(given.exchange) + " " + given.command.Text();
    return text;
  }

  config::LoadedScenario loaded;
  InProcessTransport transport;
  TrainMaster master;
  RunSummary summary;
  std::vector<Seen> seen;
  TimeZero zero;  // as the last record has it
  double first_position_m = 0.0;
  TrainCheckpoint checkpoint;
};

struct Case {
  const char* name;
  const char* scenario;
  std::vector<std::string> overrides;
  double share = 0.5;  // of the run that lies before the checkpoint
};

class CheckpointTest : public testing::TestWithParam<Case> {};

TEST_P(CheckpointTest, ARunGoesOnToTheSameBits) {
  const Case& c = GetParam();
  TestRun whole(c.scenario, c.overrides, 1);
  whole.master.Start();
  const std::uint64_t middle =
      static_cast<std::uint64_t>(c.share * static_cast<double>(whole.loaded.params.Exchanges()));
  whole.Go(middle);

  // Through bytes, as a file brings it, and with another number of threads.
  const TrainCheckpoint checkpoint = DecodeTrainCheckpoint(Encode(whole.checkpoint));
  TestRun resumed(c.scenario, c.overrides, 3);
  resumed.summary.SetMemory(checkpoint.summary);
  resumed.master.Resume(checkpoint);
  EXPECT_EQ(resumed.master.exchange(), middle);
  resumed.Go();

  ASSERT_FALSE(resumed.seen.empty());
  const std::vector<Seen> tail(whole.seen.end() - static_cast<long>(resumed.seen.size()), whole.seen.end());
  EXPECT_EQ(tail.front().exchange, middle + whole.loaded.params.ExchangesPerRecord());
  EXPECT_TRUE(tail == resumed.seen);
  EXPECT_EQ(whole.zero.mean_position_m, resumed.zero.mean_position_m);
  EXPECT_EQ(whole.zero.stored_energy_j, resumed.zero.stored_energy_j);
  EXPECT_EQ(whole.zero.mean_position_m, whole.first_position_m);  // what observers were shown at time 0
  EXPECT_NE(whole.zero.stored_energy_j, 0.0);                     // below 0 where a wagon stands on its springs
  EXPECT_EQ(whole.Summary(), resumed.Summary());
}

INSTANTIATE_TEST_SUITE_P(
    All, CheckpointTest,
    testing::Values(
        Case{"Wagons", "emergency", {"model=2d", "duration_s=6"}},
        Case{"SlideProtection",
             "single_wagon_stop",
             {"train.consist[0].vehicle=ore_wagon_empty", "train.consist[0].vehicle.wheel_rail.adhesion=low",
              "train.consist[0].vehicle.wheel_slide_protection=threshold_3state", "train.consist[0].count=5",
              "duration_s=16"},
             0.6375},
        // In the middle of slides.
        Case{"Slides",
             "low_adhesion_stop",
             {"train.consist[0].vehicle=ore_wagon_empty", "train.consist[0].count=3", "duration_s=20"}},
        Case{"Ltd", "emergency", {"model=ltd", "duration_s=20"}},
        Case{"NewmarkWithoutInertia", "full_service", {"model=ltd-no-inertia", "integrator=newmark", "duration_s=20"}},
        Case{"StickSpringsRemember",
             "emergency",
             {"model=ltd", "duration_s=20", "train.connection.draft_gear.friction=stick_spring"}},
        // All three models in one train.
        Case{"Mixed",
             "emergency",
             {"duration_s=6", "train.consist[0].model=ltd", "train.consist[1].model=ltd-no-inertia"}},
        Case{"DampedGearsRemember", "emergency", {"model=ltd", "duration_s=20", "train.connection=friction_gear"}},
        Case{"DifferentGearsRemember", "emergency", {"model=ltd", "duration_s=10", "train.connection=mt2_and_polymer"}},
        Case{"BuffersRemember", "emergency", {"model=ltd", "duration_s=10", "train.connection=side_buffers_b"}},
        // Broken connections, and the emergency that their open pipes are.
        Case{"PartedTrains",
             "full_service",
             {"model=ltd", "duration_s=60", "train.connection={base: friction_gear, strength_n: 8.0e4}"},
             0.9},
        // Before the wagon has gone the distance of its start.
        Case{"Breakaway",
             "single_wagon_stop",
             {"initial_speed_kmh=0", "commands=[]", "duration_s=40", "track=down_half_percent",
              "train.consist[0].vehicle.propulsion_resistance.breakaway={law: constant, "
              "constant_n_per_kn: 4, distance_m: 2}"},
             0.4},
        // After the wagon has come to rest: the summary remembers when it stopped.
        Case{"InTheMiddleOfABrakeWave", "hose_parted", {"duration_s=12"}, 0.55},
        Case{"AfterTheStop", "single_wagon_stop", {}, 0.95}),
    [](const auto& c) { return std::string(c.param.name); });

// ---- what does not fit is refused -------------------------------------------------------------------------------

TrainCheckpoint ShortCheckpoint() {
  static const TrainCheckpoint checkpoint = [] {
    TestRun run("emergency", {"model=ltd", "duration_s=1"}, 1);
    run.master.Start();
    run.Go(500);
    return run.checkpoint;
  }();
  return checkpoint;
}

std::string WhyNotResumed(const TrainCheckpoint& checkpoint, const std::vector<std::string>& overrides) {
  TestRun run("emergency", overrides, 1);
  try {
    run.master.Resume(checkpoint);
  } catch (const SnapshotError& e) {
    return e.what();
  }
  return "";
}

TEST(Checkpoint, ThatDoesNotFitIsRefused) {
  EXPECT_EQ(WhyNotResumed(ShortCheckpoint(), {"model=ltd", "duration_s=1"}), "");
  EXPECT_NE(WhyNotResumed(ShortCheckpoint(), {"model=2d", "duration_s=1"}).find("vehicle"), std::string::npos);
  EXPECT_NE(WhyNotResumed(ShortCheckpoint(), {"model=ltd", "duration_s=0.5"}).find("nothing to run"),
            std::string::npos);
  TrainCheckpoint other = ShortCheckpoint();
  other.connections.pop_back();
  EXPECT_NE(WhyNotResumed(other, {"model=ltd", "duration_s=1"}), "");
  other = ShortCheckpoint();
  other.connections.push_back(0.0);
  EXPECT_NE(WhyNotResumed(other, {"model=ltd", "duration_s=1"}), "");
  other = ShortCheckpoint();
  ++other.exchange;
  EXPECT_NE(WhyNotResumed(other, {"model=ltd", "duration_s=1"}).find("record"), std::string::npos);
}

TEST(Checkpoint, FollowsARecord) {
  TestRun run("emergency", {"model=ltd", "duration_s=1"}, 1);
  run.master.Start();
  EXPECT_FALSE(run.master.RecordIsNext());
  EXPECT_THROW(run.master.AskForCheckpoint(), std::logic_error);
}

TEST(Checkpoint, OfAnotherFormatIsRefusedNamingItsWriter) {
  // As a checkpoint of format 1 begins and ends: mark, format, scenario, ..., checksum.
  ByteWriter writer;
  writer.AddRaw("TBTRAIN\n", 8);
  writer.Add(std::uint64_t{1});
  writer.Add(std::string("# train_brake 0.0.7\nname: old\n"));
  writer.Add(std::uint64_t{500});
  Digest digest;
  const std::vector<std::uint8_t> content = writer.bytes();
  for (std::size_t at = 0; at < content.size(); at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, content.data() + at, std::min<std::size_t>(8, content.size() - at));
    digest.Add(word);
  }
  digest.Add(std::uint64_t{content.size()});
  writer.Add(digest.value());
  try {
    DecodeTrainCheckpoint(writer.bytes());
    FAIL();
  } catch (const SnapshotError& e) {
    const std::string why = e.what();
    EXPECT_NE(why.find("format version 1, written by train_brake 0.0.7"), std::string::npos) << why;
    EXPECT_NE(why.find("run its config.yaml again"), std::string::npos) << why;
  }
}

TEST(Snapshot, EveryDamagedByteIsNoticed) {
  BlockSnapshot snapshot;
  snapshot.exchange = 7;
  snapshot.first = 2;
  snapshot.states = {{1.0, -2.0, 3.5}, {}, {4.0}};  // rows of vehicles of different kinds
  const std::vector<std::uint8_t> bytes = Encode(snapshot);
  EXPECT_EQ(DecodeBlockSnapshot(bytes).states, snapshot.states);
  EXPECT_EQ(DecodeBlockSnapshot(bytes).exchange, 7u);
  EXPECT_EQ(DecodeBlockSnapshot(bytes).first, 2u);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::vector<std::uint8_t> damaged = bytes;
    damaged[i] ^= 0x10;
    EXPECT_THROW(DecodeBlockSnapshot(damaged), SnapshotError) << "byte " << i;
  }
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THROW(DecodeBlockSnapshot({bytes.begin(), bytes.begin() + static_cast<long>(size)}), SnapshotError)
        << "cut to " << size;
  }
  std::vector<std::uint8_t> longer = bytes;
  longer.push_back(0);
  EXPECT_THROW(DecodeBlockSnapshot(longer), SnapshotError);
  EXPECT_THROW(DecodeTrainCheckpoint(bytes), SnapshotError);  // one for the other
  std::vector<std::uint8_t> newer = bytes;
  newer[8] = 9;
  try {
    DecodeBlockSnapshot(newer);
    FAIL();
  } catch (const SnapshotError& e) {
    EXPECT_NE(std::string(e.what()).find("version 9"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace train_dynamics
