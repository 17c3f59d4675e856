#pragma once

#include <optional>
#include <vector>

#include "train_dynamics/coupler/connection_kernels.h"
#include "train_dynamics/numeric/digest.h"
#include "train_dynamics/train/consist.h"

namespace train_dynamics {

/// Largest tension and compression of a connection so far, and when.
struct ForceExtremes {
  double tension_n = 0.0, tension_time_s = 0.0;          ///< >= 0
  double compression_n = 0.0, compression_time_s = 0.0;  ///< <= 0
};

/// A connection that broke.
struct Parting {
  int connection;  ///< from 0
  double time_s;
};

/// Energy of the connections [J].
struct ConnectionEnergy {
  double potential = 0.0;          ///< elastic energy stored now
  double draft_gears = 0.0;        ///< dissipated so far
  double draw_bars = 0.0;          ///< dissipated so far
  std::optional<double> external;  ///< work done on external vehicles so far; none: there are none
};

/// The forces between the vehicles of a train.
///
/// Extension of connection c:  q_c = q_start + u_c - u_(c+1),  u the displacements of the coupler heads.
/// Forces are evaluated at the middle of the coming exchange interval H, predicted from its start,
///
///   F = F(q + q' H/2, q'),
///
/// and held over it. With the force at the interval's start instead, the exchange would feed energy into
/// undamped connections (a negative damping ratio of omega H / 4). Exact when H is one step of the leapfrog
/// integrator.
class InTrainForces {
 public:
  /// @param prediction_s  how far ahead of the exchange the forces are evaluated: H/2, or 0 for the Newmark
  /// integrator
  /// @param external  indices of the external vehicles, ascending: the work done on them is booked
  InTrainForces(const Consist& consist, SlackState slack, double prediction_s, const std::vector<int>& external = {});

  /// Takes the heads' displacements at time 0, at which the connections have their initial state of slack.
  void Begin(const std::vector<double>& head_displacement_m);

  /// Forces for the coming interval, booked at time_s, from the heads' velocities [m/s].
  /// `force_n` gets n + 1 entries for n vehicles: [i] is in front of vehicle i, [i + 1] behind it; the ends
  /// are 0.
  void Evaluate(double time_s, const std::vector<double>& head_velocity_mps, std::vector<double>& force_n);

  /// Books the work of the last forces, once the interval has brought the heads to these displacements.
  void CloseInterval(const std::vector<double>& head_displacement_m);

  int connections() const { return static_cast<int>(places_.size()); }
  /// [connection], from the front
  std::vector<ForceExtremes> Extremes() const;
  /// The connections that broke so far, in the order of times, those of one time from the front.
  std::vector<Parting> Partings() const;
  /// Extension of each connection at the last exchange [m].
  void Extensions(std::vector<double>& extension_m) const;
  /// Adds the memory of the laws, which is part of the train's state.
  void AddMemoryTo(Digest& digest) const;
  ConnectionEnergy Energy() const;

  /// All that later forces, energies and extremes depend on, between two exchanges.
  std::vector<double> Memory() const;
  /// @throws SnapshotError if its length does not fit the connections
  void SetMemory(const std::vector<double>& memory);

 private:
  /// Connections of one type, at equal distances in the train.
  struct Row {
    int at;     ///< index of the first connection in its set
    int place;  ///< index of the first connection in the train
    int stride, count;
  };
  /// The connections of one type, side by side, filled up to whole packs of lanes.
  struct Set {
    explicit Set(const ConnectionParams& params) : law(params.Law()), strength_n(params.strength_n) {}
    /// Appends a connection of the train.
    void Add(int place);
    /// Puts all connections to this extension, without force.
    void Begin(double extension_m);
    /// Puts one of them to another extension, likewise.
    void Begin(int at, double extension_m);
    int Padded() const { return static_cast<int>(rate_mps.size()); }
    ConnectionArrays Arrays();

    /// Books the energy of connections that broke at a time.
    void Part(double time_s);

    ConnectionLaw law;
    double strength_n;
    std::vector<int> place;  ///< [connection of the set] in the train
    std::vector<Row> rows;   ///< the same
    std::vector<double> start_extension_m, next_extension_m;
    std::vector<double> rate_mps, extension_m, force_n, elastic_n;
    std::vector<double> memory;  ///< of the law, [field][connection]
    std::vector<double> tension_n, tension_time_s, compression_n, compression_time_s;
    std::vector<double> stored_j, dissipated_j;
    std::vector<double> parted_s;  ///< time of parting; < 0: not parted
  };
  /// Where a connection of the train is.
  struct Place {
    int set, at;
  };

  /// Calls function(number) for each number that the law of a connection remembers.
  template <class OfSet, class Function>
  static void ForEachField(OfSet& set, int at, Function& function);
  /// Calls function(number) for each number of the memory, connection by connection.
  template <class Self, class Function>
  static void ForEachMemory(Self& self, Function& function);

  /// A vehicle that another program moves, and the work of its couplers on it.
  struct External {
    int vehicle;
    double displacement_m = 0.0, work_j = 0.0;
  };
  double ForceOf(int connection) const { return sets_[places_[connection].set].force_n[places_[connection].at]; }

  double prediction_s_;
  std::vector<External> external_;
  std::vector<Set> sets_;
  std::vector<Place> places_;  ///< [connection]
};

}  // namespace train_dynamics
