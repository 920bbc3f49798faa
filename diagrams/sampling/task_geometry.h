// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>

#include "oca/diagrams/files/catalogue.h"
#include "oca/diagrams/foresight/motion_ahead.h"
#include "oca/diagrams/foresight/obstacles_ahead.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/value.h"
#include "oca/models/robot/clearance.h"

namespace oca::sampling {

/// Which parts of a diagram make up the task that scenarios are accepted by.
struct TaskNames {
  std::string model{"arm"};
  std::string request{"spline"};
  std::string obstacles{"obstacles"};
};

/// A model as the last scenario left it: trying many, only its place in the world changes.
struct ModelCache {
  Value entry;  ///< of `models`, without base_pose
  std::shared_ptr<const robot::RobotModel> model;
};

/// The task of one scenario as geometry: a robot, and how near it comes to what the tree says
/// beforehand (foresight) of its requested motion and of the obstacles.
class TaskGeometry {
 public:
  /// From a tree whose ${...} are worked out. What is wrong is added to `problems`; then nothing
  /// else may be called. `catalogue` has the types of its systems and must outlive it.
  TaskGeometry(const Value& root, const TaskNames& names, const files::Catalogue& catalogue,
               ModelCache& cache, Problems& problems);

  const robot::RobotModel& model() const { return *model_; }
  double duration() const { return duration_; }  ///< s, of the run
  /// Requested joint positions at a time.
  Eigen::VectorXd Request(double time) const { return request_(time); }
  /// Where the robot goes in the end.
  Eigen::VectorXd Goal() const { return Request(duration_); }
  /// Poses of all links.
  std::vector<Eigen::Isometry3d> LinkPosesAt(const Eigen::VectorXd& q) const;

  /// Replaces the obstacles by the list that `systems` of such a tree now has.
  void SetObstacles(const Value& root, Problems& problems);
  /// Least distance (m) of the moving links at q to the obstacles that are there at a time.
  double Distance(const Eigen::VectorXd& q, double time);
  /// The same over the whole run at the requested positions, every 0.01 s; ends early below
  /// `enough`.
  double RequestedDistance(double enough);
  /// The same of the link alone that the first joint moves.
  double FootDistance();
  /// Least height (m) of the origins of all links at q.
  double LowestLinkOrigin(const Eigen::VectorXd& q) const;
  /// Whether a planner with this seed finds a way from the first request to the goal among the
  /// obstacles of time 0. It keeps clear of itself too.
  bool HasClearPath(double margin, int most_nodes, std::uint64_t seed);

 private:
  /// A system of the tree alone; nullptr, with problems, if it cannot be made.
  std::unique_ptr<Diagram> Source(const Value& root, const std::string& name,
                                  Problems& problems) const;
  void LoadModel(const Value& root, ModelCache& cache, Problems& problems);
  void PlaceObstacles(double time);

  const files::Catalogue& catalogue_;
  TaskNames names_;
  double duration_{0.0};
  std::shared_ptr<const robot::RobotModel> model_;
  std::optional<robot::Clearance> clearance_;
  std::unique_ptr<Diagram> request_source_;
  foresight::Positions request_;  ///< of that
  std::optional<foresight::ObstaclesAhead> obstacles_;
};

}  // namespace oca::sampling
