#include "train_node/running_node.h"

#include <netdb.h>
#include <poll.h>
#include <ros/header.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

namespace train_node {
namespace {

using Clock = std::chrono::steady_clock;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kLongestAnswer = 1 << 16;  // [bytes]

/// A connection to a service with a deadline for all that it does.
class Connection {
 public:
  Connection(const std::string& host, std::uint32_t port, Clock::time_point deadline) : deadline_(deadline) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* addresses = nullptr;
    if (getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &addresses) != 0) return;
    for (const addrinfo* a = addresses; a != nullptr && socket_ < 0; a = a->ai_next) Connect(*a);
    freeaddrinfo(addresses);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() {
    if (socket_ >= 0) close(socket_);
  }

  bool is_open() const { return socket_ >= 0; }

  bool Write(const Bytes& bytes) {
    for (std::size_t done = 0; done < bytes.size();) {
      if (!Wait(socket_, POLLOUT)) return false;
      const ssize_t count = send(socket_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
      if (count <= 0) return false;
      done += static_cast<std::size_t>(count);
    }
    return true;
  }

  std::optional<Bytes> Read(std::size_t size) {
    if (size > kLongestAnswer) return std::nullopt;
    Bytes bytes(size);
    for (std::size_t done = 0; done < size;) {
      if (!Wait(socket_, POLLIN)) return std::nullopt;
      const ssize_t count = recv(socket_, bytes.data() + done, size - done, 0);
      if (count <= 0) return std::nullopt;
      done += static_cast<std::size_t>(count);
    }
    return bytes;
  }

  /// A frame: its size in four bytes, and as many bytes.
  std::optional<Bytes> ReadFrame() {
    const std::optional<Bytes> prefix = Read(sizeof(std::uint32_t));
    if (!prefix) return std::nullopt;
    std::uint32_t size = 0;
    std::memcpy(&size, prefix->data(), sizeof size);
    return Read(size);
  }

 private:
  void Connect(const addrinfo& address) {
    const int candidate = socket(address.ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (candidate < 0) return;
    int error = connect(candidate, address.ai_addr, address.ai_addrlen) == 0 ? 0 : errno;
    if (error == EINPROGRESS && Wait(candidate, POLLOUT)) {
      socklen_t size = sizeof error;
      getsockopt(candidate, SOL_SOCKET, SO_ERROR, &error, &size);
    }
    if (error == 0) {
      socket_ = candidate;
    } else {
      close(candidate);
    }
  }

  bool Wait(int socket, short event) const {
    while (true) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline_ - Clock::now());
      if (left.count() <= 0) return false;
      pollfd wanted{socket, event, 0};
      const int ready = poll(&wanted, 1, static_cast<int>(left.count()));
      if (ready > 0) return true;
      if (ready < 0 && errno != EINTR) return false;
    }
  }

  Clock::time_point deadline_;
  int socket_ = -1;
};

Bytes Frame(const std::uint8_t* content, std::uint32_t size) {
  Bytes bytes(sizeof size + size);
  std::memcpy(bytes.data(), &size, sizeof size);
  if (size > 0) std::memcpy(bytes.data() + sizeof size, content, size);
  return bytes;
}

/// Exchanges connection headers of a service call. @return the name of the node that answers
std::optional<std::string> Greet(Connection& connection, const std::string& service, bool is_probe) {
  ros::M_string header{{"service", service}, {"md5sum", "*"}, {"callerid", ros::this_node::getName()}};
  if (is_probe) header["probe"] = "1";
  boost::shared_array<std::uint8_t> bytes;
  std::uint32_t size = 0;
  ros::Header::write(header, bytes, size);
  if (!connection.Write(Frame(bytes.get(), size))) return std::nullopt;
  std::optional<Bytes> answer = connection.ReadFrame();
  if (!answer) return std::nullopt;
  ros::Header parsed;
  std::string error, name;
  parsed.parse(answer->data(), static_cast<std::uint32_t>(answer->size()), error);
  parsed.getValue("callerid", name);
  return name;
}

/// Host and port of a service, as the ROS master has it.
std::optional<std::pair<std::string, std::uint32_t>> Lookup(const std::string& service) {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  request[1] = service;
  if (!ros::master::execute("lookupService", request, response, payload, false)) return std::nullopt;
  if (payload.getType() != XmlRpc::XmlRpcValue::TypeString) return std::nullopt;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(static_cast<std::string>(payload), host, port)) return std::nullopt;
  return std::pair(host, port);
}

/// A node's description of itself: the message in the reply of its service ~identify.
std::string Identify(const std::string& node, std::chrono::milliseconds patience) {
  const std::string service = node + "/" + kIdentifyService;
  const auto place = Lookup(service);
  if (!place) return "";
  Connection connection(place->first, place->second, Clock::now() + patience);
  if (!connection.is_open() || Greet(connection, service, false) != node) return "";
  if (!connection.Write(Frame(nullptr, 0))) return "";
  const std::optional<Bytes> ok = connection.Read(1);
  if (!ok || ok->front() != 1) return "";
  const std::optional<Bytes> reply = connection.ReadFrame();  // bool success, string message
  constexpr std::size_t kHead = sizeof(std::uint8_t) + sizeof(std::uint32_t);
  if (!reply || reply->size() < kHead) return "";
  return {reply->begin() + kHead, reply->end()};
}

}  // namespace

RunningNode FindRunningNode(const std::string& node, std::chrono::milliseconds patience) {
  // Every node has this service from its first moment, in C++ and in Python.
  const std::string service = node + "/get_loggers";
  const auto place = Lookup(service);
  if (!place) return {};
  Connection connection(place->first, place->second, Clock::now() + patience);
  if (!connection.is_open()) return {};
  const std::optional<std::string> name = Greet(connection, service, true);
  if (!name) return {RunningNode::State::kSilent, place->first, ""};
  if (*name != node) return {};  // the port belongs to another one by now
  return {RunningNode::State::kAlive, place->first, Identify(node, patience)};
}

RunningNode FindNodeOfOwnName() {
  constexpr std::chrono::milliseconds kPatience(2000);
  return FindRunningNode(ros::this_node::getName(), kPatience);
}

}  // namespace train_node
