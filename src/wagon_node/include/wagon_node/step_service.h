#pragma once

#include <ros/header.h>
#include <ros/poll_set.h>
#include <ros/transport/transport_tcp.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace wagon_node {

/// The service ~step for masters on other machines, and for any other client of TCPROS.
///
/// Like any ROS service, but faster: three system calls per call (wait, read, write) instead of roscpp's thirteen, no
/// copies of the messages, and any request is handled safely. It has a thread of its own, which sleeps until a call
/// arrives.
class StepService {
 public:
  /// Reads a request, and appends the response to the reply. Its exceptions are reported to the caller.
  using Answer = std::function<void(std::uint8_t* request, std::uint32_t size, std::vector<std::uint8_t>& reply)>;

  /// Advertises the service.
  /// @param name    resolved
  /// @param answer  called by the thread of the service
  /// @throws std::runtime_error if it cannot listen
  StepService(const std::string& name, Answer answer);
  ~StepService();
  StepService(const StepService&) = delete;
  StepService& operator=(const StepService&) = delete;

  /// The address at which it listens, as registered at a ROS master.
  std::string uri() const;

 private:
  struct Client;
  using ClientPtr = std::shared_ptr<Client>;

  void Accept(const ros::TransportTCPPtr& transport);
  void Read(const ros::TransportPtr& transport);
  void Write(const ros::TransportPtr& transport);
  void ServeFrames(Client& client);
  void Serve(Client& client, std::uint8_t* frame, std::uint32_t size);
  void Greet(Client& client, const ros::Header& header);
  bool Flush(Client& client);
  void Tell(const char* method, bool is_there) const;

  const std::string name_;
  const Answer answer_;
  ros::PollSet sockets_;
  ros::TransportTCPPtr listener_;
  std::map<const ros::Transport*, ClientPtr> clients_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace wagon_node
