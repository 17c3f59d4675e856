#include "ltd_master/ranks/service_link.h"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <ros/header.h>
#include <ros/this_node.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>
#include <system_error>

namespace ltd_master {
namespace {

constexpr std::size_t kBuffer = 4096;          // [bytes] read at once; more than most replies have
constexpr std::uint32_t kMaxHeader = 1 << 20;  // [bytes]
constexpr std::uint32_t kMaxReply = 1 << 28;   // [bytes]; 100000 vehicles in full detail have a third of that

LinkError SystemError(const std::string& what) {
  return LinkError(what + ": " + std::generic_category().message(errno));
}

bool WouldBlock() { return errno == EAGAIN || errno == EWOULDBLOCK; }

std::uint32_t ReadSize(std::uint8_t* data) {
  ros::serialization::IStream stream(data, sizeof(std::uint32_t));
  std::uint32_t size = 0;
  stream.next(size);
  return size;
}

}  // namespace

ServiceLink::ServiceLink(const std::string& service, const std::string& host, std::uint32_t port,
                         const std::string& md5sum, double timeout_s) {
  try {
    Connect(host, port, timeout_s);
    ShakeHands(service, md5sum, timeout_s);
  } catch (...) {
    Close();
    throw;
  }
}

ServiceLink::~ServiceLink() { Close(); }

void ServiceLink::Close() {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
}

void ServiceLink::Connect(const std::string& host, std::uint32_t port, double timeout_s) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, freeaddrinfo);
  if (error != 0) throw LinkError("cannot find the host " + host + ": " + gai_strerror(error));

  const std::string where = "cannot connect to " + host + ":" + std::to_string(port);
  for (const addrinfo* address = addresses.get(); address != nullptr; address = address->ai_next) {
    Close();
    descriptor_ = socket(address->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (descriptor_ < 0) continue;
    if (connect(descriptor_, address->ai_addr, address->ai_addrlen) == 0) break;
    if (errno == EINPROGRESS) {
      WaitFor(POLLOUT, timeout_s, "accept the connection");
      int outcome = 0;
      socklen_t size = sizeof outcome;
      getsockopt(descriptor_, SOL_SOCKET, SO_ERROR, &outcome, &size);
      if (outcome == 0) break;
      errno = outcome;
    }
    if (address->ai_next == nullptr) throw SystemError(where);
  }
  if (descriptor_ < 0) throw SystemError(where);
  const int on = 1;
  setsockopt(descriptor_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

void ServiceLink::ShakeHands(const std::string& service, const std::string& md5sum, double timeout_s) {
  const ros::M_string fields = {
      {"service", service}, {"md5sum", md5sum}, {"callerid", ros::this_node::getName()}, {"persistent", "1"}};
  boost::shared_array<std::uint8_t> header;
  std::uint32_t size = 0;
  ros::Header::write(fields, header, size);
  out_.resize(sizeof size + size);
  ros::serialization::OStream stream(out_.data(), static_cast<std::uint32_t>(out_.size()));
  stream.next(size);
  std::copy_n(header.get(), size, out_.begin() + sizeof size);
  written_ = 0;
  while (!Flush()) WaitFor(POLLOUT, timeout_s, "read our connection header");

  in_.resize(kBuffer);
  ReadAll(in_.data(), sizeof size, timeout_s);
  size = ReadSize(in_.data());
  if (size > kMaxHeader) throw LinkError("sent no connection header of TCPROS");
  in_.resize(std::max<std::size_t>(size, kBuffer));
  ReadAll(in_.data(), size, timeout_s);
  ros::Header reply;
  std::string error;
  if (!reply.parse(in_.data(), size, error) || reply.getValue("error", error)) throw LinkRefused(error);
}

void ServiceLink::WaitFor(short events, double timeout_s, const char* what) const {
  if (!Poll(events, timeout_s)) throw LinkError(std::string("does not ") + what);
}

bool ServiceLink::Wait(double timeout_s) const { return Poll(written_ < out_.size() ? POLLOUT : POLLIN, timeout_s); }

bool ServiceLink::Poll(short events, double timeout_s) const {
  pollfd entry{descriptor_, events, 0};
  return poll(&entry, 1, static_cast<int>(std::lround(1e3 * timeout_s))) > 0;
}

void ServiceLink::ReadAll(std::uint8_t* data, std::size_t size, double timeout_s) const {
  for (std::size_t have = 0; have < size;) {
    const ssize_t count = recv(descriptor_, data + have, size - have, 0);
    if (count == 0) throw LinkError("closed the connection");
    if (count > 0) {
      have += static_cast<std::size_t>(count);
    } else if (WouldBlock()) {
      WaitFor(POLLIN, timeout_s, "answer our connection header");
    } else if (errno != EINTR) {
      throw SystemError("connection broke");
    }
  }
}

bool ServiceLink::Flush() {
  while (written_ < out_.size()) {
    const ssize_t count = send(descriptor_, out_.data() + written_, out_.size() - written_, MSG_NOSIGNAL);
    if (count >= 0) {
      written_ += static_cast<std::size_t>(count);
    } else if (WouldBlock()) {
      return false;
    } else if (errno != EINTR) {
      throw SystemError("connection broke");
    }
  }
  return true;
}

bool ServiceLink::Fill() {
  while (received_ < expected_) {
    in_.resize(std::max({in_.size(), expected_, kBuffer}));
    const ssize_t count = recv(descriptor_, in_.data() + received_, in_.size() - received_, 0);
    if (count == 0) throw LinkError("closed the connection");
    if (count < 0) {
      if (WouldBlock()) return false;
      if (errno != EINTR) throw SystemError("connection broke");
      continue;
    }
    received_ += static_cast<std::size_t>(count);
    if (received_ < kPrefix) continue;
    const std::uint32_t size = ReadSize(in_.data() + 1);
    if (size > kMaxReply) throw LinkError("announced a reply of " + std::to_string(size) + " bytes");
    expected_ = kPrefix + size;
  }
  if (received_ > expected_) throw LinkError("sent more than one reply");
  if (in_[0] == 0) {
    throw LinkError("failed: " + std::string(in_.begin() + kPrefix, in_.begin() + static_cast<long>(expected_)));
  }
  return true;
}

void ServiceLink::ExpectSilence() const {
  std::uint8_t byte = 0;
  const ssize_t count = recv(descriptor_, &byte, 1, MSG_PEEK);
  if (count == 0) throw LinkError("closed the connection");
  if (count > 0) throw LinkError("sent data without a request");
  if (!WouldBlock() && errno != EINTR) throw SystemError("connection broke");
}

}  // namespace ltd_master
