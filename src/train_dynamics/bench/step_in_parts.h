#pragma once

#include "train_dynamics/vehicle/wagon_step.h"

namespace train_dynamics::bench {

/// The parts of StepWagon, each by itself, on its inputs in the step. T as in numeric/scalar.h.
template <class T>
class StepInParts {
 public:
  StepInParts(const Wagon& wagon, const Track& track, const VehicleLoads<T>& loads, double dt,
              const WagonState<T>& state)
      : wagon_(&wagon), track_(&track), loads_(loads), dt_(dt), s_(state), v0_(state.velocity), v1_(v0_) {
    Drift(v0_, 0.5 * dt, s_.position);
    Deflections();
    Suspension();
    Contact();
    BrakeAndResistance();
    v1_ = v0_;
    SumForces();
    CreepAndSlip();
    Bodies();
  }

  /// Wheel-rail forces in the normal direction.
  void Contact() {
    rail_ = ContactForces<false>(*wagon_, *track_, OwnSurface<T>(wagon_->params.wheel_rail.adhesion), s_);
  }

  /// Springs and dampers, centre plates' rims and the wedges' springs.
  void Suspension() {
    elastic_ = ElasticForces(*wagon_, deflection_);
    dissipative_ = DampingForces<false>(*wagon_, deflection_, elastic_, rate0_);
  }

  /// The wedges' set-valued friction.
  void Wedges() {
    friction_.wedge = WedgeFrictionForces(*wagon_, deflection_.wedge, rate0_.wedge, free_rate_.wedge, dt_);
  }

  /// Creep law and implicit slip of the four wheelsets, and their part of the books.
  void CreepAndSlip() { wheelsets_ = StepWheelsets<false>(*wagon_, rail_, outer_, force_, dt_, v0_, v1_, kNoOutput); }

  /// Shoes, rolling resistance, air drag, couplers, grade.
  void BrakeAndResistance() { outer_ = OuterForcesOn<false>(*wagon_, *track_, loads_, s_); }

  /// The energy ledger's.
  void Books() {
    dissipative_.wedge = friction_.wedge;
    BookWork<false>(*wagon_, outer_, wheelsets_, dissipative_, rate0_, dt_, v0_, v1_, s_.work);
    BookTorques<false>(*wagon_, outer_, wheelsets_, dt_, v0_, v1_, s_.work);
  }

  /// From bodies to elements.
  void Deflections() {
    deflection_ = ElementsOf(*wagon_, s_.position);
    rate0_ = ElementsOf(*wagon_, v0_);
  }

  /// From elements to bodies: sums of forces, kicks, with the wedges' friction between them; drifts.
  void Bodies() {
    v1_ = v0_;
    SumForces();
    Kick(*wagon_, force_, dt_, kCarbody, kWheelset1, v0_, v1_);
    free_rate_ = ElementsOf(*wagon_, v1_);
    Wedges();
    BodyVector<T> friction_force;
    AddElementForces(*wagon_, friction_, friction_force);
    Kick(*wagon_, friction_force, dt_, kFrontBolster, kWheelset1, v1_, v1_);
  }

  void WholeStep() { StepWagon(*wagon_, *track_, loads_, dt_, s_, kNoOutput); }

 private:
  void SumForces() {
    force_ = {};
    AddElementForces(*wagon_, elastic_, force_);
    AddElementForces(*wagon_, dissipative_, force_);
    AddOuterForces(*wagon_, outer_, force_);
  }

  static constexpr WagonOutput<T>* kNoOutput = nullptr;

  const Wagon* wagon_;
  const Track* track_;
  VehicleLoads<T> loads_;
  double dt_;
  WagonState<T> s_;  ///< positions of the middle of the step, velocities of its start
  BodyVector<T> v0_, v1_, force_;
  ElementVector<T> deflection_, rate0_, elastic_, dissipative_, free_rate_, friction_;
  RailForces<T> rail_;
  OuterForces<T> outer_;
  WheelsetStep<T> wheelsets_;
};

/// A part of the step and what it is called.
template <class T>
struct StepPart {
  const char* name;
  void (StepInParts<T>::*run)();
};

/// The parts with laws in them; what is missing to the whole step are transformations between bodies and elements,
/// kicks and drifts.
template <class T>
inline constexpr StepPart<T> kStepParts[] = {
    {"contact", &StepInParts<T>::Contact},
    {"suspension", &StepInParts<T>::Suspension},
    {"wedges", &StepInParts<T>::Wedges},
    {"creep_and_slip", &StepInParts<T>::CreepAndSlip},
    {"brake_and_resistance", &StepInParts<T>::BrakeAndResistance},
    {"books", &StepInParts<T>::Books},
};

}  // namespace train_dynamics::bench
