// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/urdf.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml.h>

#include "oca/models/error.h"
#include "oca/models/geometry/collider.h"
#include "oca/models/geometry/decomposition.h"
#include "oca/models/geometry/mesh_surface.h"
#include "oca/models/robot/fuse_capsules.h"
#include "oca/models/robot/inertia.h"
#include "oca/models/robot/joint_limits.h"
#include "oca/models/robot/joint_limits_file.h"
#include "oca/models/robot/mesh_path.h"
#include "oca/models/robot/scale_warnings.h"
#include "oca/models/robot/srdf.h"
#include "oca/models/robot/urdf_newer.h"
#include "oca/models/robot/urdf_outline.h"
#include "oca/models/robot/urdf_repair.h"
#include "oca/models/robot/urdfdom.h"
#include "oca/models/robot/xml_file.h"

namespace oca::robot {
namespace {

// One load: what the conversions share.
class UrdfReader {
 public:
  /// `expanded` is the xacro that the text comes from; nullptr: none.
  UrdfReader(const std::string& where, const LoadOptions& options,
             const std::filesystem::path& directory, const ExpandedXacro* expanded = nullptr)
      : where_(where), options_(options), directory_(directory), expanded_(expanded) {}

  RobotModel Read(const std::string& text) {
    const XmlDocument document = ParseXml(text, where_);
    root_ = document->RootElement();
    newer_ = RewriteNewerUrdf(*document->RootElement(), where_, errors_);
    Tell(RepairUrdf(*document->RootElement()));
    outline_ = ReadUrdfOutline(*document->RootElement(), where_, errors_);
    if (errors_.empty()) CheckUrdfTree(outline_, where_, errors_);
    CheckMeshes(NeededMeshes(), directory_, options_, errors_);
    errors_.Throw();
    parsed_ = ParseWithUrdfdom(TextOf(*document), where_);
    order_ = OrderUrdf(outline_);
    for (const std::size_t joint : order_.joints) joints_.push_back(ReadJoint(joint));
    for (const std::size_t link : order_.links) links_.push_back(ReadLink(outline_.links[link]));
    errors_.Throw();
    Srdf srdf;
    JointLimitsFile limits;
    errors_.Try([&] { srdf = ReadSrdf(); });
    errors_.Try([&] {
      limits = ReadLimitsFile();
      limits.TightenRanges(joints_);
    });
    errors_.Throw();
    if (!options_.held.empty()) {
      joints_ = HoldJoints(MakeModel(links_, joints_, {}), srdf, options_.held);
    }
    GiveLimits(joints_, options_.acceleration_limits, where_ + ": acceleration_limits",
               kLeastAcceleration, &Joint::acceleration_limit);
    GiveLimits(joints_, options_.jerk_limits, where_ + ": jerk_limits", kLeastJerk,
               &Joint::jerk_limit);
    limits.TightenRates(joints_);
    RobotModel model = MakeModel(std::move(links_), std::move(joints_), srdf);
    Warn(model);
    for (const std::string& line : srdf.warnings) Tell(line);
    return model;
  }

 private:
  Srdf ReadSrdf() const {
    if (options_.srdf.empty()) return {};
    return LoadSrdf(options_.srdf, DescribeForSrdf(outline_.robot_name, links_, joints_));
  }

  JointLimitsFile ReadLimitsFile() const {
    return options_.joint_limits.empty() ? JointLimitsFile()
                                         : JointLimitsFile(options_.joint_limits);
  }

  RobotModel MakeModel(std::vector<Link> links, std::vector<Joint> joints, const Srdf& srdf) const {
    try {
      return RobotModel(models::Name(outline_.robot_name), std::move(links), std::move(joints),
                        options_.X_WB, srdf.disabled_pairs, srdf.states);
    } catch (const models::ModelError& error) {
      throw models::ModelError(fmt::format("{}: {}", where_, error.what()));
    }
  }

  void Tell(const WarningLines& lines) const {
    for (const std::string& line : lines.sums) {
      if (options_.warn) options_.warn(line);
    }
    for (const std::string& line : lines.each) {
      if (options_.warn_each) options_.warn_each(line);
    }
  }
  void Tell(const std::string& line) const { Tell(WarningLines{{line}, {line}}); }

  void Warn(const RobotModel& model) const {
    Tell(SummedUpByLink(hulls_));
    Tell(SummedUpByLink(flat_));
    Tell(SummedUp(missing_visuals_, "visual"));
    Tell(InertiaWarnings(model));
    for (const UrdfOutline::Joint& joint : outline_.joints) {
      if (!joint.fixed || joint.mimic.empty()) continue;
      Tell(fmt::format("joint '{}': fixed, so its <mimic> of '{}' does nothing", joint.name,
                       joint.mimic));
    }
    if (!softened_.empty()) {
      Tell(fmt::format(
          "joint{} '{}': soft limits of a safety_controller, narrower than <limit>, are "
          "not looked at; joint_limits can narrow the range",
          softened_.size() > 1 ? "s" : "", fmt::join(softened_, "', '")));
    }
    for (const std::string& line : LimitWarnings(model)) Tell(line);
    for (const std::string& line : ScaleWarnings(model)) Tell(line);
  }

  /// Two soft limits that are equal are none, as they are 0 where they are left out.
  static bool SlowsDownWithin(const urdf::JointSafety& soft, const Joint& joint) {
    return joint.type != JointType::kContinuous && soft.soft_lower_limit < soft.soft_upper_limit &&
           (soft.soft_lower_limit > joint.lower_limit || soft.soft_upper_limit < joint.upper_limit);
  }

  Joint ReadJoint(std::size_t index) {
    const UrdfOutline::Joint& entry = outline_.joints[index];
    const urdf::Joint& from = *parsed_->getJoint(entry.name);
    Joint joint;
    joint.name = models::Name(entry.name);
    joint.parent_link = order_.number_of_link.at(entry.parent);
    joint.child_link = order_.number_of_link.at(entry.child);
    joint.X_PJ = ToPose(from.parent_to_joint_origin_transform);
    joint.type = from.type == urdf::Joint::REVOLUTE     ? JointType::kRevolute
                 : from.type == urdf::Joint::CONTINUOUS ? JointType::kContinuous
                 : from.type == urdf::Joint::PRISMATIC  ? JointType::kPrismatic
                                                        : JointType::kFixed;
    if (!joint.movable()) return joint;
    joint.axis = ToVector(from.axis).normalized();
    if (from.limits != nullptr) {
      joint.velocity_limit = from.limits->velocity;
      joint.effort_limit = from.limits->effort;
      if (joint.type != JointType::kContinuous) {
        joint.lower_limit = from.limits->lower;
        joint.upper_limit = from.limits->upper;
      }
    }
    if (from.safety != nullptr && SlowsDownWithin(*from.safety, joint)) {
      softened_.push_back(joint.name.text());
    }
    joint.acceleration_limit = entry.acceleration.value_or(kUnlimited);
    joint.jerk_limit = entry.jerk.value_or(kUnlimited);
    if (!entry.mimic.empty()) {
      joint.mimic =
          Mimic{order_.number_of_joint.at(entry.mimic), from.mimic->multiplier, from.mimic->offset};
    }
    return joint;
  }

  Link ReadLink(const UrdfOutline::Link& entry) {
    const urdf::Link& from = *parsed_->getLink(entry.name);
    if (from.collision_array.size() != entry.collisions.size() ||
        from.visual_array.size() != entry.visuals.size()) {
      throw models::ModelError(fmt::format(
          "{}:{}: link '{}': urdfdom; got {} collision and {} visual elements; expected {} and {}",
          where_, entry.line, entry.name, from.collision_array.size(), from.visual_array.size(),
          entry.collisions.size(), entry.visuals.size()));
    }
    Link link;
    link.name = models::Name(entry.name);
    link.collisions = FuseCapsules(ReadCollisions(entry, from));
    for (std::size_t i = 0; i < from.visual_array.size(); ++i) {
      auto visual = ReadVisual(
          *from.visual_array[i],
          fmt::format("{}:{}: link '{}' visual", where_, entry.visuals[i].line, entry.name));
      if (!visual) continue;
      if (newer_.IsCapsule(*root_, "visual", entry.name, i)) {
        visual->shape = CapsuleOf(*visual->shape);
      }
      link.visuals.push_back(*visual);
    }
    if (from.inertial != nullptr) link.inertia = ToInertia(*from.inertial);
    return link;
  }

  /// Whether what is drawn of the link stands for its collision shapes.
  bool Drawn(const UrdfOutline::Link& link) const {
    if (options_.visual_as_collision == VisualAsCollision::kAll) return !link.visuals.empty();
    return options_.visual_as_collision == VisualAsCollision::kMissing && link.collisions.empty();
  }

  std::string WhereIs(const UrdfOutline::Link& link, const UrdfOutline::Element& element,
                      const char* kind) const {
    const std::string line = fmt::format("{}:{}", where_, element.line);
    return fmt::format("{}: link '{}' {}",
                       expanded_ == nullptr ? line : expanded_->WithPlaces(line, where_), link.name,
                       kind);
  }

  std::vector<NeededMesh> NeededMeshes() const {
    std::vector<NeededMesh> meshes;
    for (const UrdfOutline::Link& link : outline_.links) {
      const bool drawn = Drawn(link);
      for (const UrdfOutline::Element& element : drawn ? link.visuals : link.collisions) {
        if (element.mesh.empty()) continue;
        meshes.push_back({element.mesh, WhereIs(link, element, drawn ? "visual" : "collision")});
      }
    }
    return meshes;
  }

  std::vector<CollisionElement> ReadCollisions(const UrdfOutline::Link& entry,
                                               const urdf::Link& from) {
    return Drawn(entry) ? ReadSolids(entry, entry.visuals, from.visual_array, "visual")
                        : ReadSolids(entry, entry.collisions, from.collision_array, "collision");
  }

  template <class Element>
  std::vector<CollisionElement> ReadSolids(const UrdfOutline::Link& link,
                                           const std::vector<UrdfOutline::Element>& outlines,
                                           const std::vector<Element>& elements, const char* kind) {
    std::vector<CollisionElement> solids;
    for (std::size_t i = 0; i < elements.size(); ++i) {
      errors_.Try([&] {
        const std::string where = WhereIs(link, outlines[i], kind);
        geometry::Shape shape = ReadShape(*elements[i]->geometry, link.name, kind, where);
        if (newer_.IsCapsule(*root_, kind, link.name, i)) shape = CapsuleOf(shape);
        if (outlines[i].mesh.empty()) geometry::Collider(shape, where);  // refuses what is too flat
        solids.push_back({ToPose(elements[i]->origin), std::move(shape), where});
      });
    }
    return solids;
  }

  geometry::Shape ReadShape(const urdf::Geometry& geometry, const std::string& link,
                            const char* kind, const std::string& where) {
    if (geometry.type == urdf::Geometry::MESH) {
      const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
      const std::filesystem::path file = FindMesh(mesh.filename, directory_, options_, where);
      try {
        const Eigen::Vector3d scale = ToVector(mesh.scale);
        if (options_.decompose_meshes) return geometry::LoadDecomposition(file, scale);
        const auto [hull, excess, flatness] = geometry::LoadMeshHull(file, scale);
        const auto remark = [&](const std::string& what) {
          return LinkWarning{
              link, fmt::format("link '{}': {} mesh '{}' {}", link, kind, mesh.filename, what)};
        };
        if (!excess.empty()) hulls_.push_back(remark(excess + options_.hull_advice));
        if (!flatness.empty()) flat_.push_back(remark(flatness));
        return geometry::ConvexMesh{hull};
      } catch (const models::ModelError& error) {
        throw models::ModelError(where + ": " + error.what());
      }
    }
    return ToPrimitive(geometry);
  }

  /// Nothing if its mesh is missing: a picture may lack a part.
  std::optional<VisualElement> ReadVisual(const urdf::Visual& from, const std::string& where) {
    VisualElement visual;
    visual.X_LV = ToPose(from.origin);
    if (from.geometry->type == urdf::Geometry::MESH) {
      const auto& mesh = static_cast<const urdf::Mesh&>(*from.geometry);
      if (options_.load_visuals) {
        try {
          visual.mesh_file = FindMesh(mesh.filename, directory_, options_, where).string();
        } catch (const models::ModelError& error) {
          missing_visuals_.push_back(std::string("not drawn: ") + error.what());
          return std::nullopt;
        }
      }
      visual.mesh_scale = ToVector(mesh.scale);
    } else {
      visual.shape = ToPrimitive(*from.geometry);
    }
    if (from.material != nullptr) {
      const urdf::Color& colour = from.material->color;
      visual.colour = Eigen::Vector4d(colour.r, colour.g, colour.b, colour.a);
    }
    return visual;
  }

  static std::string TextOf(const TiXmlDocument& document) {
    TiXmlPrinter printer;
    document.Accept(&printer);
    return printer.Str();
  }

  const std::string& where_;
  const LoadOptions& options_;
  const std::filesystem::path& directory_;
  const ExpandedXacro* const expanded_;
  models::ModelErrors errors_;
  const TiXmlElement* root_{nullptr};  // of the document that is read
  NewerUrdf newer_;
  UrdfOutline outline_;
  std::shared_ptr<urdf::ModelInterface> parsed_;
  UrdfOrder order_;
  std::vector<Link> links_;
  std::vector<Joint> joints_;
  std::vector<std::string> softened_;         // joints
  std::vector<std::string> missing_visuals_;  // why each one is not drawn
  std::vector<LinkWarning> hulls_, flat_;     // meshes
};

}  // namespace

RobotModel LoadUrdf(const std::filesystem::path& file, const LoadOptions& options) {
  const std::string where = file.string();
  if (!IsXacro(file)) {
    if (!options.xacro_arguments.empty()) {
      throw models::ModelError(
          fmt::format("{}: arguments; got '{}'; expected none: it is no .xacro", where,
                      options.xacro_arguments.begin()->first));
    }
    return ParseUrdf(ReadXmlFile(file), where, options, file.parent_path());
  }
  const ExpandedXacro expanded = ExpandXacro(file, ForXacro(options));
  LoadOptions placed = options;
  for (const auto kind : {&LoadOptions::warn, &LoadOptions::warn_each}) {
    if (!(options.*kind)) continue;
    placed.*kind = [&, kind](const std::string& line) {
      (options.*kind)(expanded.WithPlaces(line, where));
    };
  }
  try {
    return UrdfReader(where, placed, file.parent_path(), &expanded).Read(expanded.urdf);
  } catch (const models::ModelError& error) {
    throw models::ModelError(expanded.WithPlaces(error.what(), where));
  }
}

XacroOptions ForXacro(const LoadOptions& options) {
  const auto warn = options.warn, each = options.warn_each;
  return {options.xacro_arguments, options.find_package, options.package_directories,
          options.package_advice, [=](const std::string& line) {
            if (warn) warn(line);
            if (each) each(line);
          }};
}

RobotModel ParseUrdf(const std::string& text, const std::string& name, const LoadOptions& options,
                     const std::filesystem::path& directory) {
  return UrdfReader(name, options, directory).Read(text);
}

}  // namespace oca::robot
