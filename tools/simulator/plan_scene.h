// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/models/planning/clairvoyant.h"
#include "oca/systems/commands/trajectory.h"
#include "oca/systems/signals/roles.h"

namespace oca::tools {

/// What a loaded file says about one robot for all its time: what is requested of it, and
/// everything that the distance block sees by which a run of the file is judged.
///
/// - judge: the system that Judges the model, and the one that MeasuresDistances for it and drives
///   its `proximities`
/// - request: the nearest system up the line from the judge's `request` that knows it ahead
/// - start: where the judge's `position` is at time 0
/// - obstacles: what drives the distance block's `obstacles`, at every time; a HoldsObstacles
///   between its samples too
/// - own links, if the block looks at them
/// - links of other models that it looks at: where they stand, along what their kinematics are
///   given, or else along what is requested of them
///
/// Left out is what the block leaves out: pairs that it ignores, and the lowest pair of two arms.
/// Whatever nobody can know beforehand is refused by name.
class PlanScene {
 public:
  /// `model` may be empty if only one robot is judged. `loaded` must outlive this.
  /// throws ConfigError
  PlanScene(const loading::LoadedDiagram& loaded, const std::string& model, double duration);

  const std::string& model_name() const { return name_; }
  /// As the file has it; own links that may touch are disabled.
  const std::shared_ptr<const robot::RobotModel>& model() const { return model_; }
  /// The system that a run is judged by.
  const std::string& judge() const { return judge_; }
  /// What it looks at: systems and models by name.
  const std::vector<std::string>& sees() const { return sees_; }
  /// All but `starts`; must not outlive this.
  planning::ClairvoyantTask Task() const;

 private:
  const systems::Judges& FindJudge(const std::string& model);
  void FindDistances(const systems::Judges& judge);
  void FindMotion(const systems::Judges& judge);
  void AddObstacles();
  void AddOther(const systems::MeasuresDistances::Other& of);
  void AddLinks(const std::string& name, const std::shared_ptr<const robot::RobotModel>& other,
                std::function<Eigen::VectorXd(double time)> positions);
  void Ignore();
  std::optional<OutputHandle> DriverOf(const InputHandle& input) const;
  std::string Described(const System& system) const;
  void IgnoreLowest(const robot::RobotModel& other, int other_link, std::size_t first_body);

  const loading::LoadedDiagram& loaded_;
  const double duration_;
  std::string name_;
  std::shared_ptr<const robot::RobotModel> model_;
  std::string judge_;
  std::string distance_;  ///< the block that measures distances for it
  const systems::MeasuresDistances* distances_{nullptr};
  std::shared_ptr<const systems::Trajectory> request_;
  Eigen::VectorXd start_;
  std::vector<planning::BandBody> bodies_;
  std::vector<std::pair<int, int>> ignored_;
  std::vector<std::string> sees_;
};

}  // namespace oca::tools
