#include "wagon_node/step_service.h"

#include <ros/common.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/serialization.h>
#include <ros/service_traits.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>
#include <train_brake_msgs/Step.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace wagon_node {
namespace {

using train_brake_msgs::Step;

constexpr std::size_t kPrefix = 4;              // [bytes] a frame's size
constexpr std::size_t kBuffer = 4096;           // [bytes] read at once; more than most requests have
constexpr std::uint32_t kMaxHeader = 1 << 20;   // [bytes]
constexpr std::uint32_t kMaxRequest = 1 << 26;  // of four million vehicles
constexpr int kBacklog = 100;
constexpr int kForEver = -1;

std::uint32_t SizeAt(const std::uint8_t* bytes) {
  std::uint32_t size = 0;
  std::memcpy(&size, bytes, sizeof size);
  return size;
}

void AppendSize(std::size_t size, std::vector<std::uint8_t>& bytes) {
  const auto number = static_cast<std::uint32_t>(size);
  const auto* begin = reinterpret_cast<const std::uint8_t*>(&number);
  bytes.insert(bytes.end(), begin, begin + sizeof number);
}

std::string ValueOf(const ros::Header& header, const char* key) {
  std::string value;
  header.getValue(key, value);
  return value;
}

}  // namespace

/// A connection: first a header comes, then requests, each as a frame of its size and as many bytes.
struct StepService::Client {
  ros::TransportTCPPtr transport;
  std::vector<std::uint8_t> in, out;
  std::size_t received = 0;  ///< of what is in `in`
  std::size_t written = 0;   ///< of `out`
  bool is_greeted = false;
  bool is_leaving = false;  ///< when `out` has been written
  bool is_persistent = false;
};

StepService::StepService(const std::string& name, Answer answer) : name_(name), answer_(std::move(answer)) {
  listener_ = boost::make_shared<ros::TransportTCP>(&sockets_);
  if (!listener_->listen(0, kBacklog, [this](const ros::TransportTCPPtr& client) { Accept(client); })) {
    throw std::runtime_error("cannot listen for calls of " + name);
  }
  thread_ = std::thread([this] {
    ros::disableAllSignalsInThisThread();
    while (!ending_) sockets_.update(kForEver);
  });
  Tell("registerService", true);
}

StepService::~StepService() {
  Tell("unregisterService", false);
  ending_ = true;
  sockets_.signal();
  thread_.join();
  listener_->close();
  while (!clients_.empty()) clients_.begin()->second->transport->close();
}

std::string StepService::uri() const {
  return "rosrpc://" + ros::network::getHost() + ":" + std::to_string(listener_->getServerPort());
}

/// Registers the service at the ROS master, or unregisters it.
void StepService::Tell(const char* method, bool is_there) const {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  request[1] = name_;
  request[2] = uri();
  if (is_there) request[3] = ros::XMLRPCManager::instance()->getServerURI();
  ros::master::execute(method, request, response, payload, is_there);
}

void StepService::Accept(const ros::TransportTCPPtr& transport) {
  const auto client = std::make_shared<Client>();
  client->transport = transport;
  clients_[transport.get()] = client;
  transport->setDisconnectCallback([this](const ros::TransportPtr& gone) { clients_.erase(gone.get()); });
  transport->setReadCallback([this](const ros::TransportPtr& ready) { Read(ready); });
  transport->setWriteCallback([this](const ros::TransportPtr& ready) { Write(ready); });
  transport->setNoDelay(true);
  transport->enableRead();
}

void StepService::Read(const ros::TransportPtr& transport) {
  const auto found = clients_.find(transport.get());
  if (found == clients_.end()) return;
  const ClientPtr client = found->second;  // lives on here if it disconnects
  std::vector<std::uint8_t>& in = client->in;
  // The buffer grows with the received bytes, not with the announced size.
  in.resize(std::max({in.size(), kBuffer, 2 * client->received}));
  const std::int32_t count =
      transport->read(in.data() + client->received, static_cast<std::uint32_t>(in.size() - client->received));
  if (count <= 0) return;
  client->received += static_cast<std::size_t>(count);
  ServeFrames(*client);
}

void StepService::Write(const ros::TransportPtr& transport) {
  const auto found = clients_.find(transport.get());
  if (found == clients_.end()) return;
  const ClientPtr client = found->second;
  if (!Flush(*client)) return;
  transport->disableWrite();
  transport->enableRead();
  ServeFrames(*client);
}

/// Serves what has come, as long as the replies can be written.
void StepService::ServeFrames(Client& client) {
  std::size_t begin = 0;
  while (!client.is_leaving && client.received - begin >= kPrefix) {
    std::uint8_t* frame = client.in.data() + begin;
    const std::uint32_t size = SizeAt(frame);
    if (size > (client.is_greeted ? kMaxRequest : kMaxHeader)) return client.transport->close();
    if (client.received - begin < kPrefix + size) break;
    Serve(client, frame + kPrefix, size);
    begin += kPrefix + size;
    if (Flush(client)) continue;
    client.transport->disableRead();
    client.transport->enableWrite();
    break;
  }
  std::copy(client.in.begin() + static_cast<long>(begin), client.in.begin() + static_cast<long>(client.received),
            client.in.begin());
  client.received -= begin;
}

void StepService::Serve(Client& client, std::uint8_t* frame, std::uint32_t size) {
  client.out.clear();
  client.written = 0;
  if (!client.is_greeted) {
    ros::Header header;
    std::string error;
    if (!header.parse(frame, size, error)) {
      client.is_leaving = true;
    } else {
      Greet(client, header);
    }
    return;
  }
  client.out = {1, 0, 0, 0, 0};  // it went well; the size follows
  const std::size_t head = client.out.size();
  try {
    answer_(frame, size, client.out);
  } catch (const std::exception& e) {
    const std::string why = e.what();
    client.out = {0, 0, 0, 0, 0};
    client.out.insert(client.out.end(), why.begin(), why.end());
  }
  const auto length = static_cast<std::uint32_t>(client.out.size() - head);
  std::memcpy(client.out.data() + 1, &length, sizeof length);
  client.is_leaving = !client.is_persistent;
}

void StepService::Greet(Client& client, const ros::Header& header) {
  const std::string ours = ros::service_traits::md5sum<Step>(), theirs = ValueOf(header, "md5sum");
  ros::M_string reply;
  if (theirs == ours || theirs == "*") {
    reply = {{"callerid", ros::this_node::getName()},
             {"md5sum", ours},
             {"type", ros::service_traits::datatype<Step>()},
             {"request_type", ros::message_traits::datatype<Step::Request>()},
             {"response_type", ros::message_traits::datatype<Step::Response>()}};
  } else {
    reply = {{"error", "client wants service " + name_ + " to have md5sum " + theirs + ", but it has " + ours +
                           ". Dropping connection."}};
    client.is_leaving = true;
  }
  boost::shared_array<std::uint8_t> bytes;
  std::uint32_t size = 0;
  ros::Header::write(reply, bytes, size);
  AppendSize(size, client.out);
  client.out.insert(client.out.end(), bytes.get(), bytes.get() + size);
  client.is_greeted = true;
  const std::string persistent = ValueOf(header, "persistent");
  client.is_persistent = persistent == "1" || persistent == "true";
}

/// @return whether all is written
bool StepService::Flush(Client& client) {
  while (client.written < client.out.size()) {
    const std::int32_t count = client.transport->write(client.out.data() + client.written,
                                                       static_cast<std::uint32_t>(client.out.size() - client.written));
    if (count < 0) {  // the connection has ended
      client.is_leaving = true;
      return true;
    }
    if (count == 0) return false;
    client.written += static_cast<std::size_t>(count);
  }
  if (client.is_leaving) client.transport->close();
  return true;
}

}  // namespace wagon_node
