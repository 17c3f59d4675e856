#pragma once

#include <map>
#include <string>
#include <vector>

#include "train_brake_rviz/board/along_train.h"
#include "train_brake_rviz/board/axis.h"
#include "train_brake_rviz/board/close_up.h"
#include "train_brake_rviz/board/drawing.h"
#include "train_brake_rviz/board/elevation.h"
#include "train_brake_rviz/board/quantity.h"
#include "train_brake_rviz/board/snapshot.h"
#include "train_brake_rviz/board/train_strip.h"
#include "train_dynamics/train/scenario.h"

namespace train_brake_rviz {

/// What the user has chosen to see.
struct Selection {
  const Quantity* quantity = &Quantities().front();  ///< that colours the vehicles
  int vehicle = 0;                                   ///< followed by the close-up; index from 0
};

struct BoardOptions {
  double vertical_exaggeration = 0.0;  ///< of grades and dips under the train; 0 = what fits
  double motion_exaggeration = 10.0;   ///< of the motion of the followed wagon's bodies
};

/// The parts of the picture, each of which can be hidden.
struct Picture {
  Drawing numbers, plots, train, close_up, legend;
};

/// The whole view of a train: see layout.h. Keeps in mind what it has seen, so that scales only grow.
class Board {
 public:
  explicit Board(const train_dynamics::ScenarioParams& scenario, const BoardOptions& options = {});

  int vehicles() const { return consist_.vehicles(); }
  const std::vector<int>& locomotives() const { return consist_.locomotives; }

  /// @param snapshot  arrays as long as the train, or empty
  Picture Draw(const Snapshot& snapshot, const Selection& selection);

  /// Forgets what it has seen, for a run that begins anew.
  void Forget();

 private:
  /// Smallest and largest value so far, [connection] or [vehicle].
  struct Seen {
    std::vector<double> low, high;
    void Include(const std::vector<double>& values);
  };

  Abscissa AbscissaOf(const Snapshot& snapshot) const;
  std::vector<double> VehicleGrid(const Snapshot& snapshot) const;
  void Remember(const Snapshot& snapshot, const Selection& selection);
  void DrawNumbers(Drawing& drawing, const Snapshot& snapshot) const;
  void DrawForces(Drawing& drawing, const Snapshot& snapshot, const Abscissa& abscissa) const;
  void DrawPressures(Drawing& drawing, const Snapshot& snapshot, const Abscissa& abscissa) const;
  void DrawTrain(Drawing& drawing, const Snapshot& snapshot, const Selection& selection,
                 const Abscissa& abscissa) const;
  void DrawCloseUp(Drawing& drawing, const Snapshot& snapshot, const Selection& selection) const;
  void DrawLegend(Drawing& drawing, const Selection& selection) const;
  std::vector<Color> Colors(const Snapshot& snapshot, const Selection& selection) const;

  train_dynamics::ScenarioParams scenario_;
  train_dynamics::Consist consist_;
  std::vector<double> masses_kg_;  ///< [vehicle]
  BoardOptions options_;
  Elevation elevation_;
  double window_m_;  ///< length of track that is seen
  double vertical_exaggeration_;
  std::vector<train_dynamics::BodyVector<double>> at_rest_;  ///< [type of vehicle]

  Seen forces_seen_, pressures_seen_;
  GrowingLimit force_limit_kn_, pressure_limit_kpa_;
  std::map<std::string, GrowingLimit> color_limit_;  ///< by name of the quantity, in its unit
};

}  // namespace train_brake_rviz
