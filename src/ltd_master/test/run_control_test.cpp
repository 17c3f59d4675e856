#include "ltd_master/run_control.h"

#include <gtest/gtest.h>

#include <future>

namespace ltd_master {
namespace {

using std::chrono::steady_clock;

double Seconds(steady_clock::duration d) { return std::chrono::duration<double>(d).count(); }

/// Runs exchanges of 1 ms until this simulated time. @return wall time taken [s]
double RunUntil(RunControl& control, double begin_s, double end_s) {
  const steady_clock::time_point begin = steady_clock::now();
  for (double t = begin_s; t < end_s - 1e-9;) {
    if (!control.Admit(t)) continue;
    control.Completed();
    t += 1e-3;
  }
  return Seconds(steady_clock::now() - begin);
}

// Lower bounds only: how long a busy machine takes is nobody's law. The last exchange begins 1 ms before the end.

TEST(RunControl, KeepsToTheRealTimeFactor) {
  RunControl control(false, 2.0);
  EXPECT_GE(RunUntil(control, 0.0, 0.2), (0.2 - 1e-3) / 2.0);
}

TEST(RunControl, ANewFactorHoldsAtOnceAndForgetsTheOldOne) {
  // At 1e-4, the second exchange would be due after 10 s.
  RunControl control(false, 1e-4);
  ASSERT_TRUE(control.Admit(0.0));
  control.Completed();
  EXPECT_FALSE(control.Admit(1e-3));  // gives up waiting after 0.1 s, so that the run sees Ctrl-C
  std::future<bool> next = std::async(std::launch::async, [&control] {
    while (!control.Admit(1e-3)) {
    }
    return true;
  });
  EXPECT_EQ(std::future_status::timeout, next.wait_for(std::chrono::milliseconds(20)));
  control.SetRealTimeFactor(1.0);
  EXPECT_TRUE(next.get());
  EXPECT_EQ(1.0, control.real_time_factor());
  // The pace counts from the other thread's exchange, which may lie a moment back.
  EXPECT_GE(RunUntil(control, 1e-3, 0.101), 0.05);
}

TEST(RunControl, WhatAPauseTookIsNotMadeUpFor) {
  RunControl control(false, 1.0);
  ASSERT_TRUE(control.Admit(0.0));
  control.Completed();
  control.Pause();
  EXPECT_FALSE(control.Admit(1e-3));  // 0.1 s of wall time
  control.Resume();
  EXPECT_GE(RunUntil(control, 1e-3, 0.051), 0.049);
}

TEST(RunControl, StepsAreGivenOneByOneAndOnlyInAPause) {
  RunControl control(true, 0.0);
  EXPECT_FALSE(control.Admit(0.0));
  std::future<bool> step = std::async(std::launch::async, [&control] { return control.Step(2); });
  for (int exchange = 0; exchange < 2; ++exchange) {
    while (!control.Admit(0.0)) {
    }
    control.Completed();
  }
  EXPECT_TRUE(step.get());
  EXPECT_FALSE(control.Admit(0.0));
  control.Resume();
  EXPECT_FALSE(control.Step(1));
}

TEST(RunControl, AStepThatTheRunCannotDoEndsWithIt) {
  RunControl control(true, 0.0);
  std::future<bool> step = std::async(std::launch::async, [&control] { return control.Step(1); });
  while (!control.Admit(0.0)) {
  }
  control.End();
  EXPECT_FALSE(step.get());
}

}  // namespace
}  // namespace ltd_master
