// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/signals.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <unordered_set>
#include <utility>

#include "oca/framework/dataflow/json_text.h"
#include "oca/models/json_values.h"
#include "oca/systems/sensing/geometry_params.h"
#include "oca/systems/signals/json_fields.h"

namespace oca::systems {
namespace {

Json ToJson(const SolidParams& shape) {
  Json json{{"type", EnumNames(shape.type)[static_cast<int>(shape.type)]}};
  if (shape.radius) json["radius"] = *shape.radius;
  if (shape.length) json["length"] = *shape.length;
  if (shape.size) json["size"] = systems::ToJson(*shape.size);
  if (shape.radii) json["radii"] = systems::ToJson(*shape.radii);
  if (shape.file) json["file"] = *shape.file;
  return json;
}

Json ToJson(const ShapeParams& shape) {
  Json json = ToJson(static_cast<const SolidParams&>(shape));
  if (shape.collision)
    json["collision"] = EnumNames(*shape.collision)[static_cast<int>(*shape.collision)];
  for (const PartParams& part : shape.parts) {
    json["parts"].push_back(
        {{"shape", ToJson(part.shape)}, {"pose", systems::ToJson(part.pose->Pose("part"))}});
  }
  return json;
}

void ReadSolid(const JsonReader& json, SolidParams* shape) {
  const std::string type = json.At("type").Text();
  const auto found = std::find(kShapeTypeNames.begin(), kShapeTypeNames.end(), type);
  if (found == kShapeTypeNames.end()) {
    json.At("type").Fail("'" + type + "'", fmt::format("{}", fmt::join(kShapeTypeNames, ", ")));
  }
  shape->type = static_cast<ShapeType>(found - kShapeTypeNames.begin());
  if (json.Has("radius")) shape->radius = json.At("radius").Number();
  if (json.Has("length")) shape->length = json.At("length").Number();
  if (json.Has("size")) shape->size = json.At("size").Vector3();
  if (json.Has("radii")) shape->radii = json.At("radii").Vector3();
  if (json.Has("file")) shape->file = json.At("file").Label();
}

PartParams ReadPart(const JsonReader& json) {
  json.CheckKeys({"shape"}, {"pose"});
  json.At("shape").CheckKeys({"type"}, {"radius", "length", "size", "radii", "file"});
  PartParams part;
  ReadSolid(json.At("shape"), &part.shape);
  if (json.Has("pose")) part.pose = PoseParamsOf(json.At("pose").Pose());
  return part;
}

CollisionMeshes ReadCollision(const JsonReader& json) {
  const std::string text = json.Text();
  const auto names = EnumNames(CollisionMeshes());
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end()) json.Fail("'" + text + "'", fmt::format("{}", fmt::join(names, ", ")));
  return static_cast<CollisionMeshes>(found - names.begin());
}

ShapeParams ReadShape(const JsonReader& json) {
  json.CheckKeys({"type"}, {"radius", "length", "size", "radii", "file", "parts", "cell", "scale",
                            "collision"});
  ShapeParams shape;
  ReadSolid(json, &shape);
  if (json.Has("cell")) shape.cell = json.At("cell").Number();
  if (json.Has("scale")) shape.scale = json.At("scale").Number();
  if (json.Has("collision")) shape.collision = ReadCollision(json.At("collision"));
  if (json.Has("parts")) {
    json.At("parts").ForEach(
        [&](const JsonReader& part) { shape.parts.push_back(ReadPart(part)); });
  }
  return shape;
}

Json ToJson(const Obstacle& obstacle) {
  Json json{{"id", obstacle.body->id.text()},
            {"shape", ToJson(ShapeParamsOf(*obstacle.body))},
            {"pose", systems::ToJson(obstacle.X_WO)}};
  if (obstacle.velocity_known) {
    json["twist"] = {{"linear", systems::ToJson(obstacle.linear)},
                     {"angular", systems::ToJson(obstacle.angular)}};
  }
  return json;
}

void AddEstimate(const ObstacleEstimate& estimate, Json& json) {
  json["acceleration"] = systems::ToJson(estimate.acceleration);
  json["covariance"] = Json::array();
  for (const double entry : estimate.covariance.reshaped<Eigen::RowMajor>()) {
    json["covariance"].push_back(entry);
  }
  json["age"] = estimate.age;
}

ObstacleEstimate ReadEstimate(const JsonReader& json) {
  json.CheckKeys({"id", "shape", "pose", "acceleration", "covariance", "age"}, {"twist"});
  ObstacleEstimate estimate;
  estimate.acceleration = json.At("acceleration").Vector3();
  estimate.age = json.At("age").Number();
  Eigen::Index count = 0;
  json.At("covariance").ForEach([&](const JsonReader& entry) {
    if (count < 36) estimate.covariance(count / 6, count % 6) = entry.Number();
    ++count;
  });
  if (count != 36) json.At("covariance").Fail(fmt::format("{} numbers", count), "36, row by row");
  return estimate;
}

/// Zero if there is none.
robot::LinkVelocity ReadTwist(const JsonReader& json) {
  if (!json.Has("twist")) return {};
  const JsonReader twist = json.At("twist");
  twist.CheckKeys({"linear", "angular"});
  return {twist.At("linear").Vector3(), twist.At("angular").Vector3()};
}

Obstacle ReadObstacle(const JsonReader& json) {
  json.CheckKeys({"id", "shape", "pose"}, {"twist", "acceleration", "covariance", "age"});
  Obstacle obstacle;
  const std::string id = json.At("id").Label();
  obstacle.body = MakeObstacleBody(id, ReadShape(json.At("shape")), "obstacle '" + id + "'.shape");
  obstacle.X_WO = json.At("pose").Pose();
  const robot::LinkVelocity velocity = ReadTwist(json);
  obstacle.velocity_known = json.Has("twist");
  obstacle.linear = velocity.linear;
  obstacle.angular = velocity.angular;
  return obstacle;
}

Proximity ReadProximity(const JsonReader& json) {
  json.CheckKeys({"link", "obstacle", "distance", "point_on_link", "point_on_obstacle", "normal"},
                 {"obstacle_velocity", "own_link", "obstacle_speed", "range"});
  Proximity proximity;
  proximity.link = models::Name(json.At("link").Label());
  proximity.obstacle = models::Name(json.At("obstacle").Label());
  proximity.distance = json.At("distance").Number();
  proximity.point_on_link = json.At("point_on_link").Vector3();
  proximity.point_on_obstacle = json.At("point_on_obstacle").Vector3();
  proximity.normal = json.At("normal").UnitVector();
  if (json.Has("obstacle_velocity")) {
    proximity.obstacle_velocity = json.At("obstacle_velocity").Vector3();
  }
  if (json.Has("obstacle_speed")) proximity.obstacle_speed = json.At("obstacle_speed").Number();
  if (json.Has("own_link")) proximity.own_link = models::Name(json.At("own_link").Label());
  if (json.Has("range")) proximity.range = json.At("range").Number();
  return proximity;
}

/// Without a tree: recorders write many a tick.
void AppendProximity(const Proximity& proximity, std::string& out) {
  using models::internal::AppendList;
  using models::internal::AppendQuoted;
  out += "{\"link\":";
  AppendQuoted(out, proximity.link.text());
  out += ",\"obstacle\":";
  AppendQuoted(out, proximity.obstacle.text());
  out += ",\"distance\":";
  models::internal::AppendJson(out, proximity.distance);
  out += ",\"point_on_link\":";
  AppendList(out, proximity.point_on_link);
  out += ",\"point_on_obstacle\":";
  AppendList(out, proximity.point_on_obstacle);
  out += ",\"normal\":";
  AppendList(out, proximity.normal);
  out += '}';
}

LinkForce ReadForce(const JsonReader& json) {
  json.CheckKeys({"link", "obstacle", "force", "point"});
  return {models::Name(json.At("link").Label()), models::Name(json.At("obstacle").Text()),
          json.At("force").Vector3(), json.At("point").Vector3()};
}

LinkWrench ReadWrench(const JsonReader& json) {
  json.CheckKeys({"link", "force", "torque", "origin"});
  return {models::Name(json.At("link").Label()), json.At("force").Vector3(),
          json.At("torque").Vector3(), json.At("origin").Vector3()};
}

/// Calls read_item(reader) for the items of the list in `text`.
template <class ReadItem>
void ReadList(std::string_view text, const char* what, const ReadItem& read_item) {
  const Json json = oca::internal::ReadJsonTree(text);
  JsonReader(json, what).ForEach(read_item);
}

template <class Items, class ItemToJson>
void WriteList(const Items& items, std::string& out, const ItemToJson& item_to_json) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(item_to_json(item));
  out += oca::internal::JsonText(list);
}

}  // namespace

int LinkPoses::Find(models::Name link, int hint) const {
  if (hint >= 0 && hint < static_cast<int>(links.size()) && links[hint] == link) return hint;
  const auto found = std::find(links.begin(), links.end(), link);
  return found == links.end() ? -1 : static_cast<int>(found - links.begin());
}

}  // namespace oca::systems

namespace oca {

using namespace systems;  // NOLINT: the traits of this file's own types
using systems::ToJson;

void Signal<ObstacleSet>::WriteJson(const ObstacleSet& value, std::string& out) {
  std::size_t place = 0;
  WriteList(value.obstacles, out, [&](const Obstacle& o) {
    Json json = ToJson(o);
    if (!value.estimates.empty()) AddEstimate(value.estimates[place++], json);
    return json;
  });
}

ObstacleSet Signal<ObstacleSet>::ReadJson(std::string_view text) {
  ObstacleSet set;
  std::unordered_set<std::string> ids;
  ReadList(text, "obstacles", [&](const JsonReader& item) {
    set.obstacles.push_back(ReadObstacle(item));
    const std::string& id = set.obstacles.back().body->id.text();
    if (!ids.insert(id).second) item.Fail("the id '" + id + "' again", "unique ids");
    if (item.Has("covariance") || item.Has("age") || item.Has("acceleration")) {
      set.estimates.push_back(ReadEstimate(item));
    }
    if (!set.estimates.empty() && set.estimates.size() != set.obstacles.size()) {
      item.Fail("an estimate of some obstacles", "one of all or of none");
    }
  });
  return set;
}

void Signal<LinkPoses>::WriteJson(const LinkPoses& value, std::string& out) {
  Json list = Json::array();
  for (std::size_t i = 0; i < value.size(); ++i) {
    list.push_back({{"link", value.links[i].text()}, {"pose", ToJson(value.poses[i])}});
  }
  out += oca::internal::JsonText(list);
}

LinkPoses Signal<LinkPoses>::ReadJson(std::string_view text) {
  LinkPoses links;
  ReadList(text, "links", [&](const JsonReader& item) {
    item.CheckKeys({"link", "pose"}, {"twist"});
    const std::string name = item.At("link").Label();
    if (links.Find(models::Name(name)) >= 0) item.Fail("'" + name + "' again", "unique links");
    links.bodies.push_back(static_cast<int>(links.size()));
    links.links.emplace_back(name);
    links.poses.push_back(item.At("pose").Pose());
    links.velocities.push_back(ReadTwist(item));
  });
  return links;
}

void Signal<ProximitySet>::WriteJson(const ProximitySet& value, std::string& out) {
  out += '[';
  for (const Proximity& p : value.proximities) {
    if (&p != value.proximities.data()) out += ',';
    AppendProximity(p, out);
  }
  out += ']';
}

ProximitySet Signal<ProximitySet>::ReadJson(std::string_view text) {
  ProximitySet set;
  ReadList(text, "proximities",
           [&](const JsonReader& item) { set.proximities.push_back(ReadProximity(item)); });
  set.compared = !set.proximities.empty();
  return set;
}

void Signal<LinkForceSet>::WriteJson(const LinkForceSet& value, std::string& out) {
  WriteList(value.forces, out, [](const LinkForce& f) -> Json {
    return {{"link", f.link.text()},
            {"obstacle", f.obstacle.text()},
            {"force", ToJson(f.force)},
            {"point", ToJson(f.point)}};
  });
}

LinkForceSet Signal<LinkForceSet>::ReadJson(std::string_view text) {
  LinkForceSet set;
  ReadList(text, "forces", [&](const JsonReader& item) { set.forces.push_back(ReadForce(item)); });
  return set;
}

void Signal<WrenchSet>::WriteJson(const WrenchSet& value, std::string& out) {
  WriteList(value.wrenches, out, [](const LinkWrench& w) -> Json {
    return {{"link", w.link.text()},
            {"force", ToJson(w.force)},
            {"torque", ToJson(w.torque)},
            {"origin", ToJson(w.origin)}};
  });
}

WrenchSet Signal<WrenchSet>::ReadJson(std::string_view text) {
  WrenchSet set;
  ReadList(text, "wrenches",
           [&](const JsonReader& item) { set.wrenches.push_back(ReadWrench(item)); });
  return set;
}

}  // namespace oca
