#include "train_brake_rviz/run_client.h"

#include <std_srvs/Trigger.h>
#include <train_brake_msgs/GiveCommand.h>
#include <train_brake_msgs/SelectView.h>
#include <train_brake_msgs/SetRealTimeFactor.h>
#include <train_brake_msgs/StepExchanges.h>

#include <utility>

namespace train_brake_rviz {

template <class Service>
Answer RunClient::Call(const std::string& name, Service& service) {
  ros::ServiceClient client = train_.serviceClient<Service>(name);
  if (!client.call(service)) return {false, client.getService() + " does not answer"};
  return {static_cast<bool>(service.response.success), service.response.message};
}

Answer RunClient::Resume() {
  std_srvs::Trigger service;
  return Call("master/resume", service);
}

Answer RunClient::Pause() {
  std_srvs::Trigger service;
  return Call("master/pause", service);
}

Answer RunClient::Step(unsigned exchanges) {
  train_brake_msgs::StepExchanges service;
  service.request.exchanges = exchanges;
  return Call("master/step", service);
}

Answer RunClient::SetRealTimeFactor(double factor) {
  train_brake_msgs::SetRealTimeFactor service;
  service.request.real_time_factor = factor;
  return Call("master/set_real_time_factor", service);
}

Answer RunClient::Give(const train_brake_msgs::DriverCommand& command) {
  train_brake_msgs::GiveCommand service;
  service.request.command = command;
  return Call("driver/give", service);
}

Answer RunClient::Select(const std::string& quantity, int vehicle) {
  train_brake_msgs::SelectView service;
  service.request.quantity = quantity;
  service.request.vehicle = vehicle;
  return Call("view/select", service);
}

Worker::Worker() : thread_([this] { Run(); }) {}

Worker::~Worker() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Worker::Do(std::function<void()> task) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  changed_.notify_all();
}

void Worker::Run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ended_ || !tasks_.empty(); });
    if (ended_) return;
    const std::function<void()> task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    lock.lock();
  }
}

}  // namespace train_brake_rviz
