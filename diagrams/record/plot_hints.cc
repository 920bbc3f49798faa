// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/plot_hints.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>

#include "oca/framework/dataflow/json_text.h"
#include "oca/systems/signals/roles.h"

namespace oca::record {
namespace {

using loading::LoadedDiagram;
using nlohmann::ordered_json;
using systems::Limits;
using systems::PassesOn;
using systems::Plots;

bool Recorded(const LoadedDiagram& loaded, const OutputHandle& output) {
  return std::any_of(loaded.record.begin(), loaded.record.end(),
                     [&](const auto& signal) { return signal.output == output; });
}

/// An output, or if it is not recorded one that is and shows the same.
OutputHandle RecordedOf(const LoadedDiagram& loaded, const OutputHandle& output) {
  if (Recorded(loaded, output)) return output;
  for (const auto& [path, system, passes] : loaded.diagram->FindRoles<PassesOn>()) {
    const auto source = loaded.diagram->DriverOf(passes->in);
    if (source == output && Recorded(loaded, passes->out)) return passes->out;
    if (passes->out == output && source && Recorded(loaded, *source)) return *source;
  }
  return output;
}

std::string TopicOf(const LoadedDiagram& loaded, const OutputHandle& output) {
  std::string topic = "/" + loaded.diagram->PathOf(output);
  std::replace(topic.begin(), topic.end(), '.', '/');
  return topic;
}

/// A multiple of a system's own period of at least 10 ms: its instants are events of every run.
Period SamplingOf(const Period& own) {
  constexpr double kFinest = 0.01;  // s
  if (!own.positive()) return {};
  const auto times =
      static_cast<std::int64_t>(std::max(1.0, std::ceil(kFinest / own.seconds() - 1e-9)));
  return Period(own.numerator() * times, own.denominator());
}

std::string KindOf(const Limits& limits) {
  switch (limits.shown) {
    case Limits::Shown::kRate:
      return "rate";
    case Limits::Shown::kBelow:
      return "below";
    case Limits::Shown::kAbove:
      return "above";
    case Limits::Shown::kListed:
      break;
  }
  return limits.member;
}

/// How far fields reach; none if there are none.
std::optional<double> RangeOfFields(const LoadedDiagram& loaded) {
  std::optional<double> range;
  for (const auto& field : loaded.diagram->FindRoles<systems::Repels>()) {
    range = std::max(field.role->range, range.value_or(field.role->range));
  }
  return range;
}

}  // namespace

std::vector<LimitHint> LimitHintsOf(const LoadedDiagram& loaded) {
  std::vector<LimitHint> hints;
  for (const auto& [path, system, limits] : loaded.diagram->FindRoles<Limits>()) {
    const auto signal = limits->signal.In(*loaded.diagram);
    if (!signal) continue;
    const bool listed = limits->shown == Limits::Shown::kListed;
    hints.push_back({path, loaded.BlockOf(*system).type, KindOf(*limits),
                     RecordedOf(loaded, *signal), limits->bound, listed ? "" : limits->member,
                     limits->how, SamplingOf(limits->period)});
  }
  return hints;
}

std::string LimitHintsJson(const LoadedDiagram& loaded, const std::vector<LimitHint>& hints) {
  ordered_json list = ordered_json::array();
  for (const LimitHint& hint : hints) {
    ordered_json json{{"system", hint.system},
                      {"type", hint.type},
                      {"kind", hint.kind},
                      {"signal", TopicOf(loaded, hint.output)}};
    if (hint.bound.size() == 1) json["bound"] = hint.bound[0];
    if (hint.bound.size() > 1) json["bound"] = hint.bound;
    if (!hint.member.empty()) json["member"] = hint.member;
    if (!hint.how.empty()) json["how"] = hint.how;
    list.push_back(json);
  }
  return oca::internal::JsonText(list);
}

std::vector<PlotHint> PlotHintsOf(const LoadedDiagram& loaded) {
  std::vector<PlotHint> hints;
  for (const char* id : {"requested", "delta", "final", "distance", "speed"}) {
    hints.push_back({id, "", ""});
  }
  for (const auto& [path, system, plots] : loaded.diagram->FindRoles<Plots>()) {
    const auto signal = plots->signal.In(*loaded.diagram);
    if (!signal) continue;
    auto hint = std::find_if(hints.begin(), hints.end(),
                             [&, &id = plots->id](const auto& other) { return other.id == id; });
    if (hint == hints.end()) hint = hints.insert(hint, {plots->id, "", ""});
    if (hint->outputs.empty()) {
      hint->title = plots->title;
      hint->unit = plots->unit;
    }
    hint->outputs.push_back(RecordedOf(loaded, *signal));
  }
  std::erase_if(hints, [](const PlotHint& hint) { return hint.outputs.empty(); });
  for (PlotHint& hint : hints) {
    if (hint.unit.empty()) hint.unit = loaded.diagram->UnitOf(hint.outputs.front()).ToString();
    if (hint.id == "distance") hint.limit = RangeOfFields(loaded);
  }
  return hints;
}

std::string PlotHintsJson(const LoadedDiagram& loaded, const std::vector<PlotHint>& hints) {
  ordered_json list = ordered_json::array();
  for (const PlotHint& hint : hints) {
    ordered_json topics = ordered_json::array();
    for (const OutputHandle& output : hint.outputs) topics.push_back(TopicOf(loaded, output));
    ordered_json json{
        {"id", hint.id}, {"title", hint.title}, {"unit", hint.unit}, {"topics", topics}};
    if (hint.limit) json["limit"] = *hint.limit;
    list.push_back(json);
  }
  return oca::internal::JsonText(list);
}

}  // namespace oca::record
