// SPDX-License-Identifier: BSD-3-Clause
// What BulletDistance looks at, of its model and others: where it looks at nothing, it must not be
// taken to say that nothing is near.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <stdexcept>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/robot_model.h"
#include "oca/models/robot/unseen_links.h"
#include "oca/systems/sensing/bullet_distance.h"

namespace oca::systems {
namespace {

bool Moves(const robot::RobotModel& model) { return model.num_positions() > 0; }

int LowestMovable(const robot::RobotModel& model) {
  return model.bodies().empty() ? -1 : model.bodies().front();
}

/// Whether `name`, which no model has, is nearly that of one.
bool LooksMisspelt(const std::string& name, const ModelSet& models) {
  std::vector<std::string> names;
  for (const auto& [full, model] : models.all()) names.push_back(full);
  for (const auto& [full, in_file] : models.in_sight()) names.push_back(in_file);
  return !DidYouMean(name, names).empty();
}

}  // namespace

bool BulletDistance::LooksAtAll(const Params& params) {
  return params.others.size() == 1 && params.others.front() == "*";
}

std::string BulletDistance::FullLinkName(const ModelSet& models, const std::string& name) {
  const std::size_t slash = name.find('/');
  if (slash == std::string::npos) return name;
  return models.FullName(name.substr(0, slash)) + name.substr(slash);
}

std::vector<BulletDistance::Neighbour> BulletDistance::MakeNeighbours(
    const std::string& name, const robot::RobotModel& model) {
  std::vector<Neighbour> neighbours;
  std::vector<Eigen::Isometry3d> X_WL;
  if (!Moves(model)) X_WL = robot::LinkPoses(model, Eigen::VectorXd(0));
  for (LinkCollider& collider : MakeLinkColliders(model)) {
    const int link = collider.number;
    const models::Name full_name(name + "/" + collider.link.text());
    const bool lowest =
        Moves(model) && (model.body(link) < 0 || model.body(link) == LowestMovable(model));
    neighbours.push_back({std::move(collider), full_name, lowest,
                          X_WL.empty() ? Eigen::Isometry3d::Identity() : X_WL[link]});
  }
  return neighbours;
}

std::vector<BulletDistance::Other> BulletDistance::MakeOthers(const Params& params,
                                                              const ModelSet& models) {
  const std::string own = models.FullName(params.model);
  std::map<std::string, std::string> all = models.in_sight();
  all.erase(own);
  if (params.calculate_link_forces && params.others.empty()) {
    std::vector<std::string> names;
    for (const auto& entry : all) names.push_back(entry.second);
    throw ConfigError(fmt::format(
        "calculate_link_forces: got true without `others`; expected the models whose links push{}",
        names.empty()
            ? "; the file has no other model (self_collision is for the robot's own links)"
            : fmt::format(", of: {}", fmt::join(names, ", "))));
  }
  std::vector<Other> others;
  const auto add = [&](const std::string& name, const std::string& local_name) {
    const auto& model = models.all().at(name);
    std::vector<Neighbour> neighbours = MakeNeighbours(name, *model);
    auto solids = MakeSolids(*model, neighbours);
    others.push_back({name, local_name, model, std::move(neighbours), std::move(solids)});
  };
  if (LooksAtAll(params)) {
    for (const auto& [name, local_name] : all) add(name, local_name);
    std::stable_sort(others.begin(), others.end(),
                     [](const Other& a, const Other& b) { return a.local_name < b.local_name; });
  } else {
    for (const std::string& given : params.others) {
      models.Get(given);  // throws if there is none
      const std::string name = models.FullName(given);
      const bool again = std::any_of(others.begin(), others.end(),
                                     [&](const Other& other) { return other.name == name; });
      if (given.empty() || again || name == own) {
        throw ConfigError(
            fmt::format("others: got '{}'; expected each other model once by its name", given));
      }
      add(name, given);
    }
  }
  const auto still = std::stable_partition(others.begin(), others.end(),
                                           [](const Other& other) { return Moves(*other.model); });
  const auto twice = std::adjacent_find(others.begin(), still, [](const Other& a, const Other& b) {
    return a.local_name == b.local_name;
  });
  if (twice != still) {
    throw ConfigError(
        fmt::format("others: got {} for both '{}' and '{}'; expected a name in this "
                    "file for either of them (models)",
                    LinksInput(twice->local_name), twice->name, std::next(twice)->name));
  }
  return others;
}

std::string BulletDistance::OutOfSight(const Params& params, const ModelSet& models) {
  if (!params.calculate_link_forces || !LooksAtAll(params)) return "";
  std::vector<std::string> names;
  for (const auto& [name, model] : models.all()) {
    if (Moves(*model) && !models.in_sight().contains(name)) names.push_back(name);
  }
  if (names.empty()) return "";
  return fmt::format(
      "others: '*' does not see {}: no links of it come into this file; expected a connection from "
      "inputs.{} here, and one to it where the file is used",
      fmt::join(names, ", "), LinksInput("<other>"));
}

std::vector<std::pair<models::Name, models::Name>> BulletDistance::MakeIgnored(
    const Params& params, const ModelSet& models) const {
  std::vector<std::pair<models::Name, models::Name>> found;
  for (std::size_t i = 0; i < params.ignore.size(); ++i) {
    const auto& pair = params.ignore[i];
    if (pair.size() != 2) {
      throw ConfigError(
          fmt::format("ignore[{}]: got {} names; expected 2: [link, obstacle]", i, pair.size()));
    }
    const std::size_t slash = pair[1].find('/');
    const std::string model = pair[1].substr(0, slash);
    try {
      model_->FindLink(pair[0]);
      if (pair[1].empty() || slash == 0) {
        throw ConfigError(
            fmt::format("obstacle; got '{}'; expected the id of one or model/link", pair[1]));
      }
      if (slash != std::string::npos) {
        const auto other = models.all().find(models.FullName(model));
        if (other != models.all().end()) {
          other->second->FindLink(pair[1].substr(slash + 1));
        } else if (LooksMisspelt(model, models)) {
          models.Get(model);
        }
      }
    } catch (const std::runtime_error& error) {
      throw ConfigError(fmt::format("ignore[{}]: {}", i, error.what()));
    }
    found.emplace_back(pair[0], FullLinkName(models, pair[1]));
    if (slash == std::string::npos || models.FullName(model) != name_) continue;
    found.emplace_back(pair[1].substr(slash + 1), name_ + "/" + pair[0]);
  }
  return found;
}

std::vector<LinkCollider> BulletDistance::MakeMovable() const {
  std::vector<LinkCollider> colliders = MakeLinkColliders(*model_);
  std::erase_if(colliders, [&](const LinkCollider& link) { return model_->body(link.number) < 0; });
  if (!colliders.empty()) return colliders;
  throw ConfigError(
      fmt::format("model: got '{}', which cannot avoid anything: {}", name_,
                  robot::DescribeUnseen(
                      *model_, fmt::format("models.{}.visual_as_collision: missing", name_))));
}

bool BulletDistance::LooksAt(const LinkCollider& link, const Neighbour& own) const {
  const int number = own.collider.number;
  return !model_->adjacent(link.number, number) &&
         !model_->collision_disabled(link.number, number) && !Ignored(link.link, own.name);
}

bool BulletDistance::LooksAtLinks() const {
  const int lowest = model_->bodies().front();
  return std::any_of(movable_.begin(), movable_.end(), [&](const LinkCollider& link) {
    const bool at_own = std::any_of(own_.begin(), own_.end(),
                                    [&](const Neighbour& own) { return LooksAt(link, own); });
    if (at_own || !link_forces_) return at_own;
    return std::any_of(others_.begin(), others_.end(), [&](const Other& other) {
      return std::any_of(other.links.begin(), other.links.end(), [&](const Neighbour& neighbour) {
        const bool left_out = neighbour.lowest && model_->body(link.number) == lowest;
        return !left_out && !Ignored(link.link, neighbour.name);
      });
    });
  });
}

bool BulletDistance::Compares(const LinkPoses& poses, const ObstacleSet& set) const {
  return std::any_of(movable_.begin(), movable_.end(), [&](const LinkCollider& link) {
    if (poses.Find(link.link, link.number) < 0) return false;
    return at_links_ ||
           std::any_of(set.obstacles.begin(), set.obstacles.end(), [&](const Obstacle& obstacle) {
             return !Ignored(link.link, obstacle.body->id);
           });
  });
}

void BulletDistance::CheckNames(const LinkPoses& poses) const {
  const auto& own = model_->links();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i < own.size() && own[i].name == poses.links[i]) continue;
    const bool known = std::any_of(own.begin(), own.end(), [&](const robot::Link& link) {
      return link.name == poses.links[i];
    });
    if (known) continue;
    throw ConfigError(fmt::format("links: got '{}'; expected a link of model '{}'",
                                  poses.links[i].text(), name_));
  }
}

// Who takes a moving arm for one at rest learns too late that it comes nearer.
void BulletDistance::CheckVelocities(const Other& other, const LinkPoses& poses) const {
  if (poses.velocities.size() == poses.size()) return;
  throw ConfigError(fmt::format(
      "{}: got poses without velocities; expected both: connect the input `velocity` of the "
      "RobotKinematics of '{}'",
      LinksInput(other.local_name), other.name));
}

}  // namespace oca::systems
