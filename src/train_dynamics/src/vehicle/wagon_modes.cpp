#include "train_dynamics/vehicle/wagon_modes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>

namespace train_dynamics {
namespace {

constexpr double kTwoPi = 6.283185307179586476925;
using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

template <int kPerBogie>
Vector Pack(const BodyVector<double, kPerBogie>& b) {
  Vector v(3 * kBodiesOf<kPerBogie>);
  for (int i = 0; i < kBodiesOf<kPerBogie>; ++i) v.segment<3>(3 * i) << b.x[i], b.z[i], b.pitch[i];
  return v;
}

template <int kPerBogie>
BodyVector<double, kPerBogie> Unpack(const Vector& v) {
  BodyVector<double, kPerBogie> b;
  for (int i = 0; i < kBodiesOf<kPerBogie>; ++i) {
    b.x[i] = v[3 * i];
    b.z[i] = v[3 * i + 1];
    b.pitch[i] = v[3 * i + 2];
  }
  return b;
}

/// Forces of all elements and of the wheel-rail contacts.
template <int kPerBogie>
Vector Forces(const BogieVehicle<kPerBogie>& w, const Vector& position, const Vector& velocity) {
  const BodyVector<double, kPerBogie> q = Unpack<kPerBogie>(position), v = Unpack<kPerBogie>(velocity);
  const ElementVector<double, kPerBogie> deflection = ElementsOf(w, q);
  const ElementVector<double, kPerBogie> elastic = ElasticForces(w, deflection);
  BodyVector<double, kPerBogie> force;
  AddElementForces(w, elastic, force);
  AddElementForces(w, DampingForces<true>(w, deflection, elastic, ElementsOf(w, v)), force);
  const NormalContactParams& contact = w.params.wheel_rail.normal;
  for (int b = kWheelset1; b < kBodiesOf<kPerBogie>; ++b) {
    force.z[b] += 2.0 * OneSidedForce(contact.stiffness_n_per_m, contact.damping_ns_per_m, -q.z[b], -v.z[b]);
  }
  return Pack(force);
}

double SpectralRadius(const Matrix& a) {
  return Eigen::EigenSolver<Matrix>(a, false).eigenvalues().cwiseAbs().maxCoeff();
}

/// One step of the wagon's leapfrog without wedges and creep: x += h/2 v; v -= h (K x + C v); x += h/2 v.
Matrix Amplification(const Matrix& stiffness, const Matrix& damping, double h) {
  const Eigen::Index n = stiffness.rows();
  Matrix drift = Matrix::Identity(2 * n, 2 * n), kick = drift;
  drift.topRightCorner(n, n) = 0.5 * h * Matrix::Identity(n, n);
  kick.bottomLeftCorner(n, n) = -h * stiffness;
  kick.bottomRightCorner(n, n) -= h * damping;
  return drift * kick * drift;
}

}  // namespace

template <int kPerBogie>
WagonModes<kPerBogie> AnalyseModes(const BogieVehicle<kPerBogie>& wagon) {
  constexpr int kFreedoms = 3 * kBodiesOf<kPerBogie>;
  BodyVector<double, kPerBogie> masses;
  for (int i = 0; i < kBodiesOf<kPerBogie>; ++i) {
    masses.x[i] = masses.z[i] = wagon.mass_kg[i];
    masses.pitch[i] = wagon.inertia_kgm2[i];
  }
  const Vector mass = Pack(masses);
  const Vector still = Vector::Zero(kFreedoms);
  const Vector rest = Pack(StaticEquilibrium(wagon, 0.0, 0.0).position);
  Matrix stiffness(kFreedoms, kFreedoms), damping(kFreedoms, kFreedoms);  // divided by the masses
  constexpr double kProbe = 1e-6;  // [m, rad, m/s, rad/s]: small against every gap at the equilibrium
  for (int k = 0; k < kFreedoms; ++k) {
    const Vector probe = kProbe * Vector::Unit(kFreedoms, k);
    stiffness.col(k) = (Forces(wagon, rest - probe, still) - Forces(wagon, rest + probe, still)) / (2.0 * kProbe);
    damping.col(k) = (Forces(wagon, rest, -probe) - Forces(wagon, rest, probe)) / (2.0 * kProbe);
  }
  stiffness = mass.cwiseInverse().asDiagonal() * stiffness;
  damping = mass.cwiseInverse().asDiagonal() * damping;

  Matrix first_order = Matrix::Zero(2 * kFreedoms, 2 * kFreedoms);
  first_order.topRightCorner(kFreedoms, kFreedoms).setIdentity();
  first_order.bottomLeftCorner(kFreedoms, kFreedoms) = -stiffness;
  first_order.bottomRightCorner(kFreedoms, kFreedoms) = -damping;
  const Eigen::EigenSolver<Matrix> solver(first_order);

  WagonModes<kPerBogie> result{};
  int slow = 0;
  for (int k = 0; k < 2 * kFreedoms; ++k) {
    const std::complex<double> lambda = solver.eigenvalues()[k];
    constexpr double kStill = 0.1;  // [1/s]; the slowest real mode swings at about 10 1/s
    if (std::abs(lambda) < kStill) ++slow;
    if (std::abs(lambda) < kStill || lambda.imag() < 0.0) continue;
    const Eigen::VectorXcd shape = solver.eigenvectors().col(k).head(kFreedoms);
    int largest = 0;
    shape.cwiseAbs().maxCoeff(&largest);
    const Vector energy = mass.cwiseProduct(shape.cwiseAbs2());
    result.modes.push_back({std::abs(lambda) / kTwoPi, -lambda.real() / std::abs(lambda),
                            Unpack<kPerBogie>((shape / shape[largest]).real()),
                            Unpack<kPerBogie>(energy / energy.sum())});
  }
  result.rigid_body_modes = slow / 2;
  std::sort(result.modes.begin(), result.modes.end(),
            [](const auto& a, const auto& b) { return a.frequency_hz < b.frequency_hz; });

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

template WagonModes<2> AnalyseModes(const BogieVehicle<2>&);
template WagonModes<3> AnalyseModes(const BogieVehicle<3>&);

}  // namespace train_dynamics
