// A running train takes no memory from exchange to exchange: counted by this program's own operator new.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <string>

#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/in_process_train.h"

namespace {

std::atomic<long> allocations{0};

}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace train_dynamics {
namespace {

TEST(Allocation, NoneInARunningTrain) {
  for (const char* model : {"model=2d", "model=ltd"}) {
    for (const int threads : {1, 2}) {
      const config::LoadedScenario scenario =
          config::LoadScenario(std::string(TRAIN_BRAKE_CONFIG_DIR) + "/scenarios/emergency.yaml",
                               {model, "commands=[{time_s: 0, kind: emergency}]"});
      InProcessTransport transport(scenario.params, scenario.consist, threads);
      TrainMaster master(scenario.params, scenario.consist, transport, scenario.pressures);
      long records = 0;
      master.AddObserver([&](const TrainRecord&) { ++records; });
      master.Start();
      const auto run_until = [&](double time_s) {
        while (master.time_s() < time_s) master.Exchange();
      };
      run_until(1.1);
      const long before = allocations;
      run_until(1.9);  // between two ledgers, whose elements have names
      EXPECT_EQ(before, allocations) << model << ", " << threads << " thread(s)";
      EXPECT_EQ(191, records);
    }
  }
}

}  // namespace
}  // namespace train_dynamics
