// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/foresight/obstacles_ahead.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "oca/diagrams/foresight/time_steps.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/systems/signals/roles.h"

namespace oca::foresight {
namespace {

using systems::HoldsObstacles;
using systems::Obstacle;
using systems::ObstacleBody;

constexpr double kFarBelow = -1e4;  // m; a half-space too is below it

struct Seen {
  std::shared_ptr<const ObstacleBody> body;
  std::size_t place;
  Eigen::Isometry3d X_WO;
  long times{0};
  bool moves{false};
};

std::vector<Seen> LookAtAll(ObstaclesAhead& ahead, const TimeSteps& steps) {
  std::vector<Seen> seen;
  for (long k = 0; k < steps.size(); ++k) {
    const auto& obstacles = ahead.At(steps[k]).obstacles;
    for (std::size_t place = 0; place < obstacles.size(); ++place) {
      const Obstacle& obstacle = obstacles[place];
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
  return seen;
}

/// `place`: where it is likely to be in the list.
Eigen::Isometry3d PoseOf(const std::vector<Obstacle>& obstacles, const ObstacleBody& body,
                         std::size_t place) {
  if (place < obstacles.size() && obstacles[place].body.get() == &body) {
    return obstacles[place].X_WO;
  }
  for (const Obstacle& obstacle : obstacles) {
    if (obstacle.body.get() == &body) return obstacle.X_WO;
  }
  Eigen::Isometry3d nowhere = Eigen::Isometry3d::Identity();
  nowhere.translation().z() = kFarBelow;
  return nowhere;
}

}  // namespace

ObstaclesAhead::ObstaclesAhead(std::shared_ptr<const Diagram> diagram, const OutputHandle& output,
                               const std::string& where)
    : diagram_(std::move(diagram)),
      output_(Typed<systems::ObstacleSet>(output)),
      context_(diagram_->MakeContext()) {
  if (diagram_->UpstreamOf(output, Through::kInstant).of_time_alone()) return;
  throw ConfigError(fmt::format(
      "{}: driver; got '{}', which depends on the run; expected a source that time alone moves",
      where, diagram_->PathOf(*output.system)));
}

std::shared_ptr<ObstaclesAhead> ObstaclesAhead::Of(const Diagram& diagram,
                                                   const OutputHandle& output,
                                                   const std::string& where) {
  const std::shared_ptr<const Diagram> shared(std::shared_ptr<void>(), &diagram);
  auto sampled = std::make_shared<ObstaclesAhead>(shared, output, where);
  const auto* const holds = output.system->role<HoldsObstacles>();
  if (holds == nullptr || !holds->unsampled || diagram.DriverOf(holds->offsets)) return sampled;
  const std::shared_ptr<const Diagram> own = MakeDiagramOf(holds->unsampled());
  const auto always = own->FindRoles<HoldsObstacles>();
  return std::make_shared<ObstaclesAhead>(own, always.at(0).role->obstacles, where);
}

const systems::ObstacleSet& ObstaclesAhead::At(double time) {
  context_.SetTime(time);
  return output_.Eval(context_);
}

std::vector<planning::BandBody> BodiesInTime(const std::shared_ptr<ObstaclesAhead>& obstacles,
                                             double duration) {
  const TimeSteps steps(duration);
  std::vector<planning::BandBody> bodies;
  for (const Seen& entry : LookAtAll(*obstacles, steps)) {
    const bool stands = !entry.moves && entry.times == steps.size();
    const auto pose = [obstacles, body = entry.body, place = entry.place, X = entry.X_WO,
                       stands](double time) {
      return stands ? X : PoseOf(obstacles->At(time).obstacles, *body, place);
    };
    bodies.push_back({entry.body->id, entry.body->collider, pose, stands});
  }
  return bodies;
}

}  // namespace oca::foresight
