// The laws of connections over the lanes of each instruction set, held against the scalar ones.

#include "train_dynamics/coupler/connection_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "paper_vehicle.h"
#include "train_dynamics/coupler/row_kernels.h"

namespace train_dynamics {
namespace {

constexpr int kCount = 16;

// Sixteen connections of a law from deep compression to deep tension, at rest, opening and closing.
struct Connections {
  explicit Connections(const ConnectionLaw& law) {
    for (const char* name : {"rate", "force", "elastic", "tension", "tension_time", "compression", "compression_time",
                             "stored", "dissipated"}) {
      numbers[name].assign(kCount, 0.0);
    }
    numbers["parted"].assign(kCount, -1.0);
    for (int i = 0; i < kCount; ++i) {
      numbers["rate"][i] = 0.3 * std::sin(2.0 * i);
      numbers["extension"].push_back(0.02 * (i - 8));
    }
    const auto remember = [&](const auto& of) {
      auto memory = of.AtRest(0.0);
      memory.ForEachField([&](double field) { numbers["memory"].insert(numbers["memory"].end(), kCount, field); });
    };
    std::visit(remember, law);
  }
  ConnectionArrays Arrays() {
    const auto at = [&](const char* name) { return numbers[name].data(); };
    ConnectionArrays arrays{};
    arrays.count = kCount;
    arrays.strength_n = 3e5;  // some break
    arrays.rate_mps = at("rate");
    arrays.extension_m = at("extension");
    arrays.memory = at("memory");
    arrays.force_n = at("force");
    arrays.elastic_n = at("elastic");
    arrays.tension_n = at("tension");
    arrays.tension_time_s = at("tension_time");
    arrays.compression_n = at("compression");
    arrays.compression_time_s = at("compression_time");
    arrays.stored_j = at("stored");
    arrays.dissipated_j = at("dissipated");
    arrays.parted_s = at("parted");
    return arrays;
  }
  std::map<std::string, std::vector<double>> numbers;
};

std::vector<ConnectionParams> AllConnections() {
  std::vector<ConnectionParams> all;
  for (const auto& file : std::filesystem::directory_iterator(std::string(TRAIN_BRAKE_CONFIG_DIR) + "/couplers")) {
    all.push_back(LoadPart<ConnectionParams>("couplers/" + file.path().filename().string()));
  }
  all.push_back(LoadPart<ConnectionParams>("couplers/calibrated.yaml"));
  all.back().draft_gear.friction = DraftGearFriction::kStickSpring;
  return all;
}

TEST(RowKernels, TakeFromTheTrainAndGiveToIt) {
  for (const RowKernels& kernels : AllRowKernels()) {
    for (const int stride : {1, 2, 3}) {
      for (const int count : {1, 2, 7, 8, 33}) {
        std::vector<double> x, offset;
        for (int i = 0; i <= count * stride; ++i) x.push_back(std::sin(1.0 + i));
        for (int i = 0; i < count; ++i) offset.push_back(1e3 * std::cos(i));
        std::vector<double> difference(count), sum(count), spread(count * stride + 1, -7.0), expected = spread;
        kernels.differences(count, stride, x.data(), difference.data());
        kernels.offset_differences(count, stride, x.data(), offset.data(), sum.data());
        kernels.spread(count, stride, offset.data(), spread.data());
        for (int i = 0; i < count; ++i) {
          const double between = x[i * stride] - x[i * stride + 1];
          EXPECT_EQ(between, difference[i]);
          EXPECT_EQ(offset[i] + between, sum[i]);
          expected[i * stride] = offset[i];
        }
        EXPECT_EQ(expected, spread) << stride << " " << count;
      }
    }
  }
}

TEST(ConnectionKernels, EveryInstructionSetGivesTheBitsOfTheScalarLaw) {
  for (const ConnectionParams& params : AllConnections()) {
    const ConnectionLaw law = params.Law();
    for (const ConnectionKernels& kernels : AllConnectionKernels()) {
      Connections connections(law), expected(law);
      for (int exchange = 0; exchange < 5; ++exchange) {
        std::vector<double> next_m(kCount);
        for (int i = 0; i < kCount; ++i) {
          next_m[i] = expected.numbers["extension"][i] + 1e-3 * expected.numbers["rate"][i];
        }
        const auto exchange_of = [&](const ConnectionKernels& with, Connections& of) {
          const auto run = [&](const auto& type) {
            with.Of(type).forces(type, 5e-4, 0.001 * exchange, of.Arrays());
            with.Of(type).work(type, next_m.data(), of.Arrays());
          };
          std::visit(run, law);
        };
        exchange_of(kernels, connections);
        exchange_of(AllConnectionKernels().back(), expected);
        EXPECT_EQ(connections.numbers, expected.numbers) << params.name;
      }
      EXPECT_NE(expected.numbers["parted"], std::vector<double>(kCount, -1.0)) << params.name;
      EXPECT_NE(expected.numbers["dissipated"], std::vector<double>(kCount, 0.0)) << params.name;
    }
  }
}

}  // namespace
}  // namespace train_dynamics
