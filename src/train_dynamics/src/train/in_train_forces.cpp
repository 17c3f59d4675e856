#include "train_dynamics/train/in_train_forces.h"

#include <algorithm>

#include "train_dynamics/coupler/row_kernels.h"
#include "train_dynamics/train/snapshot.h"

namespace train_dynamics {

InTrainForces::InTrainForces(const Consist& consist, SlackState slack, double prediction_s,
                             const std::vector<int>& external)
    : prediction_s_(prediction_s) {
  for (const int vehicle : external) external_.push_back({vehicle});
  for (const ConnectionParams& type : consist.connection_types) sets_.emplace_back(type);
  for (const int type : consist.connection_type) {
    Set& set = sets_[type];
    set.Add(static_cast<int>(places_.size()));
    places_.push_back({type, static_cast<int>(set.place.size()) - 1});
  }
  const auto start_m = [](const Set& set, SlackState state) {
    const double side = state == SlackState::kStretched ? 0.5 : state == SlackState::kBunched ? -0.5 : 0.0;
    return side * std::visit([](const auto& law) { return law.Slack(); }, set.law);
  };
  for (Set& set : sets_) set.Begin(start_m(set, slack));
  for (std::size_t c = 0; c < places_.size(); ++c) {
    const std::optional<SlackState> own = consist.initial_slack[consist.vehicle_type[c + 1]];
    Set& set = sets_[places_[c].set];
    if (own) set.Begin(places_[c].at, start_m(set, *own));
  }
}

void InTrainForces::Set::Add(int at) {
  if (!rows.empty()) {
    Row& last = rows.back();
    if (last.count == 1) last.stride = at - last.place;
    if (at == last.place + last.stride * last.count) {
      ++last.count;
      place.push_back(at);
      return;
    }
  }
  rows.push_back({static_cast<int>(place.size()), at, 1, 1});
  place.push_back(at);
}

void InTrainForces::Set::Begin(double at_m) {
  const int padded = PaddedToLanes(static_cast<int>(place.size()));
  for (std::vector<double>* array : {&start_extension_m, &next_extension_m, &rate_mps, &force_n, &elastic_n, &tension_n,
                                     &tension_time_s, &compression_n, &compression_time_s, &dissipated_j}) {
    array->assign(padded, 0.0);
  }
  extension_m.assign(padded, at_m);
  parted_s.assign(padded, -1.0);
  const auto remember = [&](const auto& of) {
    auto begin = of.AtRest(at_m);
    stored_j.assign(padded, StoredEnergy(of, at_m, begin));
    begin.ForEachField([&](double field) { memory.insert(memory.end(), padded, field); });
  };
  std::visit(remember, law);
}

void InTrainForces::Set::Begin(int at, double at_m) {
  extension_m[at] = at_m;
  const auto remember = [&](const auto& of) {
    auto begin = of.AtRest(at_m);
    stored_j[at] = StoredEnergy(of, at_m, begin);
    std::size_t field = 0;
    begin.ForEachField([&](double value) { memory[Padded() * field++ + at] = value; });
  };
  std::visit(remember, law);
}

ConnectionArrays InTrainForces::Set::Arrays() {
  ConnectionArrays arrays{};
  arrays.count = Padded();
  arrays.strength_n = strength_n;
  arrays.rate_mps = rate_mps.data();
  arrays.extension_m = extension_m.data();
  arrays.memory = memory.data();
  arrays.force_n = force_n.data();
  arrays.elastic_n = elastic_n.data();
  arrays.tension_n = tension_n.data();
  arrays.tension_time_s = tension_time_s.data();
  arrays.compression_n = compression_n.data();
  arrays.compression_time_s = compression_time_s.data();
  arrays.stored_j = stored_j.data();
  arrays.dissipated_j = dissipated_j.data();
  arrays.parted_s = parted_s.data();
  return arrays;
}

void InTrainForces::Set::Part(double time_s) {
  const auto lose = [&](const auto& of) {
    if (of.kStoresByMemory) return;  // booked by the work of the interval
    for (std::size_t i = 0; i < place.size(); ++i) {
      if (parted_s[i] != time_s) continue;
      auto memory_at = of.AtRest(extension_m[i]);  // does not count
      dissipated_j[i] += StoredEnergy(of, extension_m[i], memory_at);
    }
  };
  std::visit(lose, law);
}

void InTrainForces::Begin(const std::vector<double>& head_displacement_m) {
  for (External& external : external_) external.displacement_m = head_displacement_m[external.vehicle];
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
  const RowKernels& rows = BestRowKernels();
  for (Set& set : sets_) {
    for (const Row& row : set.rows) {
      rows.differences(row.count, row.stride, &head_velocity_mps[row.place], &set.rate_mps[row.at]);
    }
    const auto evaluate = [&](const auto& law) {
      BestConnectionKernels().Of(law).forces(law, prediction_s_, time_s, set.Arrays());
    };
    std::visit(evaluate, set.law);
    if (set.strength_n > 0.0) set.Part(time_s);
    for (const Row& row : set.rows) {
      rows.spread(row.count, row.stride, &set.force_n[row.at], &force_n[row.place + 1]);
    }
  }
}

void InTrainForces::CloseInterval(const std::vector<double>& head_displacement_m) {
  const RowKernels& rows = BestRowKernels();
  for (External& external : external_) {
    const int i = external.vehicle;
    const double pull_n = (i > 0 ? ForceOf(i - 1) : 0.0) - (i < connections() ? ForceOf(i) : 0.0);
    external.work_j += pull_n * (head_displacement_m[i] - external.displacement_m);
    external.displacement_m = head_displacement_m[i];
  }
  for (Set& set : sets_) {
    for (const Row& row : set.rows) {
      rows.offset_differences(row.count, row.stride, &head_displacement_m[row.place], &set.start_extension_m[row.at],
                              &set.next_extension_m[row.at]);
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

std::vector<Parting> InTrainForces::Partings() const {
  std::vector<Parting> partings;
  for (int c = 0; c < connections(); ++c) {
    const double time_s = sets_[places_[c].set].parted_s[places_[c].at];
    if (time_s >= 0.0) partings.push_back({c, time_s});
  }
  std::stable_sort(partings.begin(), partings.end(),
                   [](const Parting& a, const Parting& b) { return a.time_s < b.time_s; });
  return partings;
}

void InTrainForces::AddMemoryTo(Digest& digest) const {
  const auto remembers = [](const Set& set) { return !set.memory.empty() || set.strength_n > 0.0; };
  if (std::none_of(sets_.begin(), sets_.end(), remembers)) return;
  MemoryDigest add(digest);
  for (const Place& place : places_) {
    const Set& set = sets_[place.set];
    ForEachField(set, place.at, add);
    if (set.strength_n > 0.0) add(set.parted_s[place.at]);
  }
}

template <class Self, class Function>
void InTrainForces::ForEachMemory(Self& self, Function& function) {
  for (const Place& place : self.places_) {
    auto& set = self.sets_[place.set];
    for (auto* array : {&set.start_extension_m, &set.extension_m, &set.stored_j, &set.dissipated_j, &set.parted_s,
                        &set.tension_n, &set.tension_time_s, &set.compression_n, &set.compression_time_s}) {
      function((*array)[place.at]);
    }
    ForEachField(set, place.at, function);
  }
  for (auto& external : self.external_) {
    function(external.displacement_m);
    function(external.work_j);
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
  for (const External& external : external_) energy.external = energy.external.value_or(0.0) + external.work_j;
  for (const Place& place : places_) {
    const Set& set = sets_[place.set];
    const bool loose = set.parted_s[place.at] >= 0.0 && set.extension_m[place.at] > 0.0;
    const auto book = [&](const auto& law) {
      if (law.kStoresByMemory) {
        energy.potential += set.stored_j[place.at];
      } else if (!loose) {
        auto memory = law.AtRest(set.extension_m[place.at]);  // does not count
        energy.potential += StoredEnergy(law, set.extension_m[place.at], memory);
      }
      (law.kAccount == ConnectionAccount::kDrawBars ? energy.draw_bars : energy.draft_gears) +=
          set.dissipated_j[place.at];
    };
    std::visit(book, set.law);
  }
  return energy;
}

}  // namespace train_dynamics
