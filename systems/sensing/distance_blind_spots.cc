// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/distance_blind_spots.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "oca/models/robot/robot_model.h"
#include "oca/models/robot/unseen_links.h"

namespace oca::systems {
namespace {

bool HasSolids(const robot::RobotModel& model) {
  const auto& links = model.links();
  return std::any_of(links.begin(), links.end(),
                     [](const robot::Link& link) { return !link.collisions.empty(); });
}

/// Whether two links of the robot could be asked for their distance.
bool HasOwnPairs(const robot::RobotModel& model) {
  for (int a = 0; a < model.num_links(); ++a) {
    for (int b = a + 1; b < model.num_links(); ++b) {
      const bool solid =
          !model.links()[a].collisions.empty() && !model.links()[b].collisions.empty();
      if (solid && !model.adjacent(a, b) && !model.collision_disabled(a, b)) return true;
    }
  }
  return false;
}

/// The blind spots of one distance block.
class Spots {
 public:
  Spots(const BulletDistance::Params& params, const ModelSet& models, const std::string& own_name)
      : params_(params), models_(models), own_name_(own_name) {}

  std::vector<std::string> Find(bool one_robot) {
    const auto model = models_.Get(params_.model);
    own_ = models_.FullName(params_.model);
    const std::string of = one_robot ? "" : fmt::format(" of '{}'", own_);
    AddUnseen(*model, of);
    AddUnmovable(*model, of);
    if (!params_.self_collision && HasOwnPairs(*model)) {
      found_.push_back(fmt::format("own links{} (self_collision is off)", of));
    }
    AddModels();
    std::vector<std::string> pairs;
    for (const auto& pair : params_.ignore) {
      if (LooksAtPair(pair[1])) pairs.push_back(fmt::format("{} to {}", pair[0], pair[1]));
    }
    if (!pairs.empty()) found_.push_back(fmt::format("{} (ignore)", fmt::join(pairs, ", ")));
    return std::move(found_);
  }

 private:
  /// Whether the second of an ignored pair is not of a model that is left out as a whole.
  bool LooksAtPair(const std::string& second) const {
    const std::size_t slash = second.find('/');
    if (slash == std::string::npos) return true;
    const std::string model = models_.FullName(second.substr(0, slash));
    if (!models_.all().contains(model)) return true;  // the id of an obstacle
    return model == own_ ? params_.self_collision : LooksAt(model);
  }

  /// At another model, by its full name.
  bool LooksAt(const std::string& other) const {
    const auto& others = params_.others;
    return params_.calculate_link_forces &&
           std::any_of(others.begin(), others.end(), [&](const std::string& name) {
             return name == "*" ? models_.in_sight().contains(other)
                                : models_.FullName(name) == other;
           });
  }

  void AddUnseen(const robot::RobotModel& model, const std::string& of) {
    std::vector<std::string> names;
    for (const int link : robot::DrawnOnly(model)) {
      names.push_back(model.links()[link].name.text());
    }
    if (names.empty()) return;
    found_.push_back(
        fmt::format("links{} without a collision shape: {}", of, fmt::join(names, ", ")));
  }

  /// Nothing that these come near to could be evaded, so distances leave them out.
  void AddUnmovable(const robot::RobotModel& model, const std::string& of) {
    std::vector<std::string> names;
    for (int i = 0; i < model.num_links(); ++i) {
      const robot::Link& link = model.links()[i];
      if (model.body(i) < 0 && !link.collisions.empty()) names.push_back(link.name.text());
    }
    if (names.empty()) return;
    found_.push_back(
        fmt::format("obstacles at links{} that cannot move: {}", of, fmt::join(names, ", ")));
  }

  void AddModels() {
    for (const auto& [name, model] : models_.all()) {
      if (name == own_) continue;
      if (LooksAt(name)) {
        AddUnseen(*model, fmt::format(" of '{}'", name));
      } else if (HasSolids(*model) || !robot::DrawnOnly(*model).empty()) {
        found_.push_back(fmt::format("model '{}' ({})", name, WhyNot()));
      }
    }
  }

  std::string WhyNot() const {
    if (!params_.calculate_link_forces) return "calculate_link_forces is off";
    const auto& others = params_.others;
    const bool all = others.size() == 1 && others.front() == "*";
    return all ? fmt::format("its links do not come into the file of {}", own_name_)
               : "not among others of " + own_name_;
  }

  const BulletDistance::Params& params_;
  const ModelSet& models_;
  const std::string& own_name_;
  std::string own_;  // the robot's full name
  std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> DistanceBlindSpots(const BulletDistance::Params& params,
                                            const ModelSet& models, const std::string& own_name,
                                            bool one_robot) {
  return Spots(params, models, own_name).Find(one_robot);
}

}  // namespace oca::systems
