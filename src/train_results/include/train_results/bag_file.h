#pragma once

#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "train_dynamics/train/byte_stream.h"

namespace train_results {

using train_dynamics::Bytes;

/// A bag that cannot be read; what() says why.
class UnreadableBag : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The messages of a bag (format 2.0, not compressed) that may be damaged, forged or cut off.
///
/// Reads the file's records from front to back and needs no index, so that the bag of a killed recorder is readable
/// up to its last whole message. Memory is allocated only for data that the file really holds. (rosbag::Bag trusts the
/// sizes and positions in a damaged bag.)
class BagFile {
 public:
  struct Place {
    std::uint64_t position = 0;
    std::uint32_t size = 0;
  };
  struct Topic {
    std::string name, type, md5sum;
    std::vector<Place> messages;  ///< in the order in which they were recorded
  };

  /// @throws UnreadableBag
  explicit BagFile(const std::string& file);

  const std::vector<Topic>& topics() const { return topics_; }
  Bytes Read(const Place& message);

 private:
  class Scan;

  std::ifstream stream_;
  std::vector<Topic> topics_;
};

}  // namespace train_results
