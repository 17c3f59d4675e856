#include "train_dynamics/train/in_train_forces.h"

#include "train_dynamics/train/snapshot.h"

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
    set.Begin(side * std::visit([](const auto& law) { return law.Slack(); }, set.law));
  }
}

void InTrainForces::Set::Begin(double at_m) {
  const int padded = PaddedToLanes(static_cast<int>(place.size()));
  for (std::vector<double>* array :
       {&start_extension_m, &next_extension_m, &rate_mps, &extension_m, &force_n, &elastic_n, &tension_n,
        &tension_time_s, &compression_n, &compression_time_s, &dissipated_j}) {
    array->assign(padded, 0.0);
  }
  extension_m.assign(padded, at_m);
  const auto remember = [&](const auto& of) {
    using Law = std::decay_t<decltype(of)>;
    auto begin = Law::template Memory<double>::At(at_m);
    begin.ForEachField([&](double field) { memory.insert(memory.end(), padded, field); });
  };
  std::visit(remember, law);
}

ConnectionArrays InTrainForces::Set::Arrays() {
  return {Padded(),
          rate_mps.data(),
          extension_m.data(),
          memory.data(),
          force_n.data(),
          elastic_n.data(),
          tension_n.data(),
          tension_time_s.data(),
          compression_n.data(),
          compression_time_s.data(),
          dissipated_j.data()};
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
    const auto evaluate = [&](const auto& law) {
      BestConnectionKernels().Of(law).forces(law, prediction_s_, time_s, set.Arrays());
    };
    std::visit(evaluate, set.law);
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
    const auto book = [&](const auto& law) {
      BestConnectionKernels().Of(law).work(law, set.next_extension_m.data(), set.Arrays());
    };
    std::visit(book, set.law);
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

template <class OfSet, class Function>
void InTrainForces::ForEachField(OfSet& set, int at, Function& function) {
  for (std::size_t i = static_cast<std::size_t>(at); i < set.memory.size(); i += set.rate_mps.size()) {
    function(set.memory[i]);
  }
}

void InTrainForces::AddMemoryTo(Digest& digest) const {
  MemoryDigest add(digest);
  for (const Place& place : places_) ForEachField(sets_[place.set], place.at, add);
}

template <class Self, class Function>
void InTrainForces::ForEachMemory(Self& self, Function& function) {
  for (const Place& place : self.places_) {
    auto& set = self.sets_[place.set];
    for (auto* array : {&set.start_extension_m, &set.extension_m, &set.dissipated_j, &set.tension_n,
                        &set.tension_time_s, &set.compression_n, &set.compression_time_s}) {
      function((*array)[place.at]);
    }
    ForEachField(set, place.at, function);
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
    const auto book = [&](const auto& law) {
      energy.potential += StoredEnergy(law, set.extension_m[place.at]);
      (law.kAccount == ConnectionAccount::kDrawBars ? energy.draw_bars : energy.draft_gears) +=
          set.dissipated_j[place.at];
    };
    std::visit(book, set.law);
  }
  return energy;
}

}  // namespace train_dynamics
