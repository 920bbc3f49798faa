// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "oca/diagrams/foresight/motion_ahead.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/models/planning/clairvoyant.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/signals/model_set.h"
#include "oca/systems/signals/roles.h"

namespace oca::foresight {

/// What a diagram says beforehand about one robot, for all times from 0 to a duration: what is
/// requested of it, and everything that the distance block sees by which a run is judged.
///
/// - judge: the system that Judges the model, and the one that MeasuresDistances for it, from which
///   its `proximities` come
/// - request: the nearest system up the line from the judge's `request` that knows it ahead
/// - start: where the judge's `position` is at time 0
/// - obstacles: what drives the distance block's `obstacles`, at every time; a HoldsObstacles
///   between its samples too
/// - own links, if the block looks at them
/// - links of other models that it looks at: where they stand, along what their kinematics are
///   given, or else along what is requested of them
///
/// Left out is what the block leaves out: pairs that it ignores, and the lowest pair of two arms.
/// Times are in s, positions of joints in rad or m, poses in m and the world. One a thread: bodies
/// share the context from which they tell where they are.
class Foresight {
 public:
  /// `model` may be empty if only one robot is judged; `models` are those of the diagram, which
  /// must outlive this.
  /// throws ConfigError `port: what; ...` for what nobody can know beforehand (obstacles that
  ///        depend on the run, as a sensor's; a request without a source that knows it), for ports
  ///        of the judge that nothing drives, and unless there is just one judge
  Foresight(const Diagram& diagram, const systems::ModelSet& models, const std::string& model,
            double duration);

  const std::string& model_name() const { return name_; }
  /// As the file has it; own links that may touch are disabled.
  const std::shared_ptr<const robot::RobotModel>& model() const { return model_; }
  /// Path of the system that a run is judged by.
  const std::string& judge() const { return judge_; }
  /// What that looks at: systems and models by name.
  const std::vector<std::string>& sees() const { return sees_; }

  const motion::Trajectory& request() const { return *request_; }
  const Eigen::VectorXd& start() const { return start_; }
  double duration() const { return duration_; }
  /// The obstacles, then the solids of other models' links, named MODEL/LINK.
  const std::vector<planning::BandBody>& bodies() const { return bodies_; }
  /// Whether the robot's own links count as bodies, too.
  bool own_links() const { return distances_->own_links; }
  /// Pairs that may touch: a link of the model and a place in bodies().
  const std::vector<std::pair<int, int>>& ignored() const { return ignored_; }

  /// All of this as a task; `seed` and `starts` are yet to be given. Must not outlive this.
  planning::ClairvoyantTask Task() const;

 private:
  const systems::Judges& FindJudge(const systems::ModelSet& models, const std::string& model);
  void FindDistances(const systems::Judges& judge);
  void FindMotion(const systems::Judges& judge);
  void AddObstacles();
  void AddOther(const systems::MeasuresDistances::Other& of,
                const std::shared_ptr<const robot::RobotModel>& other);
  void AddLinks(const std::string& name, const std::shared_ptr<const robot::RobotModel>& other,
                Positions positions);
  void Ignore();
  void IgnoreLowest(const robot::RobotModel& other, int other_link, std::size_t first_body);
  std::optional<OutputHandle> DriverOf(const InputHandle& input) const;

  const Diagram& diagram_;
  const double duration_;
  std::string name_;
  std::shared_ptr<const robot::RobotModel> model_;
  std::string judge_;
  std::string distance_;  ///< the block that measures distances for it
  const systems::MeasuresDistances* distances_{nullptr};
  std::shared_ptr<const motion::Trajectory> request_;
  Eigen::VectorXd start_;
  std::vector<planning::BandBody> bodies_;
  std::vector<std::pair<int, int>> ignored_;
  std::vector<std::string> sees_;
};

}  // namespace oca::foresight
