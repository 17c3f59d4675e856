#include "train_dynamics/train/in_train_forces.h"

#include "train_dynamics/train/snapshot.h"
#include "train_dynamics/vehicle/lane_kernels.h"

namespace train_dynamics {

InTrainForces::InTrainForces(const Consist& consist, SlackState slack, double prediction_s)
    : prediction_s_(prediction_s) {
  for (const ConnectionParams& type : consist.connection_types) sets_.emplace_back(type);
  const double side = slack == SlackState::kStretched ? 0.5 : slack == SlackState::kBunched ? -0.5 : 0.0;
  for (const int type : consist.connection_type) {
    Set& set = sets_[type];
    places_.push_back({type, static_cast<int>(set.place.size())});
    set.place.push_back(static_cast<int>(extension_m_.size()));
    const bool has_slack = set.type.kind == ConnectionKind::kDraftGears;
    extension_m_.push_back(has_slack ? side * set.type.gear.params.slack_m : 0.0);
  }
  start_extension_m_ = extension_m_;
  rate_mps_.assign(extension_m_.size(), 0.0);
  for (Set& set : sets_) {
    set.Resize(PaddedToLanes(static_cast<int>(set.place.size())));
    for (std::size_t i = 0; i < set.place.size(); ++i) {
      set.extension_m[i] = set.stick_m[i] = extension_m_[set.place[i]];
    }
  }
}

void InTrainForces::Set::Resize(int padded) {
  for (std::vector<double>* array :
       {&rate_mps, &extension_m, &force_n, &elastic_n, &stick_m, &stick_n, &tension_n, &tension_time_s,
        &compression_n, &compression_time_s, &dissipated_j}) {
    array->assign(padded, 0.0);
  }
}

ConnectionArrays InTrainForces::Set::Arrays() {
  return {rate_mps.data(),      extension_m.data(),       force_n.data(),   elastic_n.data(),
          stick_m.data(),       stick_n.data(),           tension_n.data(), tension_time_s.data(),
          compression_n.data(), compression_time_s.data()};
}

void InTrainForces::Begin(const std::vector<double>& head_displacement_m) {
  for (std::size_t c = 0; c < extension_m_.size(); ++c) {
    start_extension_m_[c] = extension_m_[c] - (head_displacement_m[c] - head_displacement_m[c + 1]);
  }
}

void InTrainForces::Evaluate(double time_s, const std::vector<double>& head_velocity_mps,
                             std::vector<double>& force_n) {
  const std::size_t n = extension_m_.size();
  for (std::size_t c = 0; c < n; ++c) rate_mps_[c] = head_velocity_mps[c] - head_velocity_mps[c + 1];
  force_n.resize(n + 2);
  force_n.front() = force_n.back() = 0.0;
  for (Set& set : sets_) {
    for (std::size_t i = 0; i < set.place.size(); ++i) set.rate_mps[i] = rate_mps_[set.place[i]];
    BestLaneKernels().connection_forces(set.type, prediction_s_, time_s,
                                        static_cast<int>(set.rate_mps.size()), set.Arrays());
    for (std::size_t i = 0; i < set.place.size(); ++i) force_n[set.place[i] + 1] = set.force_n[i];
  }
}

void InTrainForces::CloseInterval(const std::vector<double>& head_displacement_m) {
  for (std::size_t c = 0; c < extension_m_.size(); ++c) {
    extension_m_[c] = start_extension_m_[c] + (head_displacement_m[c] - head_displacement_m[c + 1]);
  }
  for (Set& set : sets_) {
    for (std::size_t i = 0; i < set.place.size(); ++i) {
      const double extension_m = extension_m_[set.place[i]];
      set.dissipated_j[i] += (set.force_n[i] - set.elastic_n[i]) * (extension_m - set.extension_m[i]);
      set.extension_m[i] = extension_m;
    }
  }
}

std::vector<ForceExtremes> InTrainForces::Extremes() const {
  std::vector<ForceExtremes> extremes;
  for (const Place& place : places_) {
    const Set& set = sets_[place.set];
    extremes.push_back({set.tension_n[place.at], set.tension_time_s[place.at], set.compression_n[place.at],
                        set.compression_time_s[place.at]});
  }
  return extremes;
}

void InTrainForces::AddMemoryTo(Digest& digest) const {
  for (const Place& place : places_) {
    const Set& set = sets_[place.set];
    const bool remembers = set.type.kind == ConnectionKind::kDraftGears &&
                           set.type.gear.params.friction == DraftGearFriction::kStickSpring;
    if (!remembers) continue;
    digest.Add(set.stick_m[place.at]);
    digest.Add(set.stick_n[place.at]);
  }
}

template <class Self, class Function>
void InTrainForces::ForEachMemory(Self& self, Function& function) {
  for (std::size_t c = 0; c < self.places_.size(); ++c) {
    auto& set = self.sets_[self.places_[c].set];
    const int at = self.places_[c].at;
    function(self.start_extension_m_[c]);
    function(self.extension_m_[c]);
    for (auto* array : {&set.stick_m, &set.stick_n, &set.dissipated_j, &set.tension_n, &set.tension_time_s,
                        &set.compression_n, &set.compression_time_s}) {
      function((*array)[at]);
    }
  }
}

std::vector<double> InTrainForces::Memory() const {
  MemoryWriter writer;
  ForEachMemory(*this, writer);
  return writer.Take();
}

void InTrainForces::SetMemory(const std::vector<double>& memory) {
  MemoryReader reader(memory);
  ForEachMemory(*this, reader);
  reader.End();
  for (Set& set : sets_) {
    for (std::size_t i = 0; i < set.place.size(); ++i) set.extension_m[i] = extension_m_[set.place[i]];
  }
}

ConnectionEnergy InTrainForces::Energy() const {
  ConnectionEnergy energy;
  for (const Place& place : places_) {
    const Set& set = sets_[place.set];
    const double q = set.extension_m[place.at];
    if (set.type.kind == ConnectionKind::kDrawBar) {
      energy.potential += 0.5 * set.type.bar.stiffness_n_per_m * q * q;
      energy.draw_bars += set.dissipated_j[place.at];
    } else {
      energy.potential += GearEnergy(set.type.gear.params, q);
      energy.draft_gears += set.dissipated_j[place.at];
    }
  }
  return energy;
}

}  // namespace train_dynamics
