#include "train_results/recorded_message.h"

#include <fmt/format.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <sstream>
#include <type_traits>

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

  /// Takes a header and gives its stamp. (The message's number depends on the publisher.)
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

/// The owner of an array's element.
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

/// The names of a message's fields, in the order of its definition.
template <class Message>
const std::vector<std::string>& FieldNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> found;
    std::istringstream definition(ros::message_traits::Definition<Message>::value());
    for (std::string line; std::getline(definition, line) && line.rfind("====", 0) != 0;) {
      std::istringstream words(line.substr(0, line.find('#')));
      std::string type, name;
      const bool is_constant = line.substr(0, line.find('#')).find('=') != std::string::npos;
      if (words >> type >> name && !is_constant) found.push_back(name);
    }
    return found;
  }();
  return names;
}

/// A stream that the fields of a message are written to, one after the other as its definition has them; notes in what
/// they differ from the recorded ones.
class Comparison {
 public:
  /// The owner of a field's elements. @param size  of an array; 0: a number by itself
  using OwnersOf = std::function<Owners(const std::string& name, std::size_t size)>;

  Comparison(const Bytes& recorded, const std::vector<std::string>& names, OwnersOf owners_of)
      : source_(recorded), names_(names), owners_of_(std::move(owners_of)) {}

  void next(const std_msgs::Header& header) {
    NextName();
    const std::optional<ros::Time> stamp = source_.TakeHeader();
    readable_ = stamp.has_value();
    if (readable_ && *stamp != header.stamp) {
      Add("header.stamp", {}, Text(stamp->toSec()) + " s", Text(header.stamp.toSec()) + " s");
    }
  }

  template <class T, std::enable_if_t<std::is_arithmetic_v<T>, int> = 0>
  void next(const T& repeated) {
    const std::string& quantity = NextName();
    T recorded{};
    if (!readable_ || !source_.Take(recorded)) return Fail();
    Judge(quantity, recorded, repeated, owners_of_(quantity, 0), 0);
  }

  /// An array of variable size.
  template <class T>
  void next(const std::vector<T>& repeated) {
    const std::string& quantity = NextName();
    if (TakeSize(quantity, repeated.size())) Elements(quantity, repeated);
  }

  /// An array of fixed size.
  template <class T, std::size_t n>
  void next(const boost::array<T, n>& repeated) {
    Elements(NextName(), repeated);
  }

  void next(const std::vector<std::string>& repeated) {
    const std::string& quantity = NextName();
    if (!TakeSize(quantity, repeated.size())) return;
    for (const std::string& text : repeated) {
      std::string recorded;
      if (!TakeSize(quantity, text.size()) || !source_.Take(static_cast<std::uint32_t>(text.size()), recorded)) {
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
  const std::string& NextName() { return names_.at(name_++); }

  template <class Array>
  void Elements(const std::string& quantity, const Array& repeated) {
    const Owners owners = owners_of_(quantity, repeated.size());
    for (std::size_t i = 0; i < repeated.size(); ++i) {
      typename Array::value_type recorded{};
      if (!readable_ || !source_.Take(recorded)) return Fail();
      Judge(quantity, recorded, repeated[i], owners, i);
    }
  }

  bool TakeSize(const std::string& quantity, std::size_t repeated) {
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
  void Judge(const std::string& quantity, T recorded, T repeated, const Owners& owners, std::size_t i) {
    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): bit by bit, 0.0 is not -0.0
    if (std::memcmp(&recorded, &repeated, sizeof recorded) == 0) return;
    if constexpr (std::is_floating_point_v<T>) {
      if (std::isnan(recorded) && std::isnan(repeated)) return;  // whose other bits no rule fixes
    }
    Add(quantity, owners(i), Text(recorded), Text(repeated));
  }

  void Add(const std::string& quantity, const Owner& owner, const std::string& recorded, const std::string& repeated) {
    differences_.push_back({owner.vehicle, quantity,
                            fmt::format("{}{}{} is {} in the bag, {} now", owner.text, owner.text.empty() ? "" : ": ",
                                        quantity, recorded, repeated)});
  }

  Source source_;
  const std::vector<std::string>& names_;
  std::size_t name_ = 0;  ///< the next one
  OwnersOf owners_of_;
  bool readable_ = true;
  std::vector<Difference> differences_;
};

template <class Message>
std::vector<Difference> CompareFields(const Bytes& recorded, const Message& repeated, Comparison::OwnersOf owners_of) {
  Comparison comparison(recorded, FieldNames<Message>(), std::move(owners_of));
  ros::serialization::Serializer<Message>::template allInOne<Comparison, const Message&>(comparison, repeated);
  return comparison.Finish();
}

/// The elements of all arrays belong to these, numbers by themselves to the train.
Comparison::OwnersOf OfArrays(const Owners& owners) {
  return [owners](const std::string&, std::size_t size) { return size == 0 ? Owners(Train) : owners; };
}

}  // namespace

std::optional<std::uint64_t> ExchangeOf(const Bytes& message) {
  Source source(message);
  std::uint64_t exchange = 0;
  if (!source.TakeHeader() || !source.Take(exchange)) return std::nullopt;
  return exchange;
}

std::vector<Difference> Compare(const Bytes& recorded, const train_brake_msgs::TrainState& repeated) {
  const std::size_t vehicles = repeated.vehicle_digest.size();
  return CompareFields(recorded, repeated, [vehicles](const std::string&, std::size_t size) -> Owners {
    if (size == 0) return Train;
    const std::size_t numbers = std::max<std::size_t>(1, size / vehicles);  // of each vehicle
    return [numbers](std::size_t i) { return Vehicle(i / numbers); };
  });
}

std::vector<Difference> Compare(const Bytes& recorded, const train_brake_msgs::InTrainForces& repeated) {
  return CompareFields(recorded, repeated, OfArrays(Connection));
}

std::vector<Difference> Compare(const Bytes& recorded, const train_brake_msgs::BrakePressures& repeated) {
  return CompareFields(recorded, repeated, OfArrays(Vehicle));
}

std::vector<Difference> Compare(const Bytes& recorded, const train_brake_msgs::EnergyLedger& repeated) {
  return CompareFields(recorded, repeated, OfArrays([&](std::size_t i) { return Owner{0, repeated.element[i]}; }));
}

std::vector<Difference> Compare(const Bytes& recorded, const train_brake_msgs::Slides& repeated) {
  return CompareFields(
      recorded, repeated, OfArrays([&](std::size_t i) {
        const int vehicle = static_cast<int>(repeated.vehicle[i]);
        return Owner{vehicle, fmt::format("slide of vehicle {}, wheelset {}", vehicle, repeated.wheelset[i])};
      }));
}

std::vector<Difference> Compare(const Bytes& recorded, const train_brake_msgs::WagonState& repeated) {
  const int number = static_cast<int>(repeated.vehicle);
  const std::string wagon = "vehicle " + std::to_string(number);
  const Owners whole = [&](std::size_t) { return Owner{number, wagon}; };
  const Owners body = [&](std::size_t i) { return Owner{number, wagon + ", " + train_dynamics::kBodyNames.at(i)}; };
  const Owners wheelset = [&](std::size_t i) { return Owner{number, fmt::format("{}, wheelset {}", wagon, i + 1)}; };
  const Owners nest = [&](std::size_t i) {
    const char* const half[] = {"front", "rear"};
    return Owner{number, fmt::format("{}, {} bogie, {} half", wagon, half[i / 2], half[i % 2])};
  };
  return CompareFields(recorded, repeated, [&](const std::string& name, std::size_t size) -> Owners {
    if (name == "exchange" || name == "vehicle") return Train;
    if (name.rfind("body_", 0) == 0) return body;
    if (name == "nest_compression_m" || name == "wedge_friction_n") return nest;
    return size == 0 ? whole : wheelset;
  });
}

}  // namespace train_results
