#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "train_brake_rviz/board/drawing.h"
#include "train_dynamics/track/track.h"
#include "train_dynamics/train/lockstep.h"
#include "train_dynamics/vehicle/vehicle_params.h"
#include "train_dynamics/vehicle/wagon.h"

namespace train_brake_rviz {

/// One wagon from its left side: nine bodies that move, wheels that turn, forces as arrows. The front is on
/// the left.
///
/// Bodies are drawn to scale; their motion against the wagon at rest, and dips of the rail, are exaggerated.
class CloseUp {
 public:
  /// Positions of the bodies of a vehicle with up to three wheelsets per bogie.
  using Bodies = train_dynamics::BodyVector<double, 3>;
  template <int kPerBogie>
  static Bodies BodiesOf(const train_dynamics::BodyVector<double, kPerBogie>& position) {
    Bodies bodies;
    std::copy(position.x.begin(), position.x.end(), bodies.x.begin());
    std::copy(position.z.begin(), position.z.end(), bodies.z.begin());
    std::copy(position.pitch.begin(), position.pitch.end(), bodies.pitch.begin());
    return bodies;
  }

  /// @param at_rest  positions of the bodies of the wagon at rest
  CloseUp(const Rectangle& area, const train_dynamics::VehicleParams& vehicle, const Bodies& at_rest,
          double motion_exaggeration);

  /// What is known of the wagon.
  struct Sight {
    std::string title, remark;
    double centre_m;                            ///< position of its centre along the track
    const train_dynamics::WagonDetail* detail;  ///< null: drawn at rest, with wheels that roll
    double front_force_n, rear_force_n;         ///< of its couplers, tension positive; 0: none, or slack
    Color color;                                ///< of its carbody
  };

  void Draw(Drawing& drawing, const train_dynamics::Track& track, const Sight& sight) const;

  /// Where a point of a body is drawn.
  /// @param offset_forward_m, offset_up_m  from the body's centre of gravity, in the body
  Point PlaceOf(const Bodies& position, int body, double offset_forward_m, double offset_up_m) const;
  double scale() const { return scale_; }  ///< board units per metre
  double rail() const { return rail_; }    ///< height of the level rail on the board

  /// Lengths of arrows, board units per newton.
  static constexpr double kLoadScale = 2.8 / 400e3, kFrictionScale = 4.0 / 10e3, kCouplerScale = 12.0 / 1e6;

 private:
  void DrawRail(Drawing& drawing, const train_dynamics::Track& track, double centre_m) const;
  void DrawBodies(Drawing& drawing, const Bodies& position, Color body) const;
  void DrawWheelset(Drawing& drawing, const Bodies& position, int wheelset, bool slides, bool locked) const;
  void DrawContactForces(Drawing& drawing, const train_dynamics::WagonDetail& detail) const;
  void DrawCouplerForce(Drawing& drawing, const Bodies& position, double end, double force_n) const;

  Rectangle area_;
  train_dynamics::VehicleParams vehicle_;
  Bodies at_rest_;
  double exaggeration_;
  double scale_, rail_;
  std::array<double, train_dynamics::kBodiesOf<3>> forward_m_, height_m_;  ///< of the bodies' centres at rest
};

}  // namespace train_brake_rviz
