// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/scenes/planning_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "oca/models/error.h"
#include "oca/models/scenes/foreign_tree.h"
#include "oca/models/scenes/scene_bodies.h"
#include "oca/models/scenes/scene_text.h"
#include "oca/models/table_text.h"

namespace oca::scenes {
namespace {

using internal::Foreign;

/// One file in YAML.
class SceneReader {
 public:
  explicit SceneReader(const Foreign& tree) : tree_(tree) {}

  PlanningScene Read() {
    if (!tree_.is_map()) tree_.Refuse("a map with `world`");
    const auto world = tree_.Find("world");
    const auto state = tree_.Find("robot_state");
    if (!world && !state) tree_.Refuse("a map without `world`", "a planning scene");
    internal::NoteUnknown(tree_,
                          {"name", "robot_state", "robot_model_name", "fixed_frame_transforms",
                           "allowed_collision_matrix", "link_padding", "link_scale",
                           "object_colors", "world", "is_diff"},
                          scene_.notes);
    scene_.name = tree_.Text("name");
    scene_.robot = tree_.Text("robot_model_name");
    if (world) ReadWorld(*world);
    if (state) ReadState(*state);
    errors_.Try([&] { ReadFrames(); });
    if (const auto matrix = tree_.Find("allowed_collision_matrix")) {
      errors_.Try([&] { ReadMatrix(*matrix); });
    }
    NoteNumbers("link_padding", "padding", 0.0);
    NoteNumbers("link_scale", "scale", 1.0);
    errors_.Throw();
    return std::move(scene_);
  }

 private:
  void ReadWorld(const Foreign& world) {
    internal::NoteUnknown(world, {"collision_objects", "octomap"}, scene_.notes);
    for (const Foreign& object : world.Items("collision_objects")) {
      errors_.Try([&] {
        scene_.objects.push_back(internal::ObjectOf(object, scene_.notes));
        Claim(scene_.objects.back().id, object);
      });
    }
    const auto octomap = world.Find("octomap");
    if (!octomap || !octomap->is_map()) return;
    const auto inner = octomap->Find("octomap");
    const auto data = (inner && inner->is_map() ? *inner : *octomap).Find("data");
    if (!data || (data->is_list() && data->size() == 0)) return;
    scene_.notes.push_back(fmt::format(
        "{}: world.octomap: not taken over; its binary tree can be an obstacle of shape octree",
        octomap->where()));
  }

  void ReadState(const Foreign& state) {
    errors_.Try([&] { scene_.joints = internal::JointsOf(state, scene_.notes); });
    for (const Foreign& item : state.Items("attached_collision_objects")) {
      errors_.Try([&] { ReadHeld(item); });
    }
  }

  void ReadHeld(const Foreign& item) {
    internal::NoteUnknown(item, {"link_name", "object", "touch_links", "detach_posture", "weight"},
                          scene_.notes);
    HeldSceneObject held;
    held.link = internal::NameOf(item.Get("link_name"));
    held.object = internal::ObjectOf(item.Get("object"), scene_.notes);
    for (const Foreign& link : item.Items("touch_links")) {
      held.touch_links.push_back(internal::NameOf(link));
    }
    Claim(held.object.id, item);
    scene_.held.push_back(std::move(held));
  }

  void Claim(const std::string& id, const Foreign& object) {
    if (ids_.insert(id).second) return;
    object.Refuse(fmt::format("the id '{}' a second time", models::internal::Shown(id)),
                  "ids that differ");
  }

  void ReadFrames() {
    for (const Foreign& item : tree_.Items("fixed_frame_transforms")) {
      const std::string child = item.Get("child_frame_id").Text();
      const auto transform = item.Find("transform");
      SceneFrame frame{child.starts_with('/') ? child.substr(1) : child,
                       internal::FrameOf(item).text,
                       transform ? transform->Pose() : Eigen::Isometry3d::Identity(), item.where()};
      for (const SceneFrame& other : scene_.frames) {
        if (other.name == frame.name) item.Refuse("frame '" + child + "' twice", "it once");
      }
      scene_.frames.push_back(std::move(frame));
    }
  }

  /// A row of the matrix: a list of truths, or, in messages, a map with `enabled`.
  void ReadMatrix(const Foreign& matrix) {
    const auto names = matrix.Texts("entry_names");
    const auto rows = matrix.Items("entry_values");
    scene_.allowed.where = matrix.where();
    const auto check = [&](const Foreign& at, std::size_t got, const char* what) {
      if (got == names.size()) return;
      at.Refuse(fmt::format("{} {} for {} names", got, what, names.size()), "one of each name");
    };
    check(matrix, rows.size(), "rows");
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto row = rows[i].is_map() ? rows[i].Items("enabled") : rows[i].Items();
      check(rows[i], row.size(), "values");
      for (std::size_t j = 0; j < row.size(); ++j) {
        const bool allowed = row[j].Bool();
        if (allowed && j > i) scene_.allowed.pairs.emplace_back(names[i], names[j]);
      }
    }
    const auto defaults = matrix.Texts("default_entry_names");
    const auto values = matrix.Items("default_entry_values");
    if (defaults.size() != values.size()) {
      matrix.Refuse(fmt::format("{} default_entry_names and {} default_entry_values",
                                defaults.size(), values.size()),
                    "as many of each");
    }
    for (std::size_t i = 0; i < defaults.size(); ++i) {
      if (values[i].Bool()) scene_.allowed.defaults.push_back(defaults[i]);
    }
  }

  /// What MoveIt adds to links, which no model here has.
  void NoteNumbers(const char* key, const char* number, double neutral) {
    errors_.Try([&] {
      for (const Foreign& item : tree_.Items(key)) {
        const double value = item.Get(number).Number();
        if (value == neutral) continue;
        scene_.notes.push_back(
            fmt::format("{}: {} of '{}': {} not taken over; links are as the model has them",
                        item.where(), key, item.Get("link_name").Text(), value));
      }
    });
  }

  const Foreign& tree_;
  models::ModelErrors errors_;
  std::set<std::string> ids_;
  PlanningScene scene_;
};

}  // namespace

const double* JointPositions::Find(const std::string& joint) const {
  const auto found = std::find_if(positions.begin(), positions.end(),
                                  [&](const auto& one) { return one.first == joint; });
  return found == positions.end() ? nullptr : &found->second;
}

PlanningScene ReadPlanningScene(const std::filesystem::path& file) {
  PlanningScene scene;
  if (file.extension() == ".scene") {
    scene = internal::ReadSceneText(file);
  } else {
    const internal::ForeignValue tree = internal::ReadForeignYaml(file);
    const Foreign root(std::make_shared<const std::string>(file.string()), tree, "");
    scene = SceneReader(root).Read();
  }
  scene.file = file.string();
  return scene;
}

}  // namespace oca::scenes
