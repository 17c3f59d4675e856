#include "train_dynamics/train/in_train_forces.h"

#include "train_dynamics/train/snapshot.h"
#include "train_dynamics/vehicle/lane_kernels.h"

namespace train_dynamics {

InTrainForces::InTrainForces(const Consist& consist, SlackState slack, double prediction_s)
    : prediction_s_(prediction_s) {
  for (const ConnectionParams& type : consist.connection_types) sets_.emplace_back(type);
  for (const int type : consist.connection_type) {
    Set& set = sets_[type];
    set.place.push_back(static_cast<int>(places_.size()));
    places_.push_back({type, static_cast<int>(set.place.size()) - 1});
  }
  const double side = slack == SlackState::kStretched ? 0.5 : slack == SlackState::kBunched ? -0.5 : 0.0;
  for (Set& set : sets_) {
    set.Resize(PaddedToLanes(static_cast<int>(set.place.size())));
    const bool has_slack = set.type.kind == ConnectionKind::kDraftGears;
    const double extension_m = has_slack ? side * set.type.gear.params.slack_m : 0.0;
    for (std::size_t i = 0; i < set.place.size(); ++i) set.extension_m[i] = set.stick_m[i] = extension_m;
  }
}

void InTrainForces::Set::Resize(int padded) {
  for (std::vector<double>* array :
       {&start_extension_m, &next_extension_m, &rate_mps, &extension_m, &force_n, &elastic_n, &stick_m,
        &stick_n, &tension_n, &tension_time_s, &compression_n, &compression_time_s, &dissipated_j}) {
    array->assign(padded, 0.0);
  }
}

ConnectionArrays InTrainForces::Set::Arrays() {
  ConnectionArrays arrays{};
  arrays.rate_mps = rate_mps.data();
  arrays.extension_m = extension_m.data();
  arrays.force_n = force_n.data();
  arrays.elastic_n = elastic_n.data();
  arrays.stick_m = stick_m.data();
  arrays.stick_n = stick_n.data();
  arrays.tension_n = tension_n.data();
  arrays.tension_time_s = tension_time_s.data();
  arrays.compression_n = compression_n.data();
  arrays.compression_time_s = compression_time_s.data();
  arrays.dissipated_j = dissipated_j.data();
  return arrays;
}

void InTrainForces::Begin(const std::vector<double>& head_displacement_m) {
  for (Set& set : sets_) {
    for (std::size_t i = 0; i < set.place.size(); ++i) {
      const int c = set.place[i];
      set.start_extension_m[i] = set.extension_m[i] - (head_displacement_m[c] - head_displacement_m[c + 1]);
    }
  }
}

void InTrainForces::Evaluate(double time_s, const std::vector<double>& head_velocity_mps,
                             std::vector<double>& force_n) {
  force_n.resize(places_.size() + 2);
  force_n.front() = force_n.back() = 0.0;
  for (Set& set : sets_) {
    const std::size_t count = set.place.size();
    for (std::size_t i = 0; i < count; ++i) {
      const int c = set.place[i];
      set.rate_mps[i] = head_velocity_mps[c] - head_velocity_mps[c + 1];
    }
    BestLaneKernels().connection_forces(set.type, prediction_s_, time_s,
                                        static_cast<int>(set.rate_mps.size()), set.Arrays());
    for (std::size_t i = 0; i < count; ++i) force_n[set.place[i] + 1] = set.force_n[i];
  }
}

void InTrainForces::CloseInterval(const std::vector<double>& head_displacement_m) {
  for (Set& set : sets_) {
    const std::size_t count = set.place.size();
    for (std::size_t i = 0; i < count; ++i) {
      const int c = set.place[i];
      set.next_extension_m[i] =
          set.start_extension_m[i] + (head_displacement_m[c] - head_displacement_m[c + 1]);
    }
    BestLaneKernels().connection_work(static_cast<int>(set.rate_mps.size()), set.next_extension_m.data(),
                                      set.Arrays());
  }
}

void InTrainForces::Extensions(std::vector<double>& extension_m) const {
  extension_m.resize(places_.size());
  for (const Set& set : sets_) {
    for (std::size_t i = 0; i < set.place.size(); ++i) extension_m[set.place[i]] = set.extension_m[i];
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
  for (const Place& place : self.places_) {
    auto& set = self.sets_[place.set];
    for (auto* array :
         {&set.start_extension_m, &set.extension_m, &set.stick_m, &set.stick_n, &set.dissipated_j,
          &set.tension_n, &set.tension_time_s, &set.compression_n, &set.compression_time_s}) {
      function((*array)[place.at]);
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
