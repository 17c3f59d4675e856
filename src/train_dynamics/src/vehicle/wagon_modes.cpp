#include "train_dynamics/vehicle/wagon_modes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>

namespace train_dynamics {
namespace {

constexpr int kFreedoms = 3 * kBodies;
constexpr double kTwoPi = 6.283185307179586476925;
using Vector = Eigen::Matrix<double, kFreedoms, 1>;
using Matrix = Eigen::Matrix<double, kFreedoms, kFreedoms>;
using StateMatrix = Eigen::Matrix<double, 2 * kFreedoms, 2 * kFreedoms>;

Vector Pack(const BodyVector<double>& b) {
  Vector v;
  for (int i = 0; i < kBodies; ++i) v.segment<3>(3 * i) << b.x[i], b.z[i], b.pitch[i];
  return v;
}

BodyVector<double> Unpack(const Vector& v) {
  BodyVector<double> b;
  for (int i = 0; i < kBodies; ++i) {
    b.x[i] = v[3 * i];
    b.z[i] = v[3 * i + 1];
    b.pitch[i] = v[3 * i + 2];
  }
  return b;
}

/// Forces of all elements and of the wheel-rail contacts.
Vector Forces(const Wagon& w, const Vector& position, const Vector& velocity) {
  const BodyVector<double> q = Unpack(position), v = Unpack(velocity);
  const ElementVector<double> deflection = ElementsOf(w, q);
  const ElementVector<double> elastic = ElasticForces(w, deflection);
  BodyVector<double> force;
  AddElementForces(w, elastic, force);
  AddElementForces(w, DampingForces(w, deflection, elastic, ElementsOf(w, v)), force);
  const NormalContactParams& contact = w.params.wheel_rail.normal;
  for (int b = kWheelset1; b < kBodies; ++b) {
    force.z[b] += 2.0 * OneSidedForce(contact.stiffness_n_per_m, contact.damping_ns_per_m, -q.z[b], -v.z[b]);
  }
  return Pack(force);
}

double SpectralRadius(const StateMatrix& a) {
  return Eigen::EigenSolver<StateMatrix>(a, false).eigenvalues().cwiseAbs().maxCoeff();
}

/// One step of the wagon's leapfrog without wedges and creep: x += h/2 v; v -= h (K x + C v); x += h/2 v.
StateMatrix Amplification(const Matrix& stiffness, const Matrix& damping, double h) {
  StateMatrix drift = StateMatrix::Identity(), kick = StateMatrix::Identity();
  drift.topRightCorner<kFreedoms, kFreedoms>() = 0.5 * h * Matrix::Identity();
  kick.bottomLeftCorner<kFreedoms, kFreedoms>() = -h * stiffness;
  kick.bottomRightCorner<kFreedoms, kFreedoms>() -= h * damping;
  return drift * kick * drift;
}

}  // namespace

WagonModes AnalyseModes(const Wagon& wagon) {
  BodyVector<double> masses;
  for (int i = 0; i < kBodies; ++i) {
    masses.x[i] = masses.z[i] = wagon.mass_kg[i];
    masses.pitch[i] = wagon.inertia_kgm2[i];
  }
  const Vector mass = Pack(masses);
  const Vector rest = Pack(StaticEquilibrium(wagon, 0.0, 0.0).position);
  Matrix stiffness, damping;       // divided by the masses
  constexpr double kProbe = 1e-6;  // [m, rad, m/s, rad/s]: small against every gap at the equilibrium
  for (int k = 0; k < kFreedoms; ++k) {
    const Vector probe = kProbe * Vector::Unit(k);
    stiffness.col(k) =
        (Forces(wagon, rest - probe, Vector::Zero()) - Forces(wagon, rest + probe, Vector::Zero())) /
        (2.0 * kProbe);
    damping.col(k) = (Forces(wagon, rest, -probe) - Forces(wagon, rest, probe)) / (2.0 * kProbe);
  }
  stiffness = mass.cwiseInverse().asDiagonal() * stiffness;
  damping = mass.cwiseInverse().asDiagonal() * damping;

  StateMatrix first_order = StateMatrix::Zero();
  first_order.topRightCorner<kFreedoms, kFreedoms>().setIdentity();
  first_order.bottomLeftCorner<kFreedoms, kFreedoms>() = -stiffness;
  first_order.bottomRightCorner<kFreedoms, kFreedoms>() = -damping;
  const Eigen::EigenSolver<StateMatrix> solver(first_order);

  WagonModes result{};
  int still = 0;
  for (int k = 0; k < 2 * kFreedoms; ++k) {
    const std::complex<double> lambda = solver.eigenvalues()[k];
    constexpr double kStill = 0.1;  // [1/s]; the slowest real mode swings at about 10 1/s
    if (std::abs(lambda) < kStill) ++still;
    if (std::abs(lambda) < kStill || lambda.imag() < 0.0) continue;
    const Eigen::Matrix<std::complex<double>, kFreedoms, 1> shape =
        solver.eigenvectors().col(k).head<kFreedoms>();
    int largest = 0;
    shape.cwiseAbs().maxCoeff(&largest);
    const Vector energy = mass.cwiseProduct(shape.cwiseAbs2());
    result.modes.push_back({std::abs(lambda) / kTwoPi, -lambda.real() / std::abs(lambda),
                            Unpack((shape / shape[largest]).real()), Unpack(energy / energy.sum())});
  }
  result.rigid_body_modes = still / 2;
  std::sort(result.modes.begin(), result.modes.end(),
            [](const WagonMode& a, const WagonMode& b) { return a.frequency_hz < b.frequency_hz; });

  // A double eigenvalue of 1 (each rigid-body motion) is found to about 1e-8 only.
  constexpr double kRadius = 1.0 + 1e-6;
  double stable = 0.0, unstable = 0.1;
  while (unstable - stable > 1e-7) {
    const double middle = 0.5 * (stable + unstable);
    (SpectralRadius(Amplification(stiffness, damping, middle)) <= kRadius ? stable : unstable) = middle;
  }
  result.largest_stable_step_s = stable;
  return result;
}

}  // namespace train_dynamics
