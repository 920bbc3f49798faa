// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/plan_bodies.h"

#include <algorithm>
#include <utility>

#include "oca/framework/dataflow/port_access.h"
#include "oca/models/robot/kinematics.h"

namespace oca::tools {
namespace {

constexpr double kStep = 1e-3;      // s, at which a script is searched for bodies
constexpr double kFarBelow = -1e4;  // m; a half-space too is below it

long StepsOf(double duration) { return static_cast<long>(duration / kStep) + 1; }

}  // namespace

ObstacleScript::ObstacleScript(std::shared_ptr<const Diagram> diagram, const OutputHandle& output)
    : diagram_(std::move(diagram)),
      output_(Typed<systems::ObstacleSet>(output)),
      context_(diagram_->MakeContext()) {}

std::vector<planning::BandBody> ObstacleScript::Bodies(
    const std::shared_ptr<ObstacleScript>& script, double duration) {
  struct Seen {
    std::shared_ptr<const systems::ObstacleBody> body;
    std::size_t place;
    Eigen::Isometry3d X_WO;
    long times{0};
    bool moves{false};
  };
  std::vector<Seen> seen;
  const long steps = StepsOf(duration);
  for (long k = 0; k < steps; ++k) {
    script->context_.SetTime(static_cast<double>(k) * kStep);
    const auto& obstacles = script->output_.Eval(script->context_).obstacles;
    for (std::size_t place = 0; place < obstacles.size(); ++place) {
      const systems::Obstacle& obstacle = obstacles[place];
      const auto same = [&](const Seen& entry) { return entry.body == obstacle.body; };
      auto entry = place < seen.size() && same(seen[place])
                       ? seen.begin() + static_cast<std::ptrdiff_t>(place)
                       : std::find_if(seen.begin(), seen.end(), same);
      if (entry == seen.end()) {
        seen.push_back({obstacle.body, place, obstacle.X_WO});
        entry = seen.end() - 1;
      }
      ++entry->times;
      entry->moves = entry->moves || entry->X_WO.matrix() != obstacle.X_WO.matrix();
    }
  }
  std::vector<planning::BandBody> bodies;
  for (const Seen& entry : seen) {
    const bool stands = !entry.moves && entry.times == steps;
    const auto pose = [script, body = entry.body, place = entry.place, X = entry.X_WO, stands](
                          double time) { return stands ? X : script->PoseOf(*body, place, time); };
    bodies.push_back({entry.body->id, entry.body->collider, pose, stands});
  }
  return bodies;
}

Eigen::Isometry3d ObstacleScript::PoseOf(const systems::ObstacleBody& body, std::size_t place,
                                         double time) {
  context_.SetTime(time);
  const auto& obstacles = output_.Eval(context_).obstacles;
  if (place < obstacles.size() && obstacles[place].body.get() == &body) {
    return obstacles[place].X_WO;
  }
  for (const systems::Obstacle& obstacle : obstacles) {
    if (obstacle.body.get() == &body) return obstacle.X_WO;
  }
  Eigen::Isometry3d nowhere = Eigen::Isometry3d::Identity();
  nowhere.translation().z() = kFarBelow;
  return nowhere;
}

OtherMotion::OtherMotion(std::shared_ptr<const robot::RobotModel> model,
                         std::function<Eigen::VectorXd(double time)> positions)
    : model_(std::move(model)),
      positions_(std::move(positions)),
      X_WL_(robot::LinkPoses(*model_, positions_(0.0))) {}

const Eigen::Isometry3d& OtherMotion::X_WL(int link, double time) {
  if (time != time_) {
    robot::ForwardKinematics(*model_, positions_(time), X_WL_);
    time_ = time;
  }
  return X_WL_[static_cast<std::size_t>(link)];
}

bool OtherMotion::Stands(double duration) {
  if (model_->num_positions() == 0) return true;
  const Eigen::VectorXd first = positions_(0.0);
  for (long k = 1; k < StepsOf(duration); ++k) {
    if (positions_(static_cast<double>(k) * kStep) != first) return false;
  }
  return true;
}

std::vector<planning::BandBody> BodiesOf(const std::shared_ptr<OtherMotion>& motion,
                                         const robot::LinkCollider& link, models::Name name,
                                         bool stands) {
  std::vector<planning::BandBody> bodies;
  for (const auto& element : link.elements) {
    const auto pose = [motion, number = link.number, X_LC = element.X_LC](double time) {
      return Eigen::Isometry3d(motion->X_WL(number, time) * X_LC);
    };
    bodies.push_back({name, element.collider, pose, stands});
  }
  return bodies;
}

}  // namespace oca::tools
