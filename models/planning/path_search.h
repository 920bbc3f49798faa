// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "oca/models/planning/path_shortening.h"
#include "oca/models/planning/tree_pair.h"
#include "oca/models/robot/clearance.h"

namespace oca::planning {

/// Distances that a search asks for, one after the other, m; falling.
struct SearchLevels {
  std::vector<double> margins{};
  int nodes{400};           ///< of both trees, after which the next one is tried
  int last_nodes{6000};     ///< at the last one, after which there is no way
  long patience{12000};     ///< evaluations without getting nearer, where the goal is not clear
  double least_gain{0.02};  ///< share of the distance to the goal that counts as nearer
  int shortcuts{0};         ///< attempts to shorten what was found, before it is found
};

/// A search for a path of straight joint motions past bodies at rest that goes on where it ended,
/// from plan to plan, so that many small looks find what one cannot. A value.
///
/// While the goal is clear: RRT-Connect at the first of the levels, then, with the same trees, at
/// the next ones. Where the goal is not clear, and besides where it is: positions within the ball
/// about the goal that is nearer than the nearest known are tried from the start's tree, and from
/// the nearest one the way down the distance to the goal along what is in the way (a projection
/// within linearised distances). The nearest position reached is where an arm may rest.
///
/// What is found is shortened, as it goes on. Edges are looked at by samples; the path that was
/// found is proved clear at its level, and, of an exhausted search, the one to the nearest position
/// (TreePair, CertifiedMotion). The same calls give the same answers. Allocates.
/// source Kuffner, LaValle, RRT-Connect, 2000; Gammell et al., Informed RRT*, IROS 2014 (the ball)
class PathSearch {
 public:
  enum class State { kIdle, kSearching, kFound, kExhausted };

  State state() const { return state_; }
  /// Forgets all.
  void Reset() { *this = {}; }
  /// Whether it searches, or searched, for this goal.
  bool IsFor(const Eigen::VectorXd& goal) const;
  /// Begins anew. `goal_clear` says whether the goal itself can be had.
  void Begin(const Eigen::VectorXd& start, const Eigen::VectorXd& goal, bool goal_clear,
             SearchLevels levels, std::uint64_t seed);
  /// From now on paths begin at `start`; what was found stays as far as a clear motion leads there.
  void MoveStart(robot::Clearance& clearance, const Eigen::VectorXd& start, long& evaluations);
  /// Looks at about `most` configurations; adds what it looked at to `evaluations`.
  void Continue(robot::Clearance& clearance, long most, long& evaluations);

  /// After kExhausted: from now on the nearest position reached is the goal, and the path there,
  /// which was proved, is found, once it is shortened.
  void AimAtNearest();

  /// How often somebody tried to follow what was found, who counts it.
  int tries() const { return tries_; }
  void CountTry() { ++tries_; }

  /// At the end of kFound: from the start to the goal.
  const std::vector<Eigen::VectorXd>& path() const { return shortening_.path(); }
  /// The level that the search is at, m.
  double margin() const { return levels_.margins[static_cast<std::size_t>(level_)]; }
  /// The reached position nearest to the goal (2-norm of the joints), and the path there.
  Eigen::VectorXd nearest() const { return trees_.from_start.q(nearest_); }
  std::vector<Eigen::VectorXd> PathToNearest() const { return trees_.from_start.PathTo(nearest_); }
  double nearest_distance() const { return nearest_distance_; }

 private:
  struct Tools;
  void Draw(Tools& tools);
  void Connect(Tools& tools);
  void Approach(Tools& tools);
  void Descend(Tools& tools, int from);
  bool AtLastLevel() const;
  /// Or draws, if these are more.
  int NodesOfLevel() const;
  void Note(int node, double least_gain);
  bool TryStraight(Tools& tools);
  void Find(std::vector<Eigen::VectorXd> path);
  void SearchOn();
  void FindNearest();
  void ProveNearest(Tools& tools);

  State state_{State::kIdle};
  Eigen::VectorXd goal_{};
  bool goal_clear_{false};
  SearchLevels levels_{};
  TreePair trees_;
  int level_{0};
  int level_nodes_{0};  ///< of both trees when the level began
  std::uint64_t seed_{0};
  std::uint64_t draws_{0};
  int nearest_{0};
  double nearest_distance_{0.0};
  int improvements_{0};
  long since_{0};         ///< evaluations since the last gain
  bool shortens_{false};  ///< a path was found
  PathShortening shortening_;
  int tries_{0};
};

}  // namespace oca::planning
