// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/load_models.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/json_text.h"
#include "oca/models/file_cache.h"
#include "oca/models/robot/attach_objects.h"
#include "oca/models/robot/unseen_links.h"
#include "oca/models/robot/urdf.h"

namespace oca::files {
namespace {

std::vector<robot::AttachedObject> MakeAttached(const std::vector<AttachedParams>& params,
                                                const std::string& where, const Warn& warn) {
  std::vector<robot::AttachedObject> objects;
  for (std::size_t i = 0; i < params.size(); ++i) {
    const AttachedParams& from = params[i];
    const std::string at = fmt::format("{}.attached[{}]", where, i);
    if (from.shape.type == systems::ShapeType::kHalfSpace) {
      throw ConfigError(at + ".shape.type: got a half_space; expected a body that ends");
    }
    std::vector<std::string> warnings;
    const auto body = systems::MakeObstacleBody(from.id, from.shape, at + ".shape", &warnings);
    for (const std::string& line : warnings) warn(line);
    objects.push_back({from.id, from.link,
                       from.pose.value_or(systems::PoseParams{}).Pose(at + ".pose"),
                       body->collider->shape(), from.touches});
  }
  return objects;
}

std::string FromHere(const std::string& name) {
  return name.empty() ? name : ResolvePath(name, {}, {}).string();
}

/// A robot with what there is to know of it.
struct Read {
  std::shared_ptr<const robot::RobotModel> model;
  std::vector<std::string> lines;
};

/// All of `params` but the pose of its base, which is the world's frame. Fills the lines also if it
/// throws.
void ReadModel(const std::string& where, const ModelParams& params, const PackageMap& packages,
               bool near_robot, Read& read) {
  const Warn tell = [&read](const std::string& line) { read.lines.push_back(line); };
  robot::LoadOptions options;
  options.warn = [&](const std::string& line) { tell(fmt::format("{}: {}", where, line)); };
  options.hull_advice = "; collision: decomposition splits it";
  options.decompose_meshes = params.collision == systems::CollisionMeshes::kDecomposition;
  options.visual_as_collision = params.visual_as_collision;
  options.srdf = params.srdf;
  options.joint_limits = params.joint_limits;
  options.held = {params.group, params.held.positions, params.held.states};
  if (params.acceleration_limits) {
    options.acceleration_limits = params.acceleration_limits->values();
  }
  if (params.jerk_limits) options.jerk_limits = params.jerk_limits->values();
  options.find_package = [&](const std::string& package) -> std::filesystem::path {
    if (const auto found = packages.find(package); found != packages.end()) return found->second;
    return near_robot ? PackageFor(DescriptionOf(params), package) : std::filesystem::path();
  };
  options.package_directories = PackageFolders();
  options.package_advice = kPackageAdvice;
  options.xacro_arguments = params.arguments.texts;
  const robot::RobotModel robot = robot::LoadUrdf(DescriptionOf(params), options);
  read.model = std::make_shared<const robot::RobotModel>(
      robot::AttachObjects(robot, MakeAttached(params.attached, where, tell)));
  const std::string unseen = robot::DescribeUnseen(*read.model, "visual_as_collision: missing");
  if (!unseen.empty()) tell(fmt::format("{}: {}", where, unseen));
}

template <class Numbers>
std::string BytesOf(const Numbers& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()),
          sizeof(double) * static_cast<std::size_t>(numbers.size())};
}

/// Tells what ReadModel makes from what else it makes of the same URDF or xacro.
std::string FormOf(const std::string& where, const ModelParams& params,
                   const PackageMap& packages) {
  std::string form =
      fmt::format("{}\n{}\n{} {}", where, params.srdf, static_cast<int>(params.collision),
                  static_cast<int>(params.visual_as_collision));
  for (const auto* const limits : {&params.acceleration_limits, &params.jerk_limits}) {
    form += limits->has_value() ? '\n' + BytesOf((*limits)->values()) : "\n";
  }
  form += fmt::format("\n{}\n{}\n{}", params.joint_limits, params.group,
                      ParamTypeOf<HeldParams>().ToJson(&params.held).dump());
  for (const AttachedParams& object : params.attached) {
    form += "\n" + oca::internal::JsonText(JsonOfFields(FieldsOf<AttachedParams>(), &object));
  }
  for (const auto& [name, text] : params.arguments.texts) {
    form += fmt::format("\n{} {}\n{}", name, text.size(), text);
  }
  return form + files::FormOf(packages);
}

}  // namespace

std::shared_ptr<const robot::RobotModel> LoadModel(const std::string& where,
                                                   const ModelParams& params,
                                                   const PackageMap& packages, const Warn& warn,
                                                   bool near_robot) {
  using ModelPtr = std::shared_ptr<const robot::RobotModel>;
  const Eigen::Isometry3d X_WB = params.base_pose.Pose(where + ".base_pose");
  const std::string form = FormOf(where, params, packages) + (near_robot ? "\nnear" : "");
  const std::string& file = DescriptionOf(params);
  const auto tell = [&warn](const Read& read) {
    if (!warn) return;
    for (const std::string& line : read.lines) warn(line);
  };
  const auto read = models::MakeOnce<Read>(file, form, [&] {
    Read fresh;
    try {
      ReadModel(where, params, packages, near_robot, fresh);
    } catch (const std::runtime_error&) {
      tell(fresh);
      throw;
    }
    return fresh;
  });
  tell(*read);
  const std::string pose = "\nbase " + BytesOf(X_WB.matrix());
  return *models::MakeOnce<ModelPtr>(file, form + pose, [&]() -> ModelPtr {
    return std::make_shared<const robot::RobotModel>(read->model->At(X_WB));
  });
}

systems::ModelSet LoadModels(const std::vector<std::pair<std::string, ModelParams>>& models,
                             const Warn& warn) {
  systems::ModelSet loaded;
  for (const auto& [name, params] : models) {
    const std::string where = "models." + name;
    ModelParams placed = Validated(params);
    placed.urdf = FromHere(params.urdf);
    placed.xacro = FromHere(params.xacro);
    placed.srdf = FromHere(params.srdf);
    placed.joint_limits = FromHere(params.joint_limits);
    for (AttachedParams& object : placed.attached) {
      if (object.shape.file) object.shape.file = FromHere(*object.shape.file);
    }
    loaded.Add(name, LoadModel(where, placed, {}, warn, true));
  }
  return loaded;
}

}  // namespace oca::files
