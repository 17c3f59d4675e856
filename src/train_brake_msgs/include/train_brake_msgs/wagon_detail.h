#pragma once

#include <algorithm>

/// The one list of corresponding fields of WagonState and of its struct in the physics.
namespace train_brake_msgs {

/// Calls copy(field of the detail, field of the message) for all that a vehicle computes itself. What acts on
/// it from outside, its number and the time are not among these.
///
/// @tparam Detail   train_dynamics::WagonDetail
/// @tparam Message  WagonState
template <class Detail, class Message, class Copy>
void ForEachField(Detail& detail, Message& message, Copy copy) {
  copy(detail.position.x, message.body_x_m);
  copy(detail.position.z, message.body_z_m);
  copy(detail.position.pitch, message.body_pitch_rad);
  copy(detail.velocity.x, message.body_x_mps);
  copy(detail.velocity.z, message.body_z_mps);
  copy(detail.velocity.pitch, message.body_pitch_radps);
  copy(detail.output.normal_force_n, message.normal_force_n);
  copy(detail.output.creepage, message.creepage);
  copy(detail.output.creep_force_n, message.creep_force_n);
  copy(detail.output.shoe_force_n, message.shoe_force_n);
  copy(detail.nest_compression_m, message.nest_compression_m);
  copy(detail.output.wedge_friction_n, message.wedge_friction_n);
}

/// Copies an array of as many numbers, which may be of another type.
struct CopyNumbers {
  template <class From, class To>
  void operator()(const From& from, To& to) const {
    std::transform(from.begin(), from.end(), to.begin(),
                   [](auto value) { return static_cast<typename To::value_type>(value); });
  }
};

template <class Detail, class Message>
void DetailToMessage(const Detail& detail, Message& message) {
  ForEachField(detail, message, CopyNumbers());
}

template <class Detail, class Message>
void MessageToDetail(const Message& message, Detail& detail) {
  ForEachField(detail, message, [](auto& to, const auto& from) { CopyNumbers()(from, to); });
}

}  // namespace train_brake_msgs
