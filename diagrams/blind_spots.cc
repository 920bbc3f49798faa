// SPDX-License-Identifier: BSD-3-Clause
#include "diagrams/blind_spots.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "framework/dynamic_port.h"
#include "models/robot/robot_model.h"
#include "models/robot/unseen_links.h"
#include "systems/bullet_distance.h"

namespace oca::diagrams {
namespace {

using Block = LoadedDiagram::Block;

/// The block that drives an input of a system of that name; null if nothing does.
const Block* DriverOf(const LoadedDiagram& loaded, const std::string& name, const char* port) {
  const auto driver = loaded.diagram->DriverOf(loaded.diagram->FindInput(name + "." + port));
  return driver ? &loaded.BlockOf(*driver->system) : nullptr;
}

bool HasSolids(const models::RobotModel& model) {
  const auto& links = model.links();
  return std::any_of(links.begin(), links.end(),
                     [](const models::Link& link) { return !link.collisions.empty(); });
}

/// Whether two links of the robot could be asked for their distance.
bool HasOwnPairs(const models::RobotModel& model) {
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
  Spots(const LoadedDiagram& loaded, const Block& block)
      : loaded_(loaded),
        block_(block),
        params_(ReadParams<systems::BulletDistance::Params>(block.params)) {}

  std::vector<std::string> Find() {
    const auto model = loaded_.models.Get(params_.model);
    const bool only = params_.model.empty() || loaded_.models.all().size() == 1;
    const std::string of = only ? "" : fmt::format(" of '{}'", params_.model);
    AddUnseen(*model, of);
    AddUnmovable(*model, of);
    if (!params_.self_collision && HasOwnPairs(*model)) {
      found_.push_back(fmt::format("own links{} (self_collision is off)", of));
    }
    AddModels(model);
    std::vector<std::string> pairs;
    for (const auto& pair : params_.ignore) {
      if (LooksAt(pair[1], model)) pairs.push_back(fmt::format("{} to {}", pair[0], pair[1]));
    }
    if (!pairs.empty()) found_.push_back(fmt::format("{} (ignore)", fmt::join(pairs, ", ")));
    const Block* const source = DriverOf(loaded_, block_.name, "obstacles");
    if (source != nullptr && source->type == "ObstacleSensor") {
      found_.push_back(fmt::format("obstacles but as '{}' reports them", source->name));
    }
    return std::move(found_);
  }

 private:
  /// Whether the second of an ignored pair is not of a model that is left out as a whole.
  bool LooksAt(const std::string& name,
               const std::shared_ptr<const models::RobotModel>& own) const {
    const std::size_t slash = name.find('/');
    if (slash == std::string::npos) return true;
    const std::string model = name.substr(0, slash);
    return loaded_.models.Get(model) == own ? params_.self_collision : LooksAt(model);
  }

  bool LooksAt(const std::string& other) const {
    const auto& others = params_.others;
    return params_.calculate_link_forces &&
           std::find(others.begin(), others.end(), other) != others.end();
  }

  void AddUnseen(const models::RobotModel& model, const std::string& of) {
    std::vector<std::string> names;
    for (const int link : models::DrawnOnly(model)) {
      names.push_back(model.links()[link].name.text());
    }
    if (names.empty()) return;
    found_.push_back(
        fmt::format("links{} without a collision shape: {}", of, fmt::join(names, ", ")));
  }

  /// Nothing that these come near to could be evaded, so distances leave them out.
  void AddUnmovable(const models::RobotModel& model, const std::string& of) {
    std::vector<std::string> names;
    for (int i = 0; i < model.num_links(); ++i) {
      const models::Link& link = model.links()[i];
      if (model.body(i) < 0 && !link.collisions.empty()) names.push_back(link.name.text());
    }
    if (names.empty()) return;
    found_.push_back(
        fmt::format("obstacles at links{} that cannot move: {}", of, fmt::join(names, ", ")));
  }

  void AddModels(const std::shared_ptr<const models::RobotModel>& own) {
    for (const auto& [name, model] : loaded_.models.all()) {
      if (model == own) continue;
      if (LooksAt(name)) {
        AddUnseen(*model, fmt::format(" of '{}'", name));
      } else if (HasSolids(*model) || !models::DrawnOnly(*model).empty()) {
        found_.push_back(fmt::format("model '{}' ({})", name,
                                     params_.calculate_link_forces
                                         ? "not among others of " + block_.name
                                         : "calculate_link_forces is off"));
      }
    }
  }

  const LoadedDiagram& loaded_;
  const Block& block_;
  const systems::BulletDistance::Params params_;
  std::vector<std::string> found_;
};

}  // namespace

bool JudgesDistances(const LoadedDiagram& loaded) {
  return std::any_of(loaded.metrics.begin(), loaded.metrics.end(), [&](const auto& metrics) {
    return DriverOf(loaded, metrics.first, "proximities") != nullptr;
  });
}

std::vector<std::string> BlindSpots(const LoadedDiagram& loaded) {
  std::vector<std::string> spots;
  for (const auto& metrics : loaded.metrics) {
    const Block* const distance = DriverOf(loaded, metrics.first, "proximities");
    if (distance == nullptr || distance->type != "BulletDistance") continue;
    for (std::string& spot : Spots(loaded, *distance).Find()) {
      if (std::find(spots.begin(), spots.end(), spot) == spots.end()) {
        spots.push_back(std::move(spot));
      }
    }
  }
  return spots;
}

}  // namespace oca::diagrams
