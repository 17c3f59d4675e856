#include "train_results/recorded_message.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <type_traits>

#include "strict_config/text_file.h"
#include "train_dynamics/vehicle/wagon.h"

namespace train_results {
namespace {

/// The bytes of a message, value by value (little-endian; arrays and texts after their length).
class Source {
 public:
  explicit Source(const Bytes& bytes) : bytes_(bytes) {}

  std::size_t left() const { return bytes_.size() - at_; }

  template <class T>
  bool Take(T& value) {
    static_assert(std::is_arithmetic_v<T>);
    if (left() < sizeof value) return false;
    std::memcpy(&value, &bytes_[at_], sizeof value);
    at_ += sizeof value;
    return true;
  }

  /// Takes a header and gives its stamp. (What number a message has is the publisher's business.)
  std::optional<ros::Time> TakeHeader() {
    std::uint32_t number = 0, seconds = 0, nanoseconds = 0, frame_id = 0;
    if (!Take(number) || !Take(seconds) || !Take(nanoseconds) || !Take(frame_id) || left() < frame_id)
      return std::nullopt;
    at_ += frame_id;
    ros::Time stamp;
    stamp.sec = seconds;
    stamp.nsec = nanoseconds;
    return stamp;
  }

  /// Takes a text if it is as long as this one.
  bool Take(std::uint32_t size, std::string& text) {
    if (left() < size) return false;
    text.assign(bytes_.begin() + static_cast<long>(at_), bytes_.begin() + static_cast<long>(at_ + size));
    at_ += size;
    return true;
  }

 private:
  const Bytes& bytes_;
  std::size_t at_ = 0;
};

/// What an element of an array belongs to.
struct Owner {
  int vehicle = 0;
  std::string text;
};
using Owners = std::function<Owner(std::size_t index)>;

Owner Train(std::size_t) { return {}; }
Owner Vehicle(std::size_t i) {
  const int number = static_cast<int>(i) + 1;
  return {number, "vehicle " + std::to_string(number)};
}
Owner Connection(std::size_t i) { return {0, "connection " + std::to_string(i + 1)}; }

template <class T>
std::string Text(T value) {
  return fmt::format("{}", value);
}

/// Walks through a message's fields and notes what differs.
class Comparison {
 public:
  Comparison(const Bytes& recorded, const std_msgs::Header& header) : source_(recorded) {
    const std::optional<ros::Time> stamp = source_.TakeHeader();
    readable_ = stamp.has_value();
    if (readable_ && *stamp != header.stamp) {
      Add("header.stamp", {}, Text(stamp->toSec()) + " s", Text(header.stamp.toSec()) + " s");
    }
  }

  template <class T>
  void Number(const char* quantity, T repeated, const Owners& owners = Train) {
    T recorded{};
    if (!readable_ || !source_.Take(recorded)) return Fail();
    Judge(quantity, recorded, repeated, owners, 0);
  }

  /// An array of variable size.
  template <class Array>
  void Numbers(const char* quantity, const Array& repeated, const Owners& owners) {
    if (TakeSize(quantity, repeated.size())) Elements(quantity, repeated, owners);
  }

  /// An array of fixed size, or the elements of another one.
  template <class Array>
  void Elements(const char* quantity, const Array& repeated, const Owners& owners) {
    for (std::size_t i = 0; i < repeated.size(); ++i) {
      typename Array::value_type recorded{};
      if (!readable_ || !source_.Take(recorded)) return Fail();
      Judge(quantity, recorded, repeated[i], owners, i);
    }
  }

  void Texts(const char* quantity, const std::vector<std::string>& repeated) {
    if (!TakeSize(quantity, repeated.size())) return;
    for (const std::string& text : repeated) {
      std::string recorded;
      if (!TakeSize(quantity, text.size()) ||
          !source_.Take(static_cast<std::uint32_t>(text.size()), recorded)) {
        return Fail();
      }
      if (recorded != text) Add(quantity, {}, recorded, text);
    }
  }

  /// At the message's end.
  std::vector<Difference> Finish() {
    if (readable_ && source_.left() > 0) Fail();
    if (!readable_ && differences_.empty()) {
      differences_.push_back({0, "", "a message is not as long as its definition says"});
    }
    return std::move(differences_);
  }

 private:
  void Fail() { readable_ = false; }

  bool TakeSize(const char* quantity, std::size_t repeated) {
    std::uint32_t recorded = 0;
    if (!readable_ || !source_.Take(recorded)) {
      Fail();
    } else if (recorded != repeated) {
      Add(quantity, {}, fmt::format("of size {}", recorded), Text(repeated));
      Fail();
    }
    return readable_;
  }

  template <class T>
  void Judge(const char* quantity, T recorded, T repeated, const Owners& owners, std::size_t i) {
    if (std::memcmp(&recorded, &repeated, sizeof recorded) == 0) return;  // bit by bit: 0.0 is not -0.0
    if constexpr (std::is_floating_point_v<T>) {
      if (std::isnan(recorded) && std::isnan(repeated)) return;  // whose other bits no rule fixes
    }
    Add(quantity, owners(i), Text(recorded), Text(repeated));
  }

  void Add(const std::string& quantity, const Owner& owner, const std::string& recorded,
           const std::string& repeated) {
    differences_.push_back({owner.vehicle, quantity,
                            fmt::format("{}{}{} is {} in the bag, {} now", owner.text,
                                        owner.text.empty() ? "" : ": ", quantity, recorded, repeated)});
  }

  Source source_;
  bool readable_;
  std::vector<Difference> differences_;
};

}  // namespace

std::string Presentable(std::string text) {
  strict_config::ErrorList complaints;
  if (strict_config::IsCleanText(text, "", complaints)) return text;
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

std::optional<std::uint64_t> ExchangeOf(const Bytes& message) {
  Source source(message);
  std::uint64_t exchange = 0;
  if (!source.TakeHeader() || !source.Take(exchange)) return std::nullopt;
  return exchange;
}

std::vector<Difference> Compare(const Bytes& recorded, const train_brake_msgs::TrainState& repeated) {
  Comparison comparison(recorded, repeated.header);
  comparison.Number("exchange", repeated.exchange);
  comparison.Numbers("position_m", repeated.position_m, Vehicle);
  comparison.Numbers("speed_mps", repeated.speed_mps, Vehicle);
  comparison.Numbers("acceleration_mps2", repeated.acceleration_mps2, Vehicle);
  comparison.Numbers("shoe_force_n", repeated.shoe_force_n, Vehicle);
  comparison.Numbers("wheel_force_n", repeated.wheel_force_n, Vehicle);
  comparison.Numbers("creepage", repeated.creepage, Vehicle);
  comparison.Numbers("vehicle_digest", repeated.vehicle_digest, Vehicle);
  comparison.Number("state_digest", repeated.state_digest);
  return comparison.Finish();
}

std::vector<Difference> Compare(const Bytes& recorded, const train_brake_msgs::InTrainForces& repeated) {
  Comparison comparison(recorded, repeated.header);
  comparison.Number("exchange", repeated.exchange);
  comparison.Numbers("coupler_force_n", repeated.coupler_force_n, Connection);
  comparison.Numbers("coupler_deflection_m", repeated.coupler_deflection_m, Connection);
  return comparison.Finish();
}

std::vector<Difference> Compare(const Bytes& recorded, const train_brake_msgs::BrakePressures& repeated) {
  Comparison comparison(recorded, repeated.header);
  comparison.Number("exchange", repeated.exchange);
  comparison.Numbers("cylinder_pressure_pa", repeated.cylinder_pressure_pa, Vehicle);
  return comparison.Finish();
}

std::vector<Difference> Compare(const Bytes& recorded, const train_brake_msgs::EnergyLedger& repeated) {
  Comparison comparison(recorded, repeated.header);
  comparison.Number("exchange", repeated.exchange);
  comparison.Texts("element", repeated.element);
  comparison.Numbers("dissipated_j", repeated.dissipated_j, [&](std::size_t i) {
    return Owner{0, repeated.element[i]};
  });
  comparison.Number("initial_j", repeated.initial_j);
  comparison.Number("kinetic_j", repeated.kinetic_j);
  comparison.Number("potential_j", repeated.potential_j);
  comparison.Number("gravity_work_j", repeated.gravity_work_j);
  comparison.Number("traction_work_j", repeated.traction_work_j);
  comparison.Number("residual_j", repeated.residual_j);
  return comparison.Finish();
}

std::vector<Difference> Compare(const Bytes& recorded, const train_brake_msgs::WagonState& repeated) {
  const int number = static_cast<int>(repeated.vehicle);
  const std::string wagon = "vehicle " + std::to_string(number);
  const Owners whole = [&](std::size_t) { return Owner{number, wagon}; };
  const Owners body = [&](std::size_t i) {
    return Owner{number, wagon + ", " + train_dynamics::kBodyNames.at(i)};
  };
  const Owners wheelset = [&](std::size_t i) {
    return Owner{number, fmt::format("{}, wheelset {}", wagon, i + 1)};
  };
  const Owners nest = [&](std::size_t i) {
    const char* const half[] = {"front", "rear"};
    return Owner{number, fmt::format("{}, {} bogie, {} half", wagon, half[i / 2], half[i % 2])};
  };
  Comparison comparison(recorded, repeated.header);
  comparison.Number("exchange", repeated.exchange);
  comparison.Number("vehicle", repeated.vehicle);
  comparison.Elements("body_x_m", repeated.body_x_m, body);
  comparison.Elements("body_z_m", repeated.body_z_m, body);
  comparison.Elements("body_pitch_rad", repeated.body_pitch_rad, body);
  comparison.Elements("body_x_mps", repeated.body_x_mps, body);
  comparison.Elements("body_z_mps", repeated.body_z_mps, body);
  comparison.Elements("body_pitch_radps", repeated.body_pitch_radps, body);
  comparison.Elements("wheel_normal_force_n", repeated.wheel_normal_force_n, wheelset);
  comparison.Elements("creepage", repeated.creepage, wheelset);
  comparison.Elements("creep_force_n", repeated.creep_force_n, wheelset);
  comparison.Elements("shoe_force_n", repeated.shoe_force_n, wheelset);
  comparison.Elements("spring_deflection_m", repeated.spring_deflection_m, nest);
  comparison.Elements("wedge_force_n", repeated.wedge_force_n, nest);
  comparison.Number("front_coupler_force_n", repeated.front_coupler_force_n, whole);
  comparison.Number("rear_coupler_force_n", repeated.rear_coupler_force_n, whole);
  comparison.Number("cylinder_pressure_pa", repeated.cylinder_pressure_pa, whole);
  return comparison.Finish();
}

}  // namespace train_results
