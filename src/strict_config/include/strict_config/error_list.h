#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace strict_config {

/// The path of a key in a configuration, "consist[2].vehicle.mass_kg", for messages.
struct KeyPath {
  KeyPath(std::string path = "", std::size_t part_begin = 0) : text(std::move(path)), part(part_begin) {}
  KeyPath(const char* path) : KeyPath(std::string(path)) {}

  std::string text;
  std::size_t part = 0;  ///< where the path within the innermost referenced part begins
};

/// All errors of a configuration, so that a user can repair them at once.
///
/// Text() lists the errors by file (in the order of their first errors) and line, one per line: "wagon.yaml:12:
/// contact.friction_coefficient must be > 0, got -0.4".
class ErrorList {
 public:
  /// Adds an error of the user.
  /// @param file  the file as the user would write it, or an override as it was given ("--set a=1")
  /// @param line  counted from 1; 0: the error belongs to the whole file, and no line is shown
  /// @param path  of the key; may be empty
  /// @param text  what is wrong with it
  ///
  /// The same error of one part is reported once, even when the part is used in many places (one vehicle file
  /// throughout a train).
  void Add(const std::string& file, int line, const KeyPath& path, const std::string& text);

  bool empty() const { return count_ == 0; }
  /// The number of errors, including those that were not kept.
  std::size_t size() const { return count_; }
  /// The number of calls of Add, repeated errors included.
  std::size_t reports() const { return reports_; }
  /// Whether the list is full: further errors are only counted.
  bool full() const { return errors_.size() >= kKept; }

  /// Whether an error concerns a path: it was reported at the path, below it, or above it where `is_read` says that the
  /// map there was not read. "[]" in the path stands for every index: "consist[].count".
  bool Concerns(const std::string& path, const std::function<bool(const std::string&)>& is_read) const;

  /// The first `shown` errors, one per line, and the number of further ones.
  std::string Text(std::size_t shown = 50) const;

 private:
  static constexpr std::size_t kKept = 1000;

  struct Error {
    std::size_t file_order;
    int line;
    std::string text;
  };
  std::vector<Error> errors_;
  std::size_t count_ = 0;
  std::size_t reports_ = 0;
  std::map<std::string, std::size_t> file_order_;
  std::set<std::string> seen_;
  std::set<std::string> paths_;  ///< of what was reported, as long as not full()
};

/// A configuration that cannot be used; what() is ErrorList::Text().
class Error : public std::runtime_error {
 public:
  explicit Error(const ErrorList& errors) : std::runtime_error(errors.Text()) {}
};

}  // namespace strict_config
