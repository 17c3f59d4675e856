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
    t += 1e-3;
    control.Completed(t);
  }
  return Seconds(steady_clock::now() - begin);
}

// Lower bounds only: a busy machine may take any time. The last exchange begins 1 ms before the end.

TEST(RunControl, KeepsToTheRealTimeFactor) {
  RunControl control(false, 2.0);
  EXPECT_GE(RunUntil(control, 0.0, 0.2), (0.2 - 1e-3) / 2.0);
}

TEST(RunControl, ANewFactorHoldsAtOnceAndForgetsTheOldOne) {
  // At 1e-4, the second exchange would be due after 10 s.
  RunControl control(false, 1e-4);
  ASSERT_TRUE(control.Admit(0.0));
  control.Completed(1e-3);
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
  control.Completed(1e-3);
  control.Pause();
  EXPECT_FALSE(control.Admit(1e-3));  // 0.1 s of wall time
  control.Resume();
  EXPECT_GE(RunUntil(control, 1e-3, 0.051), 0.049);
}

/// The run's side of a number of exchanges of 1 ms.
void Move(RunControl& control, int exchanges, double& simulated_s) {
  for (int exchange = 0; exchange < exchanges; ++exchange) {
    while (!control.Admit(simulated_s)) {
    }
    simulated_s += 1e-3;
    control.Completed(simulated_s);
  }
}

TEST(RunControl, StepsAreGivenOneByOneAndOnlyInAPause) {
  RunControl control(true, 0.0);
  EXPECT_FALSE(control.Admit(0.0));
  std::future<RunControl::Reply> step = std::async(std::launch::async, [&control] { return control.Step(2); });
  double time_s = 0.0;
  Move(control, 2, time_s);
  EXPECT_TRUE(step.get().success);
  EXPECT_FALSE(control.Admit(time_s));
  EXPECT_TRUE(control.Resume().success);
  EXPECT_EQ("the train is not paused", control.Step(1).message);
  EXPECT_EQ("the train is not paused", control.Resume().message);
}

TEST(RunControl, AStepThatTheRunCannotDoEndsWithIt) {
  RunControl control(true, 0.0);
  std::future<RunControl::Reply> step = std::async(std::launch::async, [&control] { return control.Step(3); });
  double time_s = 0.0;
  Move(control, 2, time_s);
  control.End();
  const RunControl::Reply reply = step.get();
  EXPECT_FALSE(reply.success);
  EXPECT_EQ("the run has ended after 2 of 3 exchanges, at 0.002 s", reply.message);
  for (const RunControl::Reply& late :
       {control.Pause(), control.Resume(), control.Step(1), control.SetRealTimeFactor(1.0)}) {
    EXPECT_FALSE(late.success);
    EXPECT_EQ("the run has ended, at 0.002 s", late.message);
  }
}

TEST(RunControl, APauseEndsAStepAndSaysWhereTheTrainStands) {
  RunControl control(true, 0.0);
  std::future<RunControl::Reply> step = std::async(std::launch::async, [&control] { return control.Step(1000000); });
  double time_s = 0.0;
  Move(control, 4, time_s);
  while (!control.Admit(time_s)) {
  }
  // An exchange is under way: the pause is not reported before it has ended.
  std::future<RunControl::Reply> pause = std::async(std::launch::async, [&control] { return control.Pause(); });
  EXPECT_EQ(std::future_status::timeout, pause.wait_for(std::chrono::milliseconds(50)));
  control.Completed(time_s += 1e-3);
  const RunControl::Reply paused = pause.get(), stepped = step.get();
  EXPECT_TRUE(paused.success);
  EXPECT_EQ("paused at 0.005 s", paused.message);
  EXPECT_FALSE(stepped.success);
  EXPECT_EQ("paused after 5 of 1000000 exchanges, at 0.005 s", stepped.message);
  EXPECT_FALSE(control.Admit(time_s));  // it stands still
  EXPECT_EQ("was paused already, at 0.005 s", control.Pause().message);
}

TEST(RunControl, APauseDuringAnExchangeThatDoesNotEndSaysSo) {
  RunControl control(false, 0.0);
  ASSERT_TRUE(control.Admit(0.25));
  EXPECT_EQ("pauses after the exchange that began at 0.250 s and is still under way",
            control.Pause(std::chrono::milliseconds(1)).message);
}

TEST(RunControl, ResumeEndsAStepAndTheStepSaysSo) {
  RunControl control(true, 0.0);
  std::future<RunControl::Reply> step = std::async(std::launch::async, [&control] { return control.Step(9); });
  double time_s = 0.0;
  Move(control, 1, time_s);
  EXPECT_EQ("resumed at 0.001 s", control.Resume().message);
  EXPECT_EQ("resumed after 1 of 9 exchanges, at 0.001 s", step.get().message);
}

TEST(RunControl, TwoStepsAtATimeAreDoneOneBehindTheOther) {
  RunControl control(true, 0.0);
  std::future<RunControl::Reply> first = std::async(std::launch::async, [&control] { return control.Step(2); });
  double time_s = 0.0;
  Move(control, 1, time_s);
  std::future<RunControl::Reply> second = std::async(std::launch::async, [&control] { return control.Step(3); });
  Move(control, 4, time_s);
  EXPECT_TRUE(first.get().success);
  EXPECT_TRUE(second.get().success);
  EXPECT_FALSE(control.Admit(time_s));
}

}  // namespace
}  // namespace ltd_master
