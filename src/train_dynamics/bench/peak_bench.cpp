// What this machine's core can do at most in the widest registers. Run/OPERATION: each by itself, nothing waiting for
// anything, time per operation on one number. Stream/WAGONS: read and write the states of so many wagons, no more.
// Cycle: one of the core's clock.
#include <benchmark/benchmark.h>

#include <vector>

#include "time_per_step.h"
#include "train_dynamics/numeric/lanes.h"
#include "train_dynamics/vehicle/wagon.h"

namespace train_dynamics::bench {
namespace {

using Pack = Lanes<kNativeLanes>;

constexpr int kChains = 12;  // independent of each other: more than the latency of an operation
constexpr int kRounds = 1000;

/// @param step  one operation on one number
template <class Step>
void Run(benchmark::State& state, int operations, const Step& step) {
  Pack x[kChains];
  for (int i = 0; i < kChains; ++i) x[i] = Pack(1.0 + 1e-3 * i);
  for (auto _ : state) {
    for (int round = 0; round < kRounds; ++round) {
#pragma GCC unroll 12
      for (Pack& chain : x) chain = step(chain);
    }
    benchmark::DoNotOptimize(x);
  }
  state.counters["s_per_operation"] =
      benchmark::Counter(1.0 * operations * kRounds * kChains * kNativeLanes,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

const Pack kFactor(0.999999), kSummand(1e-6);

BENCHMARK_CAPTURE(Run, add_and_multiply, 2, [](Pack x) { return x * kFactor + kSummand; });
BENCHMARK_CAPTURE(Run, divide, 1, [](Pack x) { return kFactor / x; });
BENCHMARK_CAPTURE(Run, square_root, 1, [](Pack x) { return Sqrt(x); });

void Stream(benchmark::State& state) {
  const auto wagons = static_cast<std::size_t>(state.range(0));
  std::vector<double> numbers(wagons * sizeof(WagonState<double>) / sizeof(double), 1.0);
  for (auto _ : state) {
    for (std::size_t i = 0; i + kNativeLanes <= numbers.size(); i += kNativeLanes) {
      (Pack::Load(&numbers[i]) + kSummand).Store(&numbers[i]);
    }
    benchmark::ClobberMemory();
  }
  ShowTimePerVehicleStep(state, static_cast<int>(wagons));
}
BENCHMARK(Stream)->Arg(242)->Arg(2000);

/// A chain of additions, each of which needs the sum before: one in a cycle.
void Cycle(benchmark::State& state) {
  constexpr int kUnrolled = 16;
  long sum = 0, summand = 1;
  for (auto _ : state) {
    for (int round = 0; round < kRounds; ++round) {
#pragma GCC unroll 16
      for (int i = 0; i < kUnrolled; ++i) {
        sum += summand;
        asm volatile("" : "+r"(sum), "+r"(summand));  // neither compiler nor core knows the sum beforehand
      }
    }
  }
  state.counters["s_per_cycle"] = benchmark::Counter(
      1.0 * kUnrolled * kRounds, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(Cycle);

}  // namespace
}  // namespace train_dynamics::bench

BENCHMARK_MAIN();
