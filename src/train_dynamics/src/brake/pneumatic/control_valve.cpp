#include "train_dynamics/brake/pneumatic/control_valve.h"

#include "train_dynamics/numeric/elementary.h"

namespace train_dynamics {
namespace {

constexpr double kLitre = 1e-3;
constexpr double kDischarge = 0.8;                  ///< of every opening [A]
constexpr double kHighRetainedPa = 20.0 * 6894.76;  ///< [S]
constexpr double kLowRetainedPa = 10.0 * 6894.76;   ///< [S]
constexpr double kSlowDirectOpeningM = 1.45e-3;     ///< empties a cylinder in some 86 s [S: the time]
/// Above an ECP valve's emergency pressure, which the pipe must have had before its loss is an emergency: while a train
/// is charged, its own reservoirs may draw the pipe below that pressure [A].
constexpr double kEcpArmedAbovePa = 135e3;
constexpr double kLnTenAndAHalf = 2.3513752571634776;

// ln(x) for x >= 1, at set-up only: Halley's steps on e^y = x.
double Log(double x) {
  double y = 0.0;
  for (int i = 0; i < 12; ++i) {
    const double e = Exp(y);
    y += 2.0 * (x - e) / (x + e);
  }
  return y;
}

}  // namespace

ControlValve::ControlValve(const ControlValveParams& params, double temperature_k, double dt_s)
    : p_(params),
      dt_s_(dt_s),
      auxiliary_m3_(params.auxiliary_reservoir_l * kLitre),
      emergency_m3_(params.direct.emergency_reservoir_l * kLitre),
      cylinder_m3_(params.cylinder_l * kLitre) {
  const double rt = kGasConstantOfAir * temperature_k;
  const auto opening = [&](double mm) { return rt * NozzleConductance(mm * 1e-3, kDischarge, temperature_k); };
  charging_ = opening(params.charging_opening_mm);
  application_ = opening(params.application_opening_mm);
  exhaust_ = opening(params.exhaust_opening_mm);
  slow_direct_ = opening(kSlowDirectOpeningM * 1e3);
  emergency_ = opening(params.direct.emergency_opening_mm);
  vent_ = opening(params.direct.vent_opening_mm);
  limiting_ = opening(params.direct.limiting_opening_mm);
  ep_vent_ = opening(params.ep_vent_opening_mm);
  quick_service_ = opening(params.direct.quick_service_opening_mm);
  const bool direct = params.kind == ControlValveKind::kDirectRelease;
  quick_service_m3_ =
      kLitre * (direct ? params.direct.quick_service_volume_l : params.graduated.quick_service_volume_l);
  chamber_share_ = 1.0 - Exp(-dt_s / (direct ? params.direct.quick_action_time_s : params.graduated.control_time_s));
  leak_pa_ = params.cylinder_leakage_kpa_per_min * 1e3 / 60.0 * dt_s;
  const bool ecp = params.kind == ControlValveKind::kEcp;
  fill_per_s_ = kLnTenAndAHalf / (ecp ? params.ecp.fill_time_s : params.graduated.fill_time_s);
  emergency_fill_per_s_ = kLnTenAndAHalf / params.ecp.emergency_fill_time_s;
  const double maximum_kpa = ecp ? params.ecp.maximum_cylinder_kpa : params.graduated.maximum_cylinder_kpa;
  release_per_s_ = Log(0.95 * maximum_kpa / 40.0) / (ecp ? params.ecp.release_time_s : params.graduated.release_time_s);
}

ControlValveState ControlValve::Charged(double pipe_pa) const {
  return {pipe_pa, pipe_pa, kAtmospherePa, kAtmospherePa, pipe_pa, 0.0, 0.0, 0.0};
}

ControlValveState ControlValve::Empty() const { return Charged(kAtmospherePa); }

double ControlValve::PressureVolume(const ControlValveState& s) const {
  double pv = s.auxiliary_pa * auxiliary_m3_ + s.cylinder_pa * cylinder_m3_;
  if (p_.kind == ControlValveKind::kDirectRelease) pv += s.emergency_pa * emergency_m3_;
  if (p_.kind != ControlValveKind::kEcp) pv += s.quick_service_pa * quick_service_m3_;
  return pv;
}

double ControlValve::Step(const TrainLine& line, Retainer retainer, ControlValveState& s, double& pipe_pa,
                          double pipe_m3) const {
  double out = 0.0;
  const double lost = Min(leak_pa_, Max(0.0, s.cylinder_pa - kAtmospherePa));
  s.cylinder_pa -= lost;
  out += lost * cylinder_m3_;
  if (ep_vent_ > 0.0 && p_.kind != ControlValveKind::kEcp) {
    if (line.ep_emergency) out += PassToPlace(vent_, dt_s_, pipe_pa, pipe_m3, kAtmospherePa);
    if (pipe_pa > line.ep_pipe_pa + 2e3) out += PassToPlace(ep_vent_, dt_s_, pipe_pa, pipe_m3, kAtmospherePa);
  }
  switch (p_.kind) {
    case ControlValveKind::kDirectRelease:
      return out + StepDirect(retainer, s, pipe_pa, pipe_m3);
    case ControlValveKind::kGraduatedRelease:
      return out + StepGraduated(s, pipe_pa, pipe_m3);
    case ControlValveKind::kEcp:
      return out + StepEcp(line, s, pipe_pa, pipe_m3);
  }
  return out;
}

double ControlValve::BailOff(ControlValveState& s, double pipe_pa) const {
  if (p_.kind == ControlValveKind::kGraduatedRelease) {
    s.quick_action_pa = Min(s.quick_action_pa, pipe_pa);
    return 0.0;
  }
  if (p_.kind == ControlValveKind::kEcp) {
    s.SetMode(ControlValveMode::kBailedOff);  // for the step that follows
    return 0.0;
  }
  if (s.Mode() != ControlValveMode::kRelease && s.Mode() != ControlValveMode::kEmergency)
    s.SetMode(ControlValveMode::kBailedOff);
  return PassToPlace(exhaust_, dt_s_, s.cylinder_pa, cylinder_m3_, kAtmospherePa);
}

double ControlValve::StepDirect(Retainer retainer, ControlValveState& s, double& pipe_pa, double pipe_m3) const {
  const DirectReleaseParams& d = p_.direct;
  double out = 0.0;

  // The quick-action chamber and the vent.
  s.quick_action_pa += (pipe_pa - s.quick_action_pa) * chamber_share_;
  const double gap = s.quick_action_pa - pipe_pa;
  double open_s = 0.0;
  if (s.Mode() != ControlValveMode::kEmergency) {
    const double threshold = d.quick_action_threshold_kpa * 1e3;
    if (gap > threshold) {
      s.SetMode(ControlValveMode::kEmergency);
      const double rise = gap - s.quick_action_gap_pa;
      open_s = dt_s_ * (rise > 0.0 ? Clamp((gap - threshold) / rise, 0.0, 1.0) : 1.0);
      s.vent_open_s = open_s;
    }
  } else if (s.vent_open_s > 0.0) {
    open_s = dt_s_;
    s.vent_open_s += dt_s_;
    const bool empty = pipe_pa < kAtmospherePa + d.vent_closes_below_kpa * 1e3;
    if (empty && s.vent_open_s >= d.vent_time_s) s.vent_open_s = open_s = 0.0;
  }
  if (open_s > 0.0) out += PassToPlace(vent_, open_s, pipe_pa, pipe_m3, kAtmospherePa);
  s.quick_action_gap_pa = s.quick_action_pa - pipe_pa;

  // The mode.
  const double above = s.auxiliary_pa - pipe_pa;
  switch (s.Mode()) {
    case ControlValveMode::kRelease:
      if (above > d.apply_kpa * 1e3) s.SetMode(ControlValveMode::kApply);
      break;
    case ControlValveMode::kApply:
      if (above < -d.release_kpa * 1e3) {
        s.SetMode(ControlValveMode::kRelease);
      } else if (above < d.lap_kpa * 1e3) {
        s.SetMode(ControlValveMode::kLap);
      }
      break;
    case ControlValveMode::kLap:
    case ControlValveMode::kBailedOff:
      if (above < -d.release_kpa * 1e3) s.SetMode(ControlValveMode::kRelease);
      if (above > d.apply_kpa * 1e3) s.SetMode(ControlValveMode::kApply);
      break;
    case ControlValveMode::kEmergency:
      if (s.vent_open_s == 0.0 && above < -d.release_kpa * 1e3) s.SetMode(ControlValveMode::kRelease);
      break;
  }

  // What is connected in it.
  switch (s.Mode()) {
    case ControlValveMode::kRelease: {
      PassOneWay(charging_, dt_s_, pipe_pa, pipe_m3, s.auxiliary_pa, auxiliary_m3_);
      PassOneWay(charging_, dt_s_, pipe_pa, pipe_m3, s.emergency_pa, emergency_m3_);
      double retained = kAtmospherePa;
      if (retainer == Retainer::kHighPressure) retained += kHighRetainedPa;
      if (retainer == Retainer::kLowPressure) retained += kLowRetainedPa;
      out += PassToPlace(retainer == Retainer::kSlowDirect ? slow_direct_ : exhaust_, dt_s_, s.cylinder_pa,
                         cylinder_m3_, retained);
      out += PassToPlace(quick_service_, dt_s_, s.quick_service_pa, quick_service_m3_, kAtmospherePa);
      break;
    }
    case ControlValveMode::kApply:
    case ControlValveMode::kLap: {
      if (s.Mode() == ControlValveMode::kApply)
        PassOneWay(application_, dt_s_, s.auxiliary_pa, auxiliary_m3_, s.cylinder_pa, cylinder_m3_);
      const double quick = kAtmospherePa + d.quick_service_kpa * 1e3;
      if (s.quick_service_pa < quick) {
        const double pv = Min((quick - s.quick_service_pa) * quick_service_m3_,
                              dt_s_ * quick_service_ * pipe_pa * NozzleFunction(s.quick_service_pa / pipe_pa));
        if (pipe_pa > s.quick_service_pa && quick_service_m3_ > 0.0) {
          pipe_pa -= pv / pipe_m3;
          s.quick_service_pa += pv / quick_service_m3_;
        }
      }
      if (s.cylinder_pa < kAtmospherePa + d.minimum_cylinder_kpa * 1e3)
        PassOneWay(limiting_, dt_s_, pipe_pa, pipe_m3, s.cylinder_pa, cylinder_m3_);
      break;
    }
    case ControlValveMode::kBailedOff:
      out += PassToPlace(exhaust_, dt_s_, s.cylinder_pa, cylinder_m3_, kAtmospherePa);
      break;
    case ControlValveMode::kEmergency:
      Pass(application_, dt_s_, s.auxiliary_pa, auxiliary_m3_, s.cylinder_pa, cylinder_m3_);
      PassOneWay(emergency_, dt_s_, s.emergency_pa, emergency_m3_, s.cylinder_pa, cylinder_m3_);
      if (d.accelerated_release && s.vent_open_s == 0.0 && pipe_pa > kAtmospherePa + d.accelerated_release_kpa * 1e3) {
        PassOneWay(application_, dt_s_, s.cylinder_pa, cylinder_m3_, pipe_pa, pipe_m3);
        PassOneWay(application_, dt_s_, s.auxiliary_pa, auxiliary_m3_, pipe_pa, pipe_m3);
      }
      break;
  }
  return out;
}

double ControlValve::Follow(double goal_pa, double fill_per_s, double release_per_s, double least_fill_pa_per_s,
                            ControlValveState& s) const {
  const double now = s.cylinder_pa - kAtmospherePa;
  if (now < goal_pa) {
    const double rate = Max(least_fill_pa_per_s, fill_per_s * (1.05 * goal_pa - now));
    const double share = auxiliary_m3_ / (auxiliary_m3_ + cylinder_m3_);
    const double rise = Min(Min(goal_pa - now, dt_s_ * rate), Max(0.0, s.auxiliary_pa - s.cylinder_pa) * share);
    s.cylinder_pa += rise;
    s.auxiliary_pa -= rise * cylinder_m3_ / auxiliary_m3_;
    return 0.0;
  }
  const double fall = Min(now - goal_pa, dt_s_ * release_per_s * (now - goal_pa));
  s.cylinder_pa -= fall;
  return fall * cylinder_m3_;
}

double ControlValve::StepGraduated(ControlValveState& s, double& pipe_pa, double pipe_m3) const {
  const GraduatedReleaseParams& g = p_.graduated;
  double out = 0.0;
  const double below = s.quick_action_pa - pipe_pa;
  if (s.Mode() == ControlValveMode::kRelease) {
    if (below > g.insensitivity_kpa * 1e3) s.SetMode(ControlValveMode::kApply);
  } else if (below < g.release_kpa * 1e3) {
    s.SetMode(ControlValveMode::kRelease);
  }
  PassOneWay(charging_, dt_s_, pipe_pa, pipe_m3, s.auxiliary_pa, auxiliary_m3_);
  const double maximum = g.maximum_cylinder_kpa * 1e3;
  double goal = 0.0, least = 0.0;
  if (s.Mode() == ControlValveMode::kRelease) {
    s.quick_action_pa -= below * chamber_share_;
    out += PassToPlace(quick_service_, dt_s_, s.quick_service_pa, quick_service_m3_, kAtmospherePa);
  } else {
    goal = Clamp(g.ratio * below, 0.1 * maximum, maximum);
    if (s.cylinder_pa - kAtmospherePa < 0.1 * maximum) least = 0.1 * maximum;
    const double quick = kAtmospherePa + g.quick_service_kpa * 1e3;
    if (s.quick_service_pa < quick && pipe_pa > quick && quick_service_m3_ > 0.0) {
      const double pv = Min((quick - s.quick_service_pa) * quick_service_m3_,
                            dt_s_ * quick_service_ * pipe_pa * NozzleFunction(s.quick_service_pa / pipe_pa));
      pipe_pa -= pv / pipe_m3;
      s.quick_service_pa += pv / quick_service_m3_;
    }
  }
  // Exponentially down to the goal; from a release to nothing.
  return out + Follow(goal, fill_per_s_, release_per_s_, least, s);
}

double ControlValve::StepEcp(const TrainLine& line, ControlValveState& s, double& pipe_pa, double pipe_m3) const {
  const EcpParams& e = p_.ecp;
  PassOneWay(charging_, dt_s_, pipe_pa, pipe_m3, s.auxiliary_pa, auxiliary_m3_);
  const bool charged = s.quick_action_pa > kAtmospherePa + e.emergency_pipe_kpa * 1e3 + kEcpArmedAbovePa;
  if (pipe_pa > s.quick_action_pa) s.quick_action_pa = pipe_pa;  // the highest so far: an empty train is no emergency
  const bool lost = charged && pipe_pa < kAtmospherePa + e.emergency_pipe_kpa * 1e3;
  const bool held = s.Mode() == ControlValveMode::kBailedOff;
  const bool emergency = !held && (line.ecp_emergency || lost);
  const double goal = (emergency ? 1.0 : held ? 0.0 : line.ecp_goal) * e.maximum_cylinder_kpa * 1e3;
  s.SetMode(emergency    ? ControlValveMode::kEmergency
            : goal > 0.0 ? ControlValveMode::kApply
                         : ControlValveMode::kRelease);
  return Follow(goal, emergency ? emergency_fill_per_s_ : fill_per_s_, release_per_s_, 0.0, s);
}

}  // namespace train_dynamics
