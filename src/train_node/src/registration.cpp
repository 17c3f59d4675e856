#include "train_node/registration.h"

#include <ros/connection_manager.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace train_node {
namespace {

using XmlRpc::XmlRpcValue;

/// A call of the ROS master with this node's name as the first argument. @return whether it went well
template <class... Arguments>
bool Call(const char* method, XmlRpcValue& payload, const Arguments&... arguments) {
  XmlRpcValue request, response;
  int i = 0;
  request[i++] = ros::this_node::getName();
  ((request[i++] = arguments), ...);
  return ros::master::execute(method, request, response, payload, false);
}

/// Calls this node's own server, which ROS masters call. @return its answer; invalid if there is none
XmlRpcValue CallSelf(const char* method, const XmlRpcValue& request) {
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(ros::XMLRPCManager::instance()->getServerURI(), host, port)) return {};
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  XmlRpcValue response;  // code, message, answer
  if (!client.execute(method, request, response) || response.getType() != XmlRpcValue::TypeArray) return {};
  return response.size() == 3 ? response[2] : XmlRpcValue();
}

/// Name and type of each topic that this node publishes (getPublications) or hears (getSubscriptions).
std::vector<std::pair<std::string, std::string>> OwnTopics(const char* method) {
  XmlRpcValue request;
  request[0] = ros::this_node::getName();
  XmlRpcValue topics = CallSelf(method, request);
  std::vector<std::pair<std::string, std::string>> found;
  if (topics.getType() != XmlRpcValue::TypeArray) return found;
  // NOLINTNEXTLINE(modernize-loop-convert): its iterators are those of a map
  for (int i = 0; i < topics.size(); ++i) found.emplace_back(topics[i][0], topics[i][1]);
  return found;
}

void Register(const std::map<std::string, std::string>& services) {
  const std::string& node = ros::this_node::getName();
  const std::string api = ros::XMLRPCManager::instance()->getServerURI();
  const std::string server =
      "rosrpc://" + ros::network::getHost() + ":" + std::to_string(ros::ConnectionManager::instance()->getTCPPort());
  XmlRpcValue payload;
  for (const auto& [topic, type] : OwnTopics("getPublications")) Call("registerPublisher", payload, topic, type, api);
  for (const auto& [topic, type] : OwnTopics("getSubscriptions")) {
    if (!Call("registerSubscriber", payload, topic, type, api)) continue;
    XmlRpcValue update;
    update[0] = node;
    update[1] = topic;
    update[2] = payload;  // who publishes it
    CallSelf("publisherUpdate", update);
  }
  for (const auto& [name, uri] : services) Call("registerService", payload, name, uri.empty() ? server : uri, api);
  // The mark by which Look() knows this registration comes last.
  Call("registerService", payload, node + "/set_logger_level", server, api);
  Call("registerService", payload, node + "/get_loggers", server, api);
}

}  // namespace

RegistrationWatch::RegistrationWatch(std::chrono::milliseconds period, std::map<std::string, std::string> services,
                                     std::function<void()> restored)
    : services_(std::move(services)), restored_(std::move(restored)) {
  thread_ = std::thread([this, period] {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!ended_changed_.wait_for(lock, period, [this] { return ended_; })) {
      lock.unlock();
      Look();
      lock.lock();
    }
  });
}

RegistrationWatch::~RegistrationWatch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
  }
  ended_changed_.notify_all();
  thread_.join();
}

void RegistrationWatch::Look() {
  if (ros::isShuttingDown()) return;
  XmlRpcValue payload;
  if (Call("lookupService", payload, ros::this_node::getName() + "/get_loggers")) {
    is_master_gone_ = false;
    return;
  }
  if (!ros::master::check()) {
    if (!std::exchange(is_master_gone_, true)) {
      ROS_WARN(
          "the ROS master at %s is gone: the run goes on, but new nodes do not find its topics and "
          "services",
          ros::master::getURI().c_str());
    }
    return;
  }
  if (ros::isShuttingDown()) return;  // it has just been unregistered
  Register(services_);
  is_master_gone_ = false;
  ROS_WARN("the ROS master at %s was restarted: topics and services are registered again",
           ros::master::getURI().c_str());
  if (restored_) restored_();
}

}  // namespace train_node
