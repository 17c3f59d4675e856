#include "ltd_master/ranks/shared_slots.h"

#include <fcntl.h>
#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "train_dynamics/train/vehicle_block.h"

namespace ltd_master {
namespace {

using train_brake_msgs::ExchangeLayout;

constexpr std::uint32_t kSpareSlots = 64;      // for replacements
constexpr std::uint32_t kTextRoom = 1024;      // [bytes] for a fault or a refusal
constexpr std::uint32_t kYields[2] = {0, 50};  // of the two ways of FasterWay

std::uint32_t RequestRoom(int vehicles) {
  train_brake_msgs::StepRequest request;
  train_dynamics::ResizeLoads(vehicles, true, request);
  request.friction_patches.resize(3 * train_dynamics::kMostPatchesOnTheWay);
  return ros::serialization::serializationLength(request);
}

/// Of a reply with everything in it, and all vehicles in full detail.
std::uint32_t ReplyRoom(int vehicles) {
  const auto count = static_cast<std::size_t>(vehicles);
  train_brake_msgs::StepResponse reply;
  train_brake_msgs::RankRecord& record = reply.record;
  train_dynamics::ResizeReply(count, reply);
  train_dynamics::ResizeRecord(count, record);
  train_dynamics::ResizeEnergies(count, record);
  record.state_digest.resize(count);
  record.details.resize(count);
  record.wheelset_work_j.resize(count * 2 * train_dynamics::kMostWheelsets);
  record.slides.resize(count * train_dynamics::kMostWheelsets * train_dynamics::kSharedSlidesPerWheelset *
                       train_dynamics::kSlideNumbers);
  train_dynamics::BlockSnapshot snapshot;
  snapshot.states.assign(count, train_dynamics::StateRow(train_dynamics::MostStateNumbers()));
  reply.snapshot = train_dynamics::Encode(snapshot);
  return ros::serialization::serializationLength(reply) + kTextRoom;
}

std::system_error SystemError(const char* call) { return {errno, std::generic_category(), call}; }

}  // namespace

SharedSlots::SharedSlots(const std::vector<train_dynamics::Rank>& ranks, std::uint64_t run_id) : ranks_(ranks.size()) {
  int vehicles = 0;
  for (const train_dynamics::Rank& rank : ranks) vehicles = std::max(vehicles, rank.count);
  ExchangeLayout layout;
  layout.run_id = run_id;
  layout.slots = static_cast<std::uint32_t>(ranks.size()) + kSpareSlots;
  layout.request_room = RequestRoom(vehicles);
  layout.reply_room = ReplyRoom(vehicles);
  descriptor_ = memfd_create("train_brake", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (descriptor_ < 0) throw SystemError("memfd_create");
  try {
    if (ftruncate(descriptor_, static_cast<off_t>(layout.Size())) != 0) throw SystemError("ftruncate");
    if (fcntl(descriptor_, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0) throw SystemError("seals");
    if (pwrite(descriptor_, &layout, sizeof layout, 0) != sizeof layout) throw SystemError("pwrite");
    memory_ = std::make_unique<train_brake_msgs::ExchangeMemory>(getpid(), descriptor_, run_id);
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

SharedSlots::~SharedSlots() { close(descriptor_); }

std::uint32_t SharedSlots::NewSlot() {
  const ExchangeLayout& layout = memory_->layout();
  if (next_slot_ == layout.slots) return kNoSlot;
  // Memory is only promised until it is touched; a process that touches missing memory is killed by SIGBUS.
  const auto begin = static_cast<off_t>(layout.SlotOffset(next_slot_));
  if (posix_fallocate(descriptor_, begin, static_cast<off_t>(layout.SlotSize())) != 0) return kNoSlot;
  return next_slot_++;
}

void SharedSlots::Offer(int rank, train_brake_msgs::ConfigureRequest& request) {
  RankSlot& own = ranks_[rank];
  if (own.slot == kNoSlot) own.slot = NewSlot();
  request.memory_pid = own.slot == kNoSlot ? 0 : static_cast<std::uint32_t>(getpid());
  request.memory_descriptor = static_cast<std::uint32_t>(descriptor_);
  request.memory_slot = own.slot;
}

void SharedSlots::Settle(int rank, const train_brake_msgs::ConfigureResponse& response) {
  RankSlot& own = ranks_[rank];
  own.is_used = own.slot != kNoSlot && response.ok && response.memory_used;
  own.threads = response.threads;
}

void SharedSlots::Drop(int rank) { ranks_[rank] = {}; }

void SharedSlots::Send(const std::vector<train_brake_msgs::Step>& calls) {
  train_brake_msgs::ExchangeHead& head = memory_->head();
  std::int32_t used = 0;
  std::uint32_t threads = 0;
  for (const RankSlot& own : ranks_) {
    used += own.is_used ? 1 : 0;
    threads += own.is_used ? own.threads : 0;
  }
  if (call_ > 0 && threads > cores_) faster_.Took(std::chrono::duration<double>(end_ - begin_).count());
  begin_ = end_ = std::chrono::steady_clock::now();
  ++call_;
  seen_ = head.replies.count();
  head.yields.store(kYields[faster_.way()]);
  head.threads.store(threads);
  head.master_core.store(static_cast<std::uint32_t>(sched_getcpu()));
  head.unreplied.store(used);
  for (std::size_t rank = 0; rank < ranks_.size(); ++rank) {
    if (!ranks_[rank].is_used) continue;
    memory_->request(ranks_[rank].slot).Write(call_, calls[rank].request, memory_->layout().request_room);
  }
  head.requests.Notify();
}

void SharedSlots::Wait(double timeout_s) {
  train_brake_msgs::ExchangeHead& head = memory_->head();
  const bool has_core = head.threads < cores_;  // if not, a rank needs this one
  const bool is_notified =
      has_core ? spin_.Spin(head.replies, seen_) : train_brake_msgs::YieldUntil(head.replies, seen_, head.yields);
  if (!is_notified) head.replies.Wait(seen_, timeout_s);
  end_ = std::chrono::steady_clock::now();
  seen_ = head.replies.count();
}

SharedSlots::Reply SharedSlots::Read(int rank, train_brake_msgs::StepResponse& response) const {
  train_brake_msgs::MessageBuffer& buffer = memory_->reply(ranks_[rank].slot);
  if (buffer.call() != call_) return Reply::kNone;
  return buffer.Read(response, memory_->layout().reply_room) ? Reply::kRead : Reply::kTooLarge;
}

int SharedSlots::last_rank() const {
  const std::uint32_t slot = memory_->head().last_slot.load();
  const auto last =
      std::find_if(ranks_.begin(), ranks_.end(), [slot](const RankSlot& own) { return own.slot == slot; });
  return last == ranks_.end() ? -1 : static_cast<int>(last - ranks_.begin());
}

}  // namespace ltd_master
