// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/drafts/scene_allowed.h"

#include <algorithm>
#include <optional>

namespace oca::drafts::internal {
namespace {

class AllowedPairs {
 public:
  AllowedPairs(const scenes::PlanningScene& scene, const robot::RobotModel& model,
               const BodiesOfObjects& bodies, SceneText& text)
      : scene_(scene), model_(model), bodies_(bodies), text_(text) {}

  void Allow(const std::string& one, const std::string& other) {
    const auto a = FindLink(one), b = FindLink(other);
    if (a && b) {
      const bool looked_at = *a != *b && Solid(*a) && Solid(*b) &&
                             model_.body(*a) != model_.body(*b) && !model_.adjacent(*a, *b) &&
                             !model_.collision_disabled(*a, *b);
      if (looked_at) text_.ignored.emplace_back(one, "arm/" + other);
    } else if (b && IsHeld(one)) {
      Touch(other, BodiesOf(one));
    } else if (a || IsHeld(one)) {
      a&& IsHeld(other) ? Touch(one, BodiesOf(other)) : AllowBody(one, other);
    } else if (b || IsHeld(other)) {
      AllowBody(other, one);
    }
  }

 private:
  std::optional<int> FindLink(const std::string& name) const {
    const auto& links = model_.links();
    const auto found = std::find_if(links.begin(), links.end(), [&](const robot::Link& link) {
      return link.name.text() == name;
    });
    return found == links.end() ? std::nullopt : std::optional<int>(found - links.begin());
  }
  bool Solid(int link) const {
    return !model_.links()[static_cast<std::size_t>(link)].collisions.empty();
  }
  bool IsHeld(const std::string& id) const {
    return std::any_of(scene_.held.begin(), scene_.held.end(),
                       [&](const auto& held) { return held.object.id == id; });
  }
  std::vector<std::string> BodiesOf(const std::string& id) const {
    const auto found = bodies_.find(id);
    return found == bodies_.end() ? std::vector<std::string>() : found->second;
  }

  /// `link` is one, or a held object, which is a link of the diagram's arm.
  void AllowBody(const std::string& link, const std::string& object) {
    const auto number = FindLink(link);
    if (number && (model_.body(*number) < 0 || !Solid(*number))) return;
    for (const std::string& one : number ? std::vector{link} : BodiesOf(link)) {
      for (const std::string& body : BodiesOf(object)) text_.ignored.emplace_back(one, body);
    }
  }

  void Touch(const std::string& link, const std::vector<std::string>& bodies) {
    for (HeldText& held : text_.held) {
      const bool meant = std::find(bodies.begin(), bodies.end(), held.body.id) != bodies.end();
      auto& touches = held.touches;
      const bool known = std::find(touches.begin(), touches.end(), link) != touches.end();
      if (meant && !known && link != held.link) touches.push_back(link);
    }
  }

  const scenes::PlanningScene& scene_;
  const robot::RobotModel& model_;
  const BodiesOfObjects& bodies_;
  SceneText& text_;
};

}  // namespace

void AddAllowed(const scenes::PlanningScene& scene, const robot::RobotModel& model,
                const BodiesOfObjects& bodies, SceneText& text) {
  AllowedPairs pairs(scene, model, bodies, text);
  for (const auto& [one, other] : scene.allowed.pairs) pairs.Allow(one, other);
  for (const std::string& name : scene.allowed.defaults) {
    for (const robot::Link& link : model.links()) pairs.Allow(link.name.text(), name);
    for (const scenes::HeldSceneObject& held : scene.held) pairs.Allow(held.object.id, name);
  }
}

}  // namespace oca::drafts::internal
