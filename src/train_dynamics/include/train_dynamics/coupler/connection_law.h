#pragma once

/// The interface of a law of the force between two vehicles.
///
/// A law is a struct of constant parameters with
///
///   kAccount                    the account of the energy ledger that its dissipation goes to
///   kStoresByMemory             how the ledger books it, see below
///   Memory<T>                   what it remembers between two evaluations, with ForEachField; NoMemory if nothing
///   AtRest(q)                   the memory of a connection that rests at q [m] at the start
///   Slack()                     free play in total [m]
///   TangentAt(force_n)          stiffness and damping of small motions about a force
///
/// and with the free functions
///
///   GearForce<T> ConnectionForce(law, q, q_rate, memory)   the force; moves the memory on
///   T StoredEnergy(law, q, memory)                         energy that can be got back [J]
///
/// q is the extension relative to the unstretched length [m], tension positive; the slack is +-slack/2. The laws are a
/// closed set: OfConnectionLaws in coupler/connection.h. A new one is a header and an entry there.
///
/// The part of the work F dq of an interval that is dissipated:
///
///   F dq - d StoredEnergy           if kStoresByMemory: what can be got back depends on the path; not below 0 if
///                                   kRateIndependent, so that the error of a finite step appears in the residual
///   (F - F_elastic) dq              otherwise, F_elastic the slope of StoredEnergy
namespace train_dynamics {

/// Force of a connection [N] and the elastic part of it; both tension positive.
template <class T>
struct GearForce {
  T force;
  T elastic;
};

/// Small motions about a state: dF = stiffness dq + damping dq'.
struct ConnectionTangent {
  double stiffness_n_per_m;
  double damping_ns_per_m;
  bool depends_on_force;  ///< whether the tangent depends on the force
};

/// The largest force that connections are judged by [N]: that of the paper's emergency brake.
inline constexpr double kLargeCouplerForce = 900e3;

/// The energy ledger's accounts of connections.
enum class ConnectionAccount { kDraftGears, kDrawBars };

/// The memory of a law whose force depends on q and q' alone.
template <class T>
struct NoMemory {
  template <class Function>
  void ForEachField(Function&& /*field*/) {}
};

/// What a law with stick remembers.
template <class T>
struct StickState {
  T q;      ///< extension at the last evaluation [m]
  T force;  ///< force at the last evaluation, solid stop left out [N], tension positive

  template <class Function>
  void ForEachField(Function&& field) {
    field(q);
    field(force);
  }
};

}  // namespace train_dynamics
