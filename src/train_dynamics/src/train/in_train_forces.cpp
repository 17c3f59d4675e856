#include "train_dynamics/train/in_train_forces.h"

namespace train_dynamics {

InTrainForces::InTrainForces(const Consist& consist, SlackState slack, double prediction_s)
    : types_(consist.connection_types), type_(consist.connection_type), prediction_s_(prediction_s) {
  for (const ConnectionParams& type : types_) {
    gears_.emplace_back(type.kind == ConnectionKind::kDraftGears ? type.draft_gear : DraftGearParams{});
  }
  const double side = slack == SlackState::kStretched ? 0.5 : slack == SlackState::kBunched ? -0.5 : 0.0;
  for (int type : type_) {
    const bool has_slack = types_[type].kind == ConnectionKind::kDraftGears;
    start_extension_m_.push_back(has_slack ? side * types_[type].draft_gear.slack_m : 0.0);
  }
  extension_m_ = start_extension_m_;
  const size_t n = type_.size();
  force_n_.assign(n, 0.0);
  elastic_n_.assign(n, 0.0);
  dissipated_j_.assign(n, 0.0);
  extremes_.resize(n);
  for (double q : start_extension_m_) stick_.push_back({q, 0.0});
}

void InTrainForces::Begin(const std::vector<double>& head_displacement_m) {
  for (size_t c = 0; c < type_.size(); ++c) {
    start_extension_m_[c] = extension_m_[c] - (head_displacement_m[c] - head_displacement_m[c + 1]);
  }
}

void InTrainForces::Evaluate(double time_s, const std::vector<double>& head_velocity_mps,
                             std::vector<double>& force_n) {
  const size_t n = type_.size();
  force_n.resize(n + 2);
  force_n.front() = force_n.back() = 0.0;
  for (size_t c = 0; c < n; ++c) {
    const double rate = head_velocity_mps[c] - head_velocity_mps[c + 1];
    const double q = extension_m_[c] + prediction_s_ * rate;
    const ConnectionParams& type = types_[type_[c]];
    GearForce<double> f;
    if (type.kind == ConnectionKind::kDrawBar) {
      f.elastic = type.draw_bar.stiffness_n_per_m * q;
      f.force = f.elastic + type.draw_bar.damping_ns_per_m * rate;
    } else if (type.draft_gear.friction == DraftGearFriction::kSmooth) {
      f = SmoothGearForce(gears_[type_[c]], q, rate);
    } else {
      f = StickSpringGearForce(gears_[type_[c]], q, rate, stick_[c]);
    }
    force_n_[c] = f.force;
    elastic_n_[c] = f.elastic;
    force_n[c + 1] = f.force;
    ForceExtremes& extreme = extremes_[c];
    if (f.force > extreme.tension_n) extreme.tension_n = f.force, extreme.tension_time_s = time_s;
    if (f.force < extreme.compression_n) extreme.compression_n = f.force, extreme.compression_time_s = time_s;
  }
}

void InTrainForces::CloseInterval(const std::vector<double>& head_displacement_m) {
  for (size_t c = 0; c < type_.size(); ++c) {
    const double q = start_extension_m_[c] + (head_displacement_m[c] - head_displacement_m[c + 1]);
    dissipated_j_[c] += (force_n_[c] - elastic_n_[c]) * (q - extension_m_[c]);
    extension_m_[c] = q;
  }
}

void InTrainForces::AddMemoryTo(Digest& digest) const {
  for (size_t c = 0; c < type_.size(); ++c) {
    const ConnectionParams& type = types_[type_[c]];
    const bool remembers = type.kind == ConnectionKind::kDraftGears &&
                           type.draft_gear.friction == DraftGearFriction::kStickSpring;
    if (!remembers) continue;
    digest.Add(stick_[c].q);
    digest.Add(stick_[c].force);
  }
}

ConnectionEnergy InTrainForces::Energy() const {
  ConnectionEnergy energy;
  for (size_t c = 0; c < type_.size(); ++c) {
    const ConnectionParams& type = types_[type_[c]];
    const double q = extension_m_[c];
    if (type.kind == ConnectionKind::kDrawBar) {
      energy.potential += 0.5 * type.draw_bar.stiffness_n_per_m * q * q;
      energy.draw_bars += dissipated_j_[c];
    } else {
      energy.potential += GearEnergy(type.draft_gear, q);
      energy.draft_gears += dissipated_j_[c];
    }
  }
  return energy;
}

}  // namespace train_dynamics
