// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/model_section.h"

#include <fmt/format.h>

#include <memory>
#include <utility>
#include <vector>

#include "oca/diagrams/files/diagram_file.h"
#include "oca/diagrams/files/package_paths.h"
#include "oca/diagrams/files/section.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"
#include "oca/models/robot/attach_objects.h"
#include "oca/models/robot/unseen_links.h"
#include "oca/models/robot/urdf.h"

namespace oca::files {
namespace {

namespace fs = std::filesystem;

fs::path FolderOf(const Location& location) {
  return location.file && location.line > 0 ? fs::path(*location.file).parent_path() : fs::path();
}

Location LocationOf(const Value& map, const char* key) {
  const Value* const value = map.Find(key);
  return value == nullptr ? map.location() : value->location();
}

std::vector<robot::AttachedObject> MakeAttached(const std::vector<AttachedParams>& params,
                                                const std::string& where,
                                                std::vector<std::string>* warnings) {
  std::vector<robot::AttachedObject> objects;
  for (std::size_t i = 0; i < params.size(); ++i) {
    const AttachedParams& from = params[i];
    const std::string at = fmt::format("{}.attached[{}]", where, i);
    if (from.shape.type == systems::ShapeType::kHalfSpace) {
      throw ConfigError(at + ".shape.type: got a half_space; expected a body that ends");
    }
    const auto body = systems::MakeObstacleBody(from.id, from.shape, at + ".shape", warnings);
    objects.push_back({from.id, from.link,
                       from.pose.value_or(systems::PoseParams{}).Pose(at + ".pose"),
                       body->collider->shape(), from.touches});
  }
  return objects;
}

}  // namespace

ModelSection::ModelSection(const Value& root, Problems& problems) : problems_(problems) {
  ReadPackages(root);
  for (const Value::Entry& entry : SectionOf(root, "models", problems_)) ReadModel(entry);
}

void ModelSection::ReadPackages(const Value& root) {
  for (const Value::Entry& entry : SectionOf(root, "packages", problems_)) {
    if (entry.value.string() == nullptr) {
      problems_.Add(entry.value.location(), fmt::format("packages.{}: got {}; expected a folder",
                                                        entry.key, entry.value.Show()));
      continue;
    }
    const fs::path folder = *entry.value.string();
    packages_[entry.key] =
        folder.is_absolute() ? folder : FolderOf(entry.value.location()) / folder;
  }
}

fs::path ModelSection::Resolve(const std::string& name, const Location& location) const {
  return name.empty() ? fs::path() : ResolvePath(name, FolderOf(location), packages_);
}

void ModelSection::ReadModel(const Value::Entry& entry) {
  const std::string where = "models." + entry.key;
  ModelParams params;
  Problems own;
  ReadFields(ResolveFiles(entry.value), FieldsOf<ModelParams>(), where, &params, own);
  if (!own.empty()) {
    problems_.Add(own);
    failed_ = true;
    return;
  }
  std::vector<std::string> warnings;
  try {
    robot::LoadOptions options;
    options.warn = [&](const std::string& line) {
      warnings.push_back(fmt::format("{}: {}", where, line));
    };
    options.hull_advice = "; collision: decomposition splits it";
    options.X_WB = params.base_pose.Pose(where + ".base_pose");
    options.decompose_meshes = params.collision == systems::CollisionMeshes::kDecomposition;
    options.visual_as_collision = params.visual_as_collision;
    options.srdf = Resolve(params.srdf, LocationOf(entry.value, "srdf"));
    if (params.acceleration_limits) {
      options.acceleration_limits = params.acceleration_limits->values();
    }
    if (params.jerk_limits) options.jerk_limits = params.jerk_limits->values();
    options.find_package = [this](const std::string& package) -> fs::path {
      const auto found = packages_.find(package);
      return found == packages_.end() ? fs::path() : found->second;
    };
    options.package_directories = PackageFolders();
    const robot::RobotModel robot =
        robot::LoadUrdf(Resolve(params.urdf, LocationOf(entry.value, "urdf")), options);
    const auto model = std::make_shared<const robot::RobotModel>(
        robot::AttachObjects(robot, MakeAttached(params.attached, where, &warnings)));
    const std::string unseen = robot::DescribeUnseen(*model, "visual_as_collision: missing");
    if (!unseen.empty()) warnings.push_back(fmt::format("{}: {}", where, unseen));
    models_.Add(entry.key, model);
  } catch (const std::runtime_error& error) {
    failed_ = true;
    problems_.Add(entry.location, fmt::format("{}: {}", where, error.what()));
  }
  for (const std::string& line : warnings) {
    warnings_.push_back(fmt::format("{}: warning: {}", entry.location.ToString(), line));
  }
}

Value ModelSection::ResolveFiles(const Value& value) {
  if (value.list() != nullptr) {
    Value::List list;
    for (const Value& item : *value.list()) list.push_back(ResolveFiles(item));
    return Value(std::move(list), value.location());
  }
  if (value.map() == nullptr) return value;
  Value::Map map;
  for (const Value::Entry& entry : *value.map()) {
    Value inner = ResolveFiles(entry.value);
    if (entry.key == "file" && inner.string() != nullptr) {
      try {
        inner = Value(Resolve(*inner.string(), inner.location()).string(), inner.location());
      } catch (const ConfigError& error) {
        problems_.Add(inner.location(), error.what());
      }
    }
    map.push_back({entry.key, entry.location, std::move(inner)});
  }
  return Value(std::move(map), value.location());
}

}  // namespace oca::files
