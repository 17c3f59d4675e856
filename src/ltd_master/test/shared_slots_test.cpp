#include "ltd_master/ranks/shared_slots.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace ltd_master {
namespace {

using train_brake_msgs::Configure;
using train_brake_msgs::ExchangeMemory;
using train_brake_msgs::Step;
using train_brake_msgs::StepRequest;
using train_brake_msgs::StepResponse;
using Reply = SharedSlots::Reply;

constexpr std::uint64_t kRun = 17;
constexpr double kBriefly = 0.01, kLong = 60.0;  // [s]

/// A rank's process, as far as the master can see it.
class Process {
 public:
  explicit Process(const train_brake_msgs::ConfigureRequest& offer)
      : memory_(offer.memory_pid, offer.memory_descriptor, offer.run_id), slot(offer.memory_slot) {}

  StepRequest Request() {
    StepRequest request;
    EXPECT_TRUE(memory_.request(slot).Read(request, memory_.layout().request_room));
    return request;
  }
  void Write(std::uint64_t call, const StepResponse& reply) {
    memory_.reply(slot).Write(call, reply, memory_.layout().reply_room);
  }
  void Notify() {
    if (memory_.head().unreplied.fetch_sub(1) > 1) return;
    memory_.head().last_slot = slot;
    memory_.head().replies.Notify();
  }
  void Reply(const StepResponse& reply) {
    Write(memory_.request(slot).call(), reply);
    Notify();
  }
  std::uint64_t call() { return memory_.request(slot).call(); }
  /// What only a stranger writes: the size of the message, and the message.
  void WriteRaw(std::uint32_t size, const std::vector<std::uint8_t>& bytes) {
    Write(call(), StepResponse());
    auto* buffer = reinterpret_cast<std::uint8_t*>(&memory_.reply(slot));
    std::memcpy(buffer + sizeof(std::uint64_t), &size, sizeof size);
    std::copy(bytes.begin(), bytes.end(), buffer + train_brake_msgs::MessageBuffer::Size(0));
    Notify();
  }
  std::uint32_t reply_room() const { return memory_.layout().reply_room; }

 private:
  ExchangeMemory memory_;

 public:
  const std::uint32_t slot;
};

class SharedSlotsTest : public testing::Test {
 protected:
  /// A process takes the place of a rank.
  Process Start(int rank) {
    Configure& call = configure_[rank];
    call.request.run_id = kRun;
    slots_.Offer(rank, call.request);
    call.response.ok = call.response.memory_used = true;
    slots_.Settle(rank, call.response);
    return Process(call.request);
  }
  void Send() {
    ++exchange_;
    for (std::size_t rank = 0; rank < step_.size(); ++rank) {
      step_[rank].request.exchange = exchange_;
      step_[rank].request.coupler_force_n.assign(ranks_[rank].count + 1, 1000.0 * static_cast<double>(rank));
      step_[rank].request.cylinder_pressure_pa.assign(ranks_[rank].count, 1e5);
    }
    slots_.Send(step_);
  }
  static StepResponse Answer(const StepRequest& request) {
    StepResponse reply;
    reply.ok = true;
    reply.exchange = request.exchange;
    reply.head_displacement_m = {request.coupler_force_n[0]};
    return reply;
  }
  SharedSlots::Reply Read(int rank) { return slots_.Read(rank, step_[rank].response); }
  std::string WhyUnreadable(int rank) {
    try {
      Read(rank);
    } catch (const std::exception& e) {
      return e.what();
    }
    return "readable";
  }

  const std::vector<train_dynamics::Rank> ranks_ = {{"wagon_001", 0, 2}, {"wagon_003", 2, 3}, {"wagon_006", 5, 1}};
  SharedSlots slots_{ranks_, kRun};
  std::vector<Configure> configure_ = std::vector<Configure>(3);
  std::vector<Step> step_ = std::vector<Step>(3);
  std::uint64_t exchange_ = 0;
};

TEST_F(SharedSlotsTest, CarriesRequestsAndReplies) {
  Process first = Start(0), third = Start(2);  // the second is on another machine
  EXPECT_TRUE(slots_.Has(0) && !slots_.Has(1) && slots_.Has(2));
  for (int i = 0; i < 3; ++i) {
    Send();
    EXPECT_EQ(first.Request().exchange, exchange_);
    EXPECT_EQ(third.Request().coupler_force_n, std::vector<double>(2, 2000.0));
    EXPECT_EQ(Read(0), Reply::kNone);
    third.Reply(Answer(third.Request()));
    EXPECT_EQ(Read(2), Reply::kRead);
    first.Reply(Answer(first.Request()));
    EXPECT_EQ(Read(0), Reply::kRead);
    EXPECT_EQ(step_[0].response.exchange, exchange_);
    EXPECT_EQ(step_[2].response.head_displacement_m[0], 2000.0);
    EXPECT_EQ(slots_.last_rank(), 0);
  }
}

TEST_F(SharedSlotsTest, SleepsUntilTheLastHasReplied) {
  Process first = Start(0), second = Start(1);
  for (int i = 0; i < 100; ++i) {
    Send();
    std::thread others([&] {
      first.Reply(Answer(first.Request()));
      second.Reply(Answer(second.Request()));
    });
    while (Read(0) != Reply::kRead || Read(1) != Reply::kRead) slots_.Wait(kLong);
    others.join();
    EXPECT_EQ(slots_.last_rank(), 1);
  }
}

TEST_F(SharedSlotsTest, TheSlotOfALostRankIsNobodysAnyMore) {
  Process lost = Start(0), other = Start(1);
  Send();
  slots_.Drop(0);
  EXPECT_FALSE(slots_.Has(0));
  Process replacement = Start(0);
  EXPECT_NE(replacement.slot, lost.slot);

  Send();
  StepResponse late;
  late.ok = true;
  late.exchange = 99;
  lost.Reply(late);  // wakes the master, perhaps too early
  lost.Write(replacement.call(), late);
  lost.Notify();
  EXPECT_EQ(Read(0), Reply::kNone);
  other.Reply(Answer(other.Request()));
  std::thread last([&] { replacement.Reply(Answer(replacement.Request())); });
  while (Read(0) != Reply::kRead) slots_.Wait(kLong);
  last.join();
  EXPECT_EQ(step_[0].response.exchange, exchange_);
  EXPECT_EQ(Read(1), Reply::kRead);
}

TEST_F(SharedSlotsTest, RepliesToOtherCallsAreNone) {
  Process process = Start(0);
  Send();
  for (const std::uint64_t call : {process.call() - 1, process.call() + 1, ~std::uint64_t{0}}) {
    process.Write(call, Answer(process.Request()));
    process.Notify();
    slots_.Wait(kBriefly);
    EXPECT_EQ(Read(0), Reply::kNone);
  }
}

TEST_F(SharedSlotsTest, WhatDoesNotFitIsSaidToBeTooLarge) {
  Process process = Start(2);
  Send();
  StepResponse reply = Answer(process.Request());
  reply.message.assign(process.reply_room(), 'x');
  process.Reply(reply);
  EXPECT_EQ(Read(2), Reply::kTooLarge);
}

TEST_F(SharedSlotsTest, HasRoomForAllThatARankMaySay) {
  Process process = Start(1);
  Send();
  const std::size_t count = 3;
  StepResponse reply = Answer(process.Request());
  reply.head_displacement_m.resize(count);
  reply.head_velocity_mps.resize(count);
  reply.record.position_m.resize(count);
  reply.record.details.resize(count);
  reply.record.dissipated_j.resize(11 * count);
  reply.fault = std::string(1000, 'x');
  process.Reply(reply);
  EXPECT_EQ(Read(1), Reply::kRead);
}

TEST_F(SharedSlotsTest, BytesOfAStrangerAreRefused) {
  Process process = Start(0);
  Send();
  process.WriteRaw(process.reply_room() + 1, {});
  EXPECT_EQ(WhyUnreadable(0), "a message of " + std::to_string(process.reply_room() + 1) + " bytes is too long");
  process.WriteRaw(5, {1, 0xff, 0xff, 0xff, 0xff});  // a text of 4 GiB
  EXPECT_NE(WhyUnreadable(0), "readable");
  process.WriteRaw(0, {});
  EXPECT_NE(WhyUnreadable(0), "readable");
  process.WriteRaw(2000, std::vector<std::uint8_t>(2000, 0));  // more than a message of zeros
  EXPECT_NE(WhyUnreadable(0), "readable");
}

TEST_F(SharedSlotsTest, OffersEachProcessASlotOfItsOwnAsLongAsThereAreSome) {
  std::vector<bool> seen;
  int slots = 0;
  for (; slots < 1000; ++slots) {
    train_brake_msgs::ConfigureRequest request;
    slots_.Offer(0, request);
    if (request.memory_pid == 0) break;
    seen.resize(std::max<std::size_t>(seen.size(), request.memory_slot + 1), false);
    EXPECT_FALSE(seen[request.memory_slot]);
    seen[request.memory_slot] = true;
    train_brake_msgs::ConfigureRequest repeated;
    slots_.Offer(0, repeated);
    EXPECT_EQ(repeated.memory_slot, request.memory_slot);  // the same process
    slots_.Drop(0);
  }
  EXPECT_GT(slots, 20);
  EXPECT_LT(slots, 1000);
  Configure without = configure_[0];
  without.response.ok = without.response.memory_used = true;  // says a stranger
  slots_.Settle(0, without.response);
  EXPECT_FALSE(slots_.Has(0));
}

TEST_F(SharedSlotsTest, ARankThatDeclinesHasNone) {
  Configure call;
  slots_.Offer(0, call.request);
  call.response.ok = true;
  slots_.Settle(0, call.response);
  EXPECT_FALSE(slots_.Has(0));
}

TEST_F(SharedSlotsTest, NoOtherRunOpensIt) {
  train_brake_msgs::ConfigureRequest offer;
  slots_.Offer(0, offer);
  EXPECT_NO_THROW(ExchangeMemory(offer.memory_pid, offer.memory_descriptor, kRun));
  EXPECT_THROW(ExchangeMemory(offer.memory_pid, offer.memory_descriptor, kRun + 1), std::exception);
}

TEST(SharedSlots, LeaveNothingBehind) {
  const auto has_memory = [] {
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);) {
      if (line.find("memfd:train_brake") != std::string::npos) return true;
    }
    return false;
  };
  const std::vector<train_dynamics::Rank> ranks = {{"wagon_001", 0, 2}};
  {
    const SharedSlots slots(ranks, kRun);
    EXPECT_TRUE(has_memory());
  }
  EXPECT_FALSE(has_memory());
}

}  // namespace
}  // namespace ltd_master
