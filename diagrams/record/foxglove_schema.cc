// SPDX-License-Identifier: BSD-3-Clause
// The schemas of what foxglove.h writes.
#include <nlohmann/json.hpp>

#include "oca/diagrams/record/foxglove.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/json_text.h"

namespace oca::record {
namespace {

using nlohmann::ordered_json;
using Members = std::initializer_list<std::pair<const char*, ordered_json>>;

ordered_json Object(Members members) {
  ordered_json properties = ordered_json::object();
  for (const auto& [key, schema] : members) properties[key] = schema;
  return {{"type", "object"}, {"properties", properties}};
}

ordered_json ListOf(const ordered_json& items) { return {{"type", "array"}, {"items", items}}; }

ordered_json Number() { return {{"type", "number"}}; }
ordered_json Whole() { return {{"type", "integer"}, {"minimum", 0}}; }
ordered_json Text() { return {{"type", "string"}}; }
ordered_json Truth() { return {{"type", "boolean"}}; }

ordered_json Time(const char* title) {
  ordered_json time = Object({{"sec", Whole()}, {"nsec", Whole()}});
  time["title"] = title;  // readers tell instants and spans by it
  return time;
}

ordered_json Xyz() { return Object({{"x", Number()}, {"y", Number()}, {"z", Number()}}); }
ordered_json Quaternion() {
  return Object({{"x", Number()}, {"y", Number()}, {"z", Number()}, {"w", Number()}});
}
ordered_json Pose() { return Object({{"position", Xyz()}, {"orientation", Quaternion()}}); }
ordered_json Rgba() {
  return Object({{"r", Number()}, {"g", Number()}, {"b", Number()}, {"a", Number()}});
}

ordered_json Entity() {
  const ordered_json arrow = Object({{"pose", Pose()},
                                     {"shaft_length", Number()},
                                     {"shaft_diameter", Number()},
                                     {"head_length", Number()},
                                     {"head_diameter", Number()},
                                     {"color", Rgba()}});
  const ordered_json sized = Object({{"pose", Pose()}, {"size", Xyz()}, {"color", Rgba()}});
  const ordered_json cylinder = Object({{"pose", Pose()},
                                        {"size", Xyz()},
                                        {"bottom_scale", Number()},
                                        {"top_scale", Number()},
                                        {"color", Rgba()}});
  const ordered_json line = Object({{"type", Whole()},
                                    {"pose", Pose()},
                                    {"thickness", Number()},
                                    {"scale_invariant", Truth()},
                                    {"points", ListOf(Xyz())},
                                    {"color", Rgba()},
                                    {"colors", ListOf(Rgba())},
                                    {"indices", ListOf(Whole())}});
  ordered_json bytes = Text();
  bytes["contentEncoding"] = "base64";
  const ordered_json model = Object({{"pose", Pose()},
                                     {"scale", Xyz()},
                                     {"color", Rgba()},
                                     {"override_color", Truth()},
                                     {"url", Text()},
                                     {"media_type", Text()},
                                     {"data", bytes}});
  return Object({{"timestamp", Time("time")},
                 {"frame_id", Text()},
                 {"id", Text()},
                 {"lifetime", Time("duration")},
                 {"frame_locked", Truth()},
                 {"metadata", ListOf(Object({{"key", Text()}, {"value", Text()}}))},
                 {"arrows", ListOf(arrow)},
                 {"cubes", ListOf(sized)},
                 {"spheres", ListOf(sized)},
                 {"cylinders", ListOf(cylinder)},
                 {"lines", ListOf(line)},
                 {"triangles", ListOf(Object({}))},
                 {"texts", ListOf(Object({}))},
                 {"models", ListOf(model)}});
}

}  // namespace

std::string FoxgloveSchema(std::string_view name) {
  ordered_json schema;
  if (name == "foxglove.FrameTransforms") {
    schema = Object({{"transforms", ListOf(Object({{"timestamp", Time("time")},
                                                   {"parent_frame_id", Text()},
                                                   {"child_frame_id", Text()},
                                                   {"translation", Xyz()},
                                                   {"rotation", Quaternion()}}))}});
  } else if (name == "foxglove.SceneUpdate") {
    const ordered_json deletion =
        Object({{"timestamp", Time("time")}, {"type", Whole()}, {"id", Text()}});
    schema = Object({{"deletions", ListOf(deletion)}, {"entities", ListOf(Entity())}});
  } else if (name == "foxglove.Log") {
    schema = Object({{"timestamp", Time("time")},
                     {"level", Whole()},
                     {"message", Text()},
                     {"name", Text()},
                     {"file", Text()},
                     {"line", Whole()}});
  } else {
    throw ConfigError("foxglove: no schema '" + std::string(name) + "'");
  }
  schema["title"] = name;
  return oca::internal::JsonText(schema);
}

}  // namespace oca::record
