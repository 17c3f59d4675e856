#pragma once

#include <ros/serialization.h>
#include <std_msgs/Header.h>
#include <train_brake_msgs/BrakePressures.h>
#include <train_brake_msgs/InTrainForces.h>
#include <train_brake_msgs/TrainState.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "train_dynamics/brake/pneumatic/brake_record.h"
#include "train_dynamics/vehicle/vehicle_record.h"

/// Messages that are serialised directly from a record's numbers, without a message object.
///
/// A view has the fields of its message, by name; an array of numbers is one of the record's, converted as it is
/// written. The order of the fields is that of the message, whose serialiser also writes the view, to the same bytes.
namespace train_results {

/// An array of a record as an array of a message with elements `To`.
template <class To, class From = double>
struct ArrayView {
  const From* from = nullptr;
  std::size_t count = 0;
};

template <class To, class Numbers>
void View(const Numbers& numbers, ArrayView<To, typename Numbers::value_type>& view) {
  view = {numbers.data(), numbers.size()};
}

/// The view of an array of that message.
#define TRAIN_RESULTS_VIEW_OF(Message, name) \
  ArrayView<typename decltype(train_brake_msgs::Message::name)::value_type> name

struct TrainStateView {
  using Message = train_brake_msgs::TrainState;
  std_msgs::Header header;
  std::uint64_t exchange = 0;
#define TRAIN_RESULTS_FIELD(name, numbers, unit, presence, meaning) TRAIN_RESULTS_VIEW_OF(TrainState, name);
  TRAIN_DYNAMICS_VEHICLE_RECORD(TRAIN_RESULTS_FIELD)
#undef TRAIN_RESULTS_FIELD
  TRAIN_RESULTS_VIEW_OF(TrainState, acceleration_mps2);
  ArrayView<std::uint64_t, std::uint64_t> vehicle_digest;
  std::uint64_t state_digest = 0;
};

struct InTrainForcesView {
  using Message = train_brake_msgs::InTrainForces;
  std_msgs::Header header;
  std::uint64_t exchange = 0;
  TRAIN_RESULTS_VIEW_OF(InTrainForces, coupler_force_n);
  TRAIN_RESULTS_VIEW_OF(InTrainForces, coupler_extension_m);
};

struct BrakePressuresView {
  using Message = train_brake_msgs::BrakePressures;
  std_msgs::Header header;
  std::uint64_t exchange = 0;
  TRAIN_RESULTS_VIEW_OF(BrakePressures, cylinder_pressure_pa);
#define TRAIN_RESULTS_FIELD(name, unit, meaning) TRAIN_RESULTS_VIEW_OF(BrakePressures, name);
  TRAIN_DYNAMICS_BRAKE_RECORD(TRAIN_RESULTS_FIELD)
#undef TRAIN_RESULTS_FIELD
};

#undef TRAIN_RESULTS_VIEW_OF

/// As ros::serialization::serializationLength and serialize, of the view's message.
template <class View>
std::uint32_t SerializedLength(const View& view) {
  ros::serialization::LStream stream;
  ros::serialization::Serializer<typename View::Message>::template allInOne<ros::serialization::LStream, const View&>(
      stream, view);
  return stream.getLength();
}
template <class View>
void Serialize(ros::serialization::OStream& stream, const View& view) {
  ros::serialization::Serializer<typename View::Message>::template allInOne<ros::serialization::OStream, const View&>(
      stream, view);
}

}  // namespace train_results

namespace ros::serialization {

template <class To, class From>
struct Serializer<train_results::ArrayView<To, From>> {
  template <class Stream>
  static void write(Stream& stream, const train_results::ArrayView<To, From>& view) {
    stream.next(static_cast<std::uint32_t>(view.count));
    std::uint8_t* to = stream.advance(static_cast<std::uint32_t>(view.count * sizeof(To)));
    if constexpr (std::is_same_v<To, From>) {
      if (view.count > 0) std::memcpy(to, view.from, view.count * sizeof(To));
    } else {
      std::array<To, 64> block;  // converted in packs, then copied to where there is no alignment
      for (std::size_t first = 0; first < view.count; first += block.size()) {
        const std::size_t count = std::min(block.size(), view.count - first);
        for (std::size_t i = 0; i < count; ++i) block[i] = static_cast<To>(view.from[first + i]);
        std::memcpy(to + first * sizeof(To), block.data(), count * sizeof(To));
      }
    }
  }
  static std::uint32_t serializedLength(const train_results::ArrayView<To, From>& view) {
    return static_cast<std::uint32_t>(sizeof(std::uint32_t) + view.count * sizeof(To));
  }
};

}  // namespace ros::serialization
