// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/robot_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <utility>

#include "oca/diagrams/record/foxglove.h"
#include "oca/diagrams/record/mcap_writer.h"
#include "oca/diagrams/record/robot_drawing.h"
#include "oca/models/geometry/convex_hull.h"
#include "oca/models/robot/clearance.h"
#include "oca/models/robot/joint_limits.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/unseen_links.h"
#include "oca/systems/sensing/geometry_params.h"

namespace oca::record {
namespace {

using nlohmann::ordered_json;
using robot::RobotModel;

constexpr std::size_t kMostOwnPairs = 200'000;  // of some 600 links; the page looks at all at once
const Colour kOverlay(0.94, 0.54, 0.11, 0.38);

struct LinkWarning {
  std::string text;
  std::vector<int> links;
};

/// A name in quotes at a place of a text: the longest of `names` that stands there; -1: none.
int QuotedAt(const std::string& text, std::size_t place, const std::vector<std::string>& names) {
  int found = -1;
  for (int i = 0; i < std::ssize(names); ++i) {
    const std::string quoted = fmt::format("'{}'", names[static_cast<std::size_t>(i)]);
    if (text.compare(place, quoted.size(), quoted) != 0) continue;
    if (found < 0 ||
        names[static_cast<std::size_t>(found)].size() < names[static_cast<std::size_t>(i)].size()) {
      found = i;
    }
  }
  return found;
}

/// Numbers of those of `names` that follow a word: link 'a', joints 'a', 'b'.
std::vector<int> NamedAfter(const std::string& word, const std::string& text,
                            const std::vector<std::string>& names) {
  std::vector<int> found;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    std::size_t place = at + word.size();
    if (place < text.size() && text[place] == 's') ++place;
    std::string_view before = " ";
    while (text.compare(place, before.size(), before) == 0) {
      place += before.size();
      before = ", ";
      const int name = QuotedAt(text, place, names);
      if (name < 0) break;
      found.push_back(name);
      place += names[static_cast<std::size_t>(name)].size() + 2;
    }
  }
  return found;
}

/// The links that a line speaks of, a joint as the link that it leads to; each once, ascending.
std::vector<int> LinksIn(const std::string& line, const RobotModel& model) {
  std::vector<std::string> links, joints;
  for (const auto& link : model.links()) links.push_back(link.name.text());
  for (const auto& joint : model.joints()) joints.push_back(joint.name.text());
  std::vector<int> found = NamedAfter("link", line, links);
  for (const int joint : NamedAfter("joint", line, joints)) {
    found.push_back(model.joints()[static_cast<std::size_t>(joint)].child_link);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<LinkWarning> WarningsAtLinks(const RobotModel& model, const RobotSource& source) {
  std::vector<LinkWarning> warnings;
  for (const std::string& line : source.warnings) warnings.push_back({line, LinksIn(line, model)});
  if (std::string line = robot::DescribeUnseen(model, source.remedy); !line.empty()) {
    warnings.push_back({std::move(line), robot::DrawnOnly(model)});
  }
  return warnings;
}

std::string SolidName(const geometry::Shape& shape) {
  if (const auto* const mesh = std::get_if<geometry::ConvexMesh>(&shape)) {
    return fmt::format("hull of {} corners", mesh->hull->vertices.size());
  }
  if (const auto* const compound = std::get_if<geometry::Compound>(&shape)) {
    return fmt::format("{} convex parts", compound->parts.size());
  }
  return std::string(systems::NameOf(shape));
}

ordered_json ToJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

ordered_json ToJson(const Eigen::Isometry3d& X) {
  const Eigen::Quaterniond q(X.linear());
  return {{"xyz", ToJson(X.translation().eval())}, {"quaternion", {q.x(), q.y(), q.z(), q.w()}}};
}

ordered_json Limit(double limit) {
  return std::isfinite(limit) ? ordered_json(limit) : ordered_json();
}

ordered_json LinkJson(const RobotModel& model, const robot::Link& link) {
  ordered_json visuals = ordered_json::array(), collisions = ordered_json::array();
  for (const auto& visual : link.visuals) {
    visuals.push_back(visual.shape ? SolidName(*visual.shape) : "mesh");
  }
  for (const auto& element : link.collisions) collisions.push_back(SolidName(element.shape));
  return {{"name", link.name.text()},
          {"frame", model.name().text() + "/" + link.name.text()},
          {"mass", link.inertia.mass},
          {"visuals", visuals},
          {"collisions", collisions}};
}

ordered_json JointJson(const RobotModel& model, int number) {
  constexpr std::array kTypes{"fixed", "revolute", "continuous", "prismatic"};
  const robot::Joint& joint = model.joints()[static_cast<std::size_t>(number)];
  const robot::KinematicStep& step = model.steps()[static_cast<std::size_t>(number)];
  const auto mimics = [&]() -> ordered_json {
    if (!joint.movable() || !joint.mimic) return nullptr;
    return model.joints()[static_cast<std::size_t>(joint.mimic->joint)].name.text();
  };
  const bool moves = step.column >= 0;
  return {{"name", joint.name.text()},
          {"type", kTypes[static_cast<std::size_t>(joint.type)]},
          {"parent", joint.parent_link},
          {"child", joint.child_link},
          {"origin", ToJson(joint.X_PJ)},
          {"axis", ToJson(joint.axis)},
          {"position", moves ? ordered_json(step.column) : ordered_json()},
          {"multiplier", moves ? step.multiplier : 0.0},
          {"offset", moves ? step.offset : 0.0},
          {"mimics", mimics()},
          {"lower", Limit(joint.lower_limit)},
          {"upper", Limit(joint.upper_limit)},
          {"velocity", Limit(joint.velocity_limit)},
          {"effort", Limit(joint.effort_limit)},
          {"acceleration", Limit(joint.acceleration_limit)}};
}

/// As far as a slider goes: the range of the position, or what is drawn of one that is too wide.
std::pair<double, double> SliderRange(const RobotModel& model, int position, double start) {
  constexpr double kHalf = 1.0;  // rad or m
  if (const auto range = robot::DrawnRange(model, position)) return *range;
  return {std::max(model.lower_limits()[position], start - kHalf),
          std::min(model.upper_limits()[position], start + kHalf)};
}

/// The pairs of own links whose contacts the page marks; none, with a warning, of too many.
ordered_json OwnPairs(const std::shared_ptr<const RobotModel>& model,
                      std::vector<LinkWarning>& warnings) {
  const robot::Clearance clearance(model, true, {});
  const auto& pairs = clearance.own_pairs();
  if (pairs.size() <= kMostOwnPairs) return pairs;
  warnings.push_back({fmt::format("contacts of own links are not marked: got {} pairs; expected "
                                  "at most {}",
                                  pairs.size(), kMostOwnPairs),
                      {}});
  return ordered_json::array();
}

ordered_json RobotJson(const std::shared_ptr<const RobotModel>& model, const RobotSource& source,
                       const Eigen::VectorXd& start, std::vector<LinkWarning>& warnings) {
  ordered_json json{{"name", model->name().text()},
                    {"file", source.file},
                    {"srdf", source.srdf.empty() ? ordered_json() : ordered_json(source.srdf)},
                    {"base", ToJson(model->X_WB())},
                    {"links", ordered_json::array()},
                    {"joints", ordered_json::array()},
                    {"positions", ordered_json::array()},
                    {"own_pairs", OwnPairs(model, warnings)},
                    {"disabled_pairs", model->disabled_pairs().size()},
                    {"warnings", ordered_json::array()}};
  for (const auto& link : model->links()) json["links"].push_back(LinkJson(*model, link));
  for (int j = 0; j < model->num_joints(); ++j) {
    json["joints"].push_back(JointJson(*model, j));
    const robot::Joint& joint = model->joints()[static_cast<std::size_t>(j)];
    const int i = joint.position_index;
    if (i < 0) continue;
    json["positions"].push_back({{"joint", joint.name.text()},
                                 {"unit", robot::PositionUnit(joint)},
                                 {"start", start[i]},
                                 {"lower", Limit(model->lower_limits()[i])},
                                 {"upper", Limit(model->upper_limits()[i])},
                                 {"range", SliderRange(*model, i, start[i])}});
  }
  for (const auto& [text, links] : warnings) {
    json["warnings"].push_back({{"text", text}, {"links", links}});
  }
  return json;
}

/// Messages of one instant, each the only one of its topic.
class Messages {
 public:
  void Add(const std::string& topic, const std::string& schema_name, const std::string& schema,
           const std::string& message) {
    const std::uint16_t number = writer_.AddSchema(schema_name, "jsonschema", schema);
    writer_.Write(writer_.AddChannel(topic, "json", number), 0, message);
  }
  void AddScene(const std::string& topic, const std::string& entities) {
    Add(topic, "foxglove.SceneUpdate", FoxgloveSchema("foxglove.SceneUpdate"),
        "{\"deletions\":[],\"entities\":[" + entities + "]}");
  }
  std::string Take() {
    writer_.Close();
    return std::move(bytes_).str();
  }

 private:
  std::ostringstream bytes_;
  McapWriter writer_{bytes_, Compression::kZstd};
};

std::string TransformsOf(const RobotModel& model, const Eigen::VectorXd& q) {
  const auto X_WL = robot::LinkPoses(model, q);
  std::string text = "{\"transforms\":[";
  for (std::size_t i = 0; i < X_WL.size(); ++i) {
    if (i > 0) text += ',';
    AppendTransform(text, 0, model.name().text() + "/" + model.links()[i].name.text(), X_WL[i]);
  }
  return text + "]}";
}

}  // namespace

RobotRecord RecordRobot(const std::shared_ptr<const RobotModel>& model, const RobotSource& source) {
  std::vector<LinkWarning> warnings = WarningsAtLinks(*model, source);
  std::string drawn, collisions;
  for (int i = 0; i < model->num_links(); ++i) {
    const robot::Link& link = model->links()[static_cast<std::size_t>(i)];
    const std::string frame = model->name().text() + "/" + link.name.text();
    SceneEntity visual(frame, frame), collision("collision/" + frame, frame);
    for (const std::string& why : DrawVisuals(link, visual)) {
      warnings.push_back({fmt::format("link '{}': not drawn: {}", link.name.text(), why), {i}});
    }
    DrawCollisions(link, kOverlay, collision);
    if (i > 0) {
      drawn += ',';
      collisions += ',';
    }
    visual.Append(drawn, 0, true);
    collision.Append(collisions, 0, true);
  }
  const Eigen::VectorXd start = Eigen::VectorXd::Zero(model->num_positions())
                                    .cwiseMax(model->lower_limits())
                                    .cwiseMin(model->upper_limits());
  Messages messages;
  messages.Add("/tf", "foxglove.FrameTransforms", FoxgloveSchema("foxglove.FrameTransforms"),
               TransformsOf(*model, start));
  messages.AddScene("/scene/robots", drawn);
  messages.AddScene("/scene/collisions", collisions);
  messages.Add("/robot", "oca.Robot", R"({"title":"oca.Robot","type":"object"})",
               RobotJson(model, source, start, warnings)
                   .dump(-1, ' ', false, ordered_json::error_handler_t::replace));
  RobotRecord record{messages.Take(), {}};
  for (LinkWarning& warning : warnings) record.warnings.push_back(std::move(warning.text));
  return record;
}

}  // namespace oca::record
