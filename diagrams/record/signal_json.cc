// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/signal_json.h"

#include <nlohmann/json.hpp>

#include "oca/diagrams/record/json_text.h"
#include "oca/systems/signals/signals.h"

namespace oca::record {
namespace {

using nlohmann::ordered_json;
using systems::Proximity;
using systems::ProximitySet;

ordered_json NumberSchema(const std::string& unit) {
  ordered_json schema{{"type", {"number", "null"}}};  // null: not finite
  if (!unit.empty()) schema["x-unit"] = unit;
  return schema;
}

/// What a value may be that looks like this one.
ordered_json SchemaLike(const ordered_json& value) {
  if (value.is_number()) return NumberSchema("");
  if (value.is_string()) return {{"type", "string"}};
  if (value.is_boolean()) return {{"type", "boolean"}};
  if (value.is_array()) {
    const ordered_json item{{"type", "object"}};
    return {{"type", "array"}, {"items", value.empty() ? item : SchemaLike(value[0])}};
  }
  ordered_json schema = ordered_json::object();
  if (!value.is_object()) return schema;  // null: of any kind
  schema["type"] = "object";
  for (const auto& [key, member] : value.items()) schema["properties"][key] = SchemaLike(member);
  return schema;
}

ordered_json SchemaOf(const SignalFormat& format) {
  ordered_json properties = ordered_json::object();
  if (format.type != &kVectorType) {
    const auto value = ordered_json::parse(DefaultJson(*format.type));
    if (!value.is_object()) {
      properties[format.port] = SchemaLike(value);
    } else if (!value.empty()) {
      properties = SchemaLike(value)["properties"];
    }
  } else if (format.joints.empty()) {
    properties["values"] = {{"type", "array"}, {"items", NumberSchema(format.unit)}};
  }
  for (const std::string& joint : format.joints) {
    properties[joint] = NumberSchema(format.unit);
    properties[joint]["title"] = joint;
  }
  return {{"title", format.system + "." + format.port},
          {"type", "object"},
          {"x-signal", format.type->name},
          {"properties", properties}};
}

void AppendVector(std::string& out, const SignalFormat& format, const double* values) {
  const bool named = !format.joints.empty();
  out += named ? "{" : "{\"values\":[";
  for (int i = 0; i < format.length; ++i) {
    if (i > 0) out += ',';
    if (named) {
      AppendQuoted(out, format.joints[static_cast<std::size_t>(i)]);
      out += ':';
    }
    AppendJson(out, values[i]);
  }
  out += named ? "}" : "]}";
}

/// What the signal's own WriteJson says, without building a tree of it.
void AppendProximities(std::string& out, const ProximitySet& set, bool brief) {
  out += '[';
  bool first = true;
  for (const Proximity& p : set.proximities) {
    out += first ? "{\"link\":" : ",{\"link\":";
    first = false;
    AppendQuoted(out, p.link.text());
    out += ",\"obstacle\":";
    AppendQuoted(out, p.obstacle.text());
    out += ",\"distance\":";
    AppendJson(out, p.distance);
    if (!brief) {
      out += ",\"point_on_link\":";
      AppendList(out, p.point_on_link);
      out += ",\"point_on_obstacle\":";
      AppendList(out, p.point_on_obstacle);
      out += ",\"normal\":";
      AppendList(out, p.normal);
    }
    out += '}';
  }
  out += ']';
}

}  // namespace

RecordChannel ChannelOf(const SignalFormat& format) {
  const std::string name = format.system + "." + format.port;
  ordered_json schema = SchemaOf(format);
  return {"/" + format.system + "/" + format.port, name, schema.dump()};
}

void AppendSignal(std::string& out, const SignalFormat& format, const void* value) {
  if (format.type == &kVectorType) {
    AppendVector(out, format, static_cast<const double*>(value));
    return;
  }
  const std::size_t start = out.size();
  if (format.type == &TypeOf<ProximitySet>()) {
    AppendProximities(out, *static_cast<const ProximitySet*>(value), format.brief);
  } else {
    format.type->write_json(value, out);
  }
  if (out.size() > start && out[start] != '{') {  // a message is an object
    out.insert(start, "{\"" + format.port + "\":");
    out += '}';
  }
}

}  // namespace oca::record
