// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/output_sections.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>

#include "oca/diagrams/files/section.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/framework/dataflow/signal_shape.h"
#include "oca/models/file_cache.h"

namespace oca::files {
namespace {

std::vector<std::string> NamesOf(const NamedOutputs& outputs) {
  std::vector<std::string> names;
  for (const auto& output : outputs) names.push_back(output.first);
  return names;
}

const OutputHandle* FindByName(const NamedOutputs& outputs, const std::string& name) {
  const auto found = std::find_if(outputs.begin(), outputs.end(),
                                  [&](const auto& output) { return output.first == name; });
  return found == outputs.end() ? nullptr : &found->second;
}

constexpr double kHighestRate = 1e6;  // Hz; a run that samples more often would hardly get on

std::optional<Period> ReadRate(const Value& value, const std::string& where, Problems& problems) {
  double hertz = 0.0;
  if (!value.number(hertz) || !(hertz > 0.0 && hertz <= kHighestRate)) {
    if (!value.null()) {
      problems.Add(value.location(),
                   fmt::format("{}: got {}; expected a rate above 0, at most {} Hz", where,
                               value.Show(), kHighestRate));
    }
    return std::nullopt;
  }
  try {
    const Period inverse = Period::FromSeconds(hertz);
    return Period(inverse.denominator(), inverse.numerator());
  } catch (const ConfigError&) {
    problems.Add(value.location(),
                 fmt::format("{}: got {} Hz; expected a ratio of integers", where, hertz));
    return std::nullopt;
  }
}

void ReadSignal(const Value::Entry& entry, const NamedOutputs& outputs, const NamedOutputs& others,
                std::vector<RecordedSignal>& record, Problems& problems) {
  const auto period = ReadRate(entry.value, "record.signals." + entry.key, problems);
  bool matched = false;
  const auto keep = [&](const std::string& name, const OutputHandle& output) {
    matched = true;
    const bool taken = std::any_of(record.begin(), record.end(),
                                   [&](const auto& other) { return other.name == name; });
    if (period && !taken) record.push_back({name, output, *period});
  };
  const bool pattern = entry.key.find_first_of("*?[\\") != std::string::npos;
  for (const auto& [name, output] : outputs) {
    const bool fits =
        pattern ? fnmatch(entry.key.c_str(), name.c_str(), 0) == 0 : name == entry.key;
    if (fits) keep(name, output);
  }
  if (const OutputHandle* const other = FindByName(others, entry.key)) keep(entry.key, *other);
  if (!matched) {
    problems.Add(entry.location, fmt::format("record.signals: no output matches '{}'{}", entry.key,
                                             DidYouMean(entry.key, NamesOf(outputs))));
  }
}

/// The members of a signal type's JSON object.
std::vector<std::string> ReadMembers(const SignalType& type) {
  std::vector<std::string> names;
  for (const auto& [name, shape] : ShapeOf(type).members) names.push_back(name);
  return names;
}

/// The same, looked at once while a cache is in use.
std::shared_ptr<const std::vector<std::string>> MembersOf(const SignalType& type) {
  const std::string key = fmt::format("signal {}", fmt::ptr(&type));
  return models::ReadOnce<std::vector<std::string>>(key, "members",
                                                    [&] { return ReadMembers(type); });
}

/// Reads one entry of `expect`.
class ExpectationReader {
 public:
  ExpectationReader(const Value::Entry& entry, const NamedOutputs& outputs, const Diagram* diagram,
                    Problems& problems)
      : entry_(entry),
        where_("expect." + entry.key),
        outputs_(outputs),
        diagram_(diagram),
        problems_(problems) {
    result_.name = entry.key;
  }

  /// The expectation, unless it looks at nothing there is.
  std::optional<Expectation> Read(const NamedOutputs& metrics, double duration) {
    ReadBound(duration);
    const bool metric = entry_.key.find('.') == std::string::npos;
    if (metric ? !AimAtMetric(metrics) : !AimAtPort(metrics)) return std::nullopt;
    return result_;
  }

 private:
  bool Fail(const std::string& what) {
    problems_.Add(entry_.location, where_ + what);
    return false;
  }

  void ReadBound(double duration) {
    ExpectParams& bound = result_.bound;
    ReadFields(entry_.value, FieldsOf<ExpectParams>(), where_, &bound, problems_);
    if (!bound.at_least && !bound.at_most && !bound.equal) {
      Fail(": no bound; expected at_least, at_most or equal (with within)");
    }
    if (bound.at_least && bound.at_most && *bound.at_least > *bound.at_most) {
      Fail(
          fmt::format(": no value is at least {} and at most {}", *bound.at_least, *bound.at_most));
    }
    if (bound.at && *bound.at > duration) {
      Fail(fmt::format(".at: got {} s; expected at most the duration {} s", *bound.at, duration));
    }
  }

  bool AimAtMetric(const NamedOutputs& metrics) {
    if (metrics.empty()) return Fail(": a metric needs a system that judges the run");
    return AimAtMember(metrics, entry_.key);
  }

  bool AimAtMember(const NamedOutputs& judges, const std::string& member) {
    result_.output = judges.front().second;
    result_.member = member;
    result_.judges = judges;
    return CheckMember();
  }

  /// `system.port[i]` or `system.port.member`, of which `system` may have dots in it; or
  /// `file.metric`.
  bool AimAtPort(const NamedOutputs& metrics) {
    const std::string& key = entry_.key;
    const std::string port = LongestPort();
    if (port.empty()) return AimAtMetricBelow(metrics);
    const std::string rest = key.substr(port.size());
    if (rest.starts_with('[')) {
      if (!ReadIndex(rest.substr(1))) return Fail(": expected system.port[i]");
    } else if (!rest.empty()) {
      result_.member = rest.substr(1);
    }
    result_.output = *FindByName(outputs_, port);
    if (&TypeOfPort(result_.output) != &kVectorType) return CheckMember();
    if (diagram_ == nullptr) return false;
    const int size = diagram_->SizeOf(result_.output);
    if (result_.index < 0 && size == 1 && result_.member.empty()) result_.index = 0;
    if (result_.index >= 0 && result_.index < size) return true;
    return Fail(fmt::format(": expected {}[i] with i from 0 to {}", port, size - 1));
  }

  /// The output that the key begins with; empty if there is none.
  std::string LongestPort() const {
    std::string longest;
    for (const auto& [name, output] : outputs_) {
      const bool fits = entry_.key.starts_with(name) &&
                        (entry_.key.size() == name.size() || entry_.key[name.size()] == '.' ||
                         entry_.key[name.size()] == '[');
      if (fits && name.size() > longest.size()) longest = name;
    }
    return longest;
  }

  bool AimAtMetricBelow(const NamedOutputs& metrics) {
    const std::size_t dot = entry_.key.rfind('.');
    NamedOutputs judges;
    for (const auto& judge : metrics) {
      if (judge.first.starts_with(entry_.key.substr(0, dot + 1))) judges.push_back(judge);
    }
    if (!judges.empty()) return AimAtMember(judges, entry_.key.substr(dot + 1));
    const std::string port = entry_.key.substr(0, entry_.key.find('['));
    std::vector<std::string> known = NamesOf(outputs_);
    for (const auto& [judge, output] : metrics) AddMetricsBelow(judge, output, known);
    return Fail(fmt::format(": no output '{}'{}", port, DidYouMean(port, known)));
  }

  /// `file.metric` of all files that a judge lies in.
  static void AddMetricsBelow(const std::string& judge, const OutputHandle& output,
                              std::vector<std::string>& known) {
    for (std::size_t dot = judge.find('.'); dot != std::string::npos;
         dot = judge.find('.', dot + 1)) {
      for (const std::string& member : *MembersOf(TypeOfPort(output))) {
        known.push_back(judge.substr(0, dot + 1) + member);
      }
    }
  }

  bool ReadIndex(const std::string& text) {
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, result_.index);
    return error == std::errc() && end + 1 == last && *end == ']' && result_.index >= 0;
  }

  bool CheckMember() {
    const SignalType& type = TypeOfPort(result_.output);
    const auto members = MembersOf(type);
    const bool found =
        std::find(members->begin(), members->end(), result_.member) != members->end();
    return found || Fail(fmt::format(": {} has no number '{}'{}", type.name, result_.member,
                                     DidYouMean(result_.member, *members)));
  }

  const Value::Entry& entry_;
  const std::string where_;
  const NamedOutputs& outputs_;
  const Diagram* diagram_;
  Problems& problems_;
  Expectation result_;
};

}  // namespace

std::vector<RecordedSignal> ReadRecord(const Value& root, const NamedOutputs& outputs,
                                       const NamedOutputs& others, Problems& problems) {
  std::vector<RecordedSignal> record;
  for (const Value::Entry& entry : SectionOf(root, "record", problems)) {
    if (entry.key == "scene") continue;  // ReadSceneRate's
    if (entry.key != "signals") {
      const std::vector<std::string> known{"signals", "scene"};
      problems.Add(entry.location, fmt::format("record.{}: unknown key{}; known: signals, scene",
                                               entry.key, DidYouMean(entry.key, known)));
    } else if (entry.value.map() == nullptr) {
      problems.Add(entry.value.location(),
                   fmt::format("record.signals: got {}; expected a map from names to rates",
                               entry.value.Show()));
    } else {
      for (const Value::Entry& signal : *entry.value.map()) {
        ReadSignal(signal, outputs, others, record, problems);
      }
    }
  }
  return record;
}

Period ReadSceneRate(const Value& root, const Period& otherwise, Problems& problems) {
  const Value* const record = root.Find("record");
  const Value* const scene = record == nullptr ? nullptr : record->Find("scene");
  if (scene == nullptr) return otherwise;
  return ReadRate(*scene, "record.scene", problems).value_or(otherwise);
}

std::vector<Expectation> ReadExpectations(const Value& root, const NamedOutputs& outputs,
                                          const NamedOutputs& metrics, const Diagram* diagram,
                                          double duration, Problems& problems) {
  std::vector<Expectation> expectations;
  for (const Value::Entry& entry : SectionOf(root, "expect", problems)) {
    auto expectation = ExpectationReader(entry, outputs, diagram, problems).Read(metrics, duration);
    if (expectation) expectations.push_back(std::move(*expectation));
  }
  return expectations;
}

}  // namespace oca::files
