#pragma once

#include <ros/serialization.h>
#include <train_brake_msgs/bounded_stream.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace ltd_master {

/// A connection that cannot be made, broke, or carried unexpected data; what() says why.
class LinkError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The other side refuses the connection, for instance because its service has another definition.
class LinkRefused : public LinkError {
  using LinkError::LinkError;
};

/// A persistent, non-blocking connection to the service of another node: TCPROS without threads.
///
///   once      each side: uint32 length, then key=value fields, each with its uint32 length
///   per call  there: uint32 length, request; back: uint8 ok, uint32 length, response or error text
///
/// Numbers are little-endian (wiki.ros.org/ROS/TCPROS). One call at a time. Buffers are kept from call to
/// call.
class ServiceLink {
 public:
  /// Connects and shakes hands.
  /// @param timeout_s  for each of the two
  /// @throws LinkError
  ServiceLink(const std::string& service, const std::string& host, std::uint32_t port, const std::string& md5sum,
              double timeout_s);
  ~ServiceLink();
  ServiceLink(const ServiceLink&) = delete;
  ServiceLink& operator=(const ServiceLink&) = delete;

  int descriptor() const { return descriptor_; }

  /// Writes a request, as far as the socket takes it; Receive() writes the rest.
  template <class Request>
  void Send(const Request& request) {
    const std::uint32_t size = ros::serialization::serializationLength(request);
    out_.resize(sizeof size + size);
    ros::serialization::OStream stream(out_.data(), static_cast<std::uint32_t>(out_.size()));
    stream.next(size);
    stream.next(request);
    written_ = 0;
    Flush();
  }

  /// Reads a response, as far as it has come.
  /// @return whether it is complete
  template <class Response>
  bool Receive(Response& response) {
    if (!Flush() || !Fill()) return false;
    train_brake_msgs::ReadMessage(in_.data() + kPrefix, static_cast<std::uint32_t>(expected_ - kPrefix), response);
    received_ = 0;
    expected_ = kPrefix;
    return true;
  }

  /// @return whether the rest of the request can be written, or else a reply can be read, within that time
  bool Wait(double timeout_s) const;

  /// Checks that nothing arrives outside a call. @throws LinkError if something does, such as the end of the connection
  void ExpectSilence() const;

 private:
  static constexpr std::size_t kPrefix = 5;  ///< bytes before a response

  void Connect(const std::string& host, std::uint32_t port, double timeout_s);
  void ShakeHands(const std::string& service, const std::string& md5sum, double timeout_s);
  void Close();
  bool Poll(short events, double timeout_s) const;
  void WaitFor(short events, double timeout_s, const char* what) const;
  void ReadAll(std::uint8_t* data, std::size_t size, double timeout_s) const;
  bool Flush();
  bool Fill();

  int descriptor_ = -1;
  std::vector<std::uint8_t> out_, in_;
  std::size_t written_ = 0;
  std::size_t received_ = 0;
  std::size_t expected_ = kPrefix;  ///< bytes, as far as is known yet
};

}  // namespace ltd_master
