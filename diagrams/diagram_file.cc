// SPDX-License-Identifier: BSD-3-Clause
#include "diagrams/diagram_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "diagrams/catalogue.h"
#include "diagrams/sampling/scenario.h"

namespace oca::diagrams {

using nlohmann::ordered_json;

void SimulatorParams::Describe(Fields<SimulatorParams>& fields) {
  fields.Add("duration", &SimulatorParams::duration, "s", "how long to run")
      .AtLeast(0.0)
      .AtMost(1e7);
  fields.Add("integrator", &SimulatorParams::integrator, "", "method for continuous state");
  fields
      .Add("relative_tolerance", &SimulatorParams::relative_tolerance, "",
           "error a step, relative to the state")
      .Above(0.0)
      .AtMost(1.0);
  fields
      .Add("absolute_tolerance", &SimulatorParams::absolute_tolerance, "",
           "error a step, in the unit of the state")
      .Above(0.0);
  fields.Add("max_step", &SimulatorParams::max_step, "s", "longest step of an adaptive integrator")
      .Above(0.0);
  fields
      .Add("fixed_step", &SimulatorParams::fixed_step, "s",
           "longest step of a fixed-step integrator")
      .Above(0.0);
  fields.Add("max_steps", &SimulatorParams::max_steps, "", "steps allowed between two events")
      .AtLeast(1.0);
  fields
      .Add("realtime_factor", &SimulatorParams::realtime_factor, "",
           "simulated seconds to a second of the wall clock; 0 runs as fast as possible")
      .AtLeast(0.0);
  fields.Add("seed", &SimulatorParams::seed, "", "of everything random in the run").AtLeast(0.0);
}

void ToleranceParams::Describe(Fields<ToleranceParams>& fields) {
  fields.Add("relative", &ToleranceParams::relative, "", "error a step, relative to the state")
      .Above(0.0);
  fields.Add("absolute", &ToleranceParams::absolute, "", "error a step, in the unit of the state")
      .Above(0.0);
}

void AttachedParams::Describe(Fields<AttachedParams>& fields) {
  fields.Add("id", &AttachedParams::id, "", "its name, as a link of the robot").Required();
  fields.Add("link", &AttachedParams::link, "", "link that carries it").Required();
  fields.Add("shape", &AttachedParams::shape, "", "its solid").Required();
  fields.Add("pose", &AttachedParams::pose, "", "of the shape in the frame of that link");
  fields.Add("touches", &AttachedParams::touches, "",
             "links of the robot that it may touch, besides those rigidly connected to it");
}

void ModelParams::Describe(Fields<ModelParams>& fields) {
  fields.Add("urdf", &ModelParams::urdf, "", "robot description: a path or package://NAME/PATH")
      .Required();
  fields.Add("srdf", &ModelParams::srdf, "", "pairs of links that are not checked for collision");
  fields.Add("collision", &ModelParams::collision, "",
             "what its collision meshes count as: their convex hull, or the convex parts of a "
             "decomposition, which keep hollows");
  fields.Add("visual_as_collision", &ModelParams::visual_as_collision, "",
             "which links take what is drawn of them as their collision shapes: none, those that "
             "are missing any, or all that are drawn");
  fields.Add("base_pose", &ModelParams::base_pose, "", "pose of the root link in the world");
  fields
      .Add("acceleration_limits", &ModelParams::acceleration_limits, "rad/s^2",
           "which URDF lacks; a number or one a joint")
      .Above(0.0);
  fields
      .Add("jerk_limits", &ModelParams::jerk_limits, "rad/s^3",
           "which URDF lacks; a number or one a joint")
      .Above(0.0);
  fields.Add("attached", &ModelParams::attached, "",
             "tools and grasped objects: they move with a link of the robot and collide");
}

void ExpectParams::Describe(Fields<ExpectParams>& fields) {
  fields.Add("at_least", &ExpectParams::at_least, "", "lower bound");
  fields.Add("at_most", &ExpectParams::at_most, "", "upper bound");
  fields.Add("equal", &ExpectParams::equal, "", "value, give or take `within`");
  fields.Add("within", &ExpectParams::within, "", "distance from `equal` that is allowed")
      .AtLeast(0.0);
  fields.Add("at", &ExpectParams::at, "s", "when to look; the end of the run if left out")
      .AtLeast(0.0);
}

const std::vector<Section>& Sections() {
  static const std::vector<Section> sections = {
      {"name", "short name of the diagram"},
      {"description", "what it shows, in a sentence"},
      {"include", "files to merge first; this file wins"},
      {"parameters", "knobs of this file, used as ${name}"},
      {"simulator", "duration, integrator, tolerances, seed"},
      {"simulator_tolerances", "tolerances of single systems, by name"},
      {"sampling",
       "makes the file a family of scenarios: what the seed draws, and what is accepted"},
      {"packages", "folders that package://NAME/ stands for"},
      {"models", "robots and frames, by name"},
      {"systems", "blocks, by name: type and parameters"},
      {"connections", "list of `system.output -> system.input`"},
      {"record", "signals to keep, with their rates in Hz"},
      {"expect", "bounds on metrics and signals that the run must keep"},
  };
  return sections;
}

namespace {

ordered_json SchemaOf(const ParamType& type) { return ordered_json::parse(type.Schema({})); }

ordered_json MapOf(const ordered_json& items) {
  return {{"type", "object"}, {"additionalProperties", items}};
}

/// What is no text may also be given as "${...}". Said beside the type, not as an alternative, so
/// that an editor says of a wrong number what is wrong with it.
void AllowExpressions(ordered_json& schema) {
  for (const char* key : {"items", "additionalProperties"}) {
    if (schema.contains(key) && schema[key].is_object()) AllowExpressions(schema[key]);
  }
  if (schema.contains("properties")) {
    for (auto& [key, property] : schema["properties"].items()) AllowExpressions(property);
  }
  const char* const expression = "\\$\\{.*\\}";
  if (schema.contains("enum")) {
    ordered_json names{{"enum", schema["enum"]}};
    schema.erase("enum");
    schema["anyOf"] =
        ordered_json::array({std::move(names), {{"type", "string"}, {"pattern", expression}}});
  } else if (schema.contains("type") && schema["type"] != "object" && schema["type"] != "string") {
    if (!schema["type"].is_array()) schema["type"] = ordered_json::array({schema["type"]});
    schema["type"].push_back("string");
    schema["pattern"] = expression;
  }
}

/// Nothing is required of maps: what is missing here may stand in a file that includes this one or
/// is included by it, for maps are merged key by key. Lists are not, so what they hold is whole.
void AllowPartialMaps(ordered_json& schema) {
  schema.erase("required");
  if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object()) {
    AllowPartialMaps(schema["additionalProperties"]);
  }
  if (!schema.contains("properties")) return;
  for (auto& [key, property] : schema["properties"].items()) AllowPartialMaps(property);
}

/// Of the parts of a diagram that maps hold.
ordered_json PartialSchemaOf(ordered_json schema) {
  AllowExpressions(schema);
  AllowPartialMaps(schema);
  return schema;
}

ordered_json IfType(const std::string& type, const ordered_json& then) {
  const ordered_json condition{{"required", {"type"}},
                               {"properties", {{"type", {{"const", type}}}}}};
  return {{"if", condition}, {"then", then}};
}

/// The system that is named by `type`; where an included file names it, any key of any system.
ordered_json SystemsSchema() {
  ordered_json types = ordered_json::array();
  ordered_json cases = ordered_json::array();
  ordered_json known = ordered_json::object();  // key -> what it is in one system or another
  for (const CatalogueRow& row : Catalogue()) {
    ordered_json schema = PartialSchemaOf(ordered_json::parse(row.schema()));
    types.push_back(row.type);
    for (const auto& [key, property] : schema["properties"].items()) {
      ordered_json& variants = known[key]["anyOf"];
      if (std::find(variants.begin(), variants.end(), property) == variants.end()) {
        variants.push_back(property);
      }
    }
    schema["properties"]["type"] = {{"const", row.type}, {"description", row.doc.summary}};
    schema["description"] = row.doc.summary;
    cases.push_back(IfType(row.type, schema));
  }
  cases.push_back({{"if", {{"not", {{"required", {"type"}}}}}},
                   {"then", {{"properties", known}, {"additionalProperties", false}}}});
  return MapOf(
      {{"type", "object"}, {"properties", {{"type", {{"enum", types}}}}}, {"allOf", cases}});
}

/// What a file with a name that includes nothing must say: it is whole.
ordered_json WholeFileSchema() {
  ordered_json cases = ordered_json::array();
  for (const CatalogueRow& row : Catalogue()) {
    const ordered_json schema = ordered_json::parse(row.schema());
    if (!schema.contains("required")) continue;
    cases.push_back(IfType(row.type, {{"required", schema["required"]}}));
  }
  const ordered_json systems = MapOf({{"required", {"type"}}, {"allOf", cases}});
  const ordered_json models =
      MapOf({{"required", SchemaOf(ParamTypeOf<ModelParams>())["required"]}});
  return {{"properties", {{"systems", systems}, {"models", models}}}};
}

}  // namespace

std::string DiagramSchema() {
  ordered_json sections;
  const ordered_json text{{"type", "string"}};
  sections["name"] = text;
  sections["description"] = text;
  sections["include"] = {{"type", "array"}, {"items", text}};
  sections["parameters"] = {{"type", "object"}};
  sections["simulator"] = PartialSchemaOf(SchemaOf(ParamTypeOf<SimulatorParams>()));
  sections["simulator_tolerances"] =
      PartialSchemaOf(MapOf(SchemaOf(ParamTypeOf<ToleranceParams>())));
  sections["sampling"] = PartialSchemaOf(ordered_json::parse(SamplingSchema()));
  sections["packages"] = MapOf(text);
  sections["models"] = PartialSchemaOf(MapOf(SchemaOf(ParamTypeOf<ModelParams>())));
  sections["systems"] = SystemsSchema();
  sections["connections"] = {{"type", "array"},
                             {"items", {{"type", "string"}, {"pattern", "^\\S+ *-> *\\S+$"}}}};
  const ordered_json rate{{"type", "number"}, {"exclusiveMinimum", 0}};
  sections["record"] =
      PartialSchemaOf({{"type", "object"},
                       {"additionalProperties", false},
                       {"properties", {{"signals", MapOf(rate)}, {"scene", rate}}}});
  sections["expect"] = PartialSchemaOf(MapOf(SchemaOf(ParamTypeOf<ExpectParams>())));
  for (const Section& section : Sections()) sections[section.key]["description"] = section.meaning;
  const ordered_json whole{{"required", {"name"}}, {"not", {{"required", {"include"}}}}};
  const ordered_json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
                            {"title", "OCA diagram"},
                            {"type", "object"},
                            {"additionalProperties", false},
                            {"properties", sections},
                            {"if", whole},
                            {"then", WholeFileSchema()}};
  return schema.dump(2);
}

}  // namespace oca::diagrams
