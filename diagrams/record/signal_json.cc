// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/signal_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "oca/diagrams/runs/signal_table.h"
#include "oca/framework/dataflow/json_text.h"
#include "oca/framework/dataflow/signal_shape.h"
#include "oca/models/json_values.h"
#include "oca/systems/signals/signals.h"

namespace oca::record {
namespace {

using models::internal::AppendJson;
using models::internal::AppendQuoted;
using nlohmann::ordered_json;
using systems::Proximity;
using systems::ProximitySet;

ordered_json NumberSchema(const std::string& unit) {
  ordered_json schema{{"type", {"number", "null"}}};  // null: not finite
  if (!unit.empty()) schema["x-unit"] = unit;
  return schema;
}

/// What a value may be that looks like this one.
ordered_json SchemaLike(const SignalShape& shape) {
  using Kind = SignalShape::Kind;
  if (shape.kind == Kind::kNumber) return NumberSchema("");
  if (shape.kind == Kind::kText) return {{"type", "string"}};
  if (shape.kind == Kind::kFlag) return {{"type", "boolean"}};
  if (shape.kind == Kind::kList) {
    const ordered_json item{{"type", "object"}};
    return {{"type", "array"}, {"items", shape.item.empty() ? item : SchemaLike(shape.item[0])}};
  }
  ordered_json schema = ordered_json::object();
  if (shape.kind != Kind::kObject) return schema;
  schema["type"] = "object";
  for (const auto& [key, member] : shape.members) schema["properties"][key] = SchemaLike(member);
  return schema;
}

ordered_json SchemaOf(const SignalFormat& format) {
  ordered_json properties = ordered_json::object();
  if (format.type != &kVectorType) {
    const SignalShape shape = ShapeOf(*format.type);
    if (shape.kind != SignalShape::Kind::kObject) {
      properties[format.port] = SchemaLike(shape);
    } else if (!shape.members.empty()) {
      properties = SchemaLike(shape)["properties"];
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

/// Names and distances alone.
void AppendBrief(std::string& out, const ProximitySet& set) {
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
    out += '}';
  }
  out += ']';
}

}  // namespace

std::string TopicOf(const SignalFormat& format) {
  std::string topic = "/" + format.system + "/" + format.port;
  std::replace(topic.begin(), topic.end(), '.', '/');
  return topic;
}

RecordChannel ChannelOf(const SignalFormat& format) {
  return {TopicOf(format), format.system + "." + format.port,
          oca::internal::JsonText(SchemaOf(format)), format};
}

void AppendSignal(std::string& out, const SignalFormat& format, const void* value) {
  if (format.type == &kVectorType) {
    AppendVector(out, format, static_cast<const double*>(value));
    return;
  }
  const std::size_t start = out.size();
  if (format.brief && format.type == &TypeOf<ProximitySet>()) {
    AppendBrief(out, *static_cast<const ProximitySet*>(value));
  } else {
    format.type->write_json(value, out);
  }
  runs::MakeObject(out, start, format.port);  // as a message is
}

}  // namespace oca::record
