// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "oca/diagrams/runs/signal_recorder.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/schedule.h"

namespace oca::runs {
namespace {

using nlohmann::ordered_json;

std::optional<double> MemberOf(const std::string& json, const std::string& member) {
  const auto object = ordered_json::parse(json, nullptr, false);
  if (!object.is_object()) return std::nullopt;
  const auto value = object.value(member, ordered_json());
  if (!value.is_number()) return std::nullopt;
  return value.get<double>();
}

std::optional<double> ValueOf(const files::Expectation& expectation, const Context& context) {
  if (expectation.member.empty()) {
    return EvalVector(expectation.output, context)[expectation.index];
  }
  std::string text;
  EvalJson(expectation.output, context, text);
  return MemberOf(text, expectation.member);
}

std::string BoundText(const files::ExpectParams& bound) {
  std::vector<std::string> parts;
  if (bound.at_least) parts.push_back(fmt::format(">= {:.6g}", *bound.at_least));
  if (bound.at_most) parts.push_back(fmt::format("<= {:.6g}", *bound.at_most));
  if (bound.equal) parts.push_back(fmt::format("= {} within {}", *bound.equal, bound.within));
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : " and ") + part;
  return text;
}

bool Holds(const files::ExpectParams& bound, double value) {
  return (!bound.at_least || value >= *bound.at_least) &&
         (!bound.at_most || value <= *bound.at_most) &&
         (!bound.equal || std::fabs(value - *bound.equal) <= bound.within);
}

/// Whether the file speaks of a contact by this bound: it asks for one, or says how deep or how
/// long it may be.
bool AllowsContact(const files::Expectation& expectation) {
  const files::ExpectParams& bound = expectation.bound;
  if (expectation.member == "min_distance") {
    return (bound.at_least && *bound.at_least < 0.0) || (bound.at_most && *bound.at_most <= 0.0) ||
           (bound.equal && *bound.equal - bound.within < 0.0);
  }
  if (expectation.member == "contact_time") {
    return (bound.at_most && *bound.at_most > 0.0) || (bound.at_least && *bound.at_least > 0.0) ||
           (bound.equal && *bound.equal + bound.within > 0.0);
  }
  return expectation.member == "first_contact_time";  // a number only if there was one
}

bool IsOfContact(const files::Expectation& expectation) {
  return expectation.member == "min_distance" || expectation.member == "contact_time";
}

/// The metrics of all arms as one: the nearest approach with its pair and time, the largest of
/// everything else.
ordered_json WorstOf(const ordered_json& one, const ordered_json& other) {
  ordered_json worst = one;
  const bool nearer = other["min_distance"].is_number() &&
                      (!one["min_distance"].is_number() ||
                       other["min_distance"].get<double>() < one["min_distance"].get<double>());
  for (const auto& [key, value] : other.items()) {
    const bool of_distance = key.starts_with("min_distance");
    if (of_distance ? nearer
                    : value.is_number() && (!worst[key].is_number() ||
                                            value.get<double>() > worst[key].get<double>())) {
      worst[key] = value;
    }
  }
  if (worst["stuck_time"] != one["stuck_time"]) worst["stuck_pair"] = other["stuck_pair"];
  const auto& first = other["first_contact_time"];
  if (first.is_number() && one["first_contact_time"].is_number()) {
    worst["first_contact_time"] =
        std::min(first.get<double>(), one["first_contact_time"].get<double>());
  }
  if (one["time_to_goal"].is_null() || other["time_to_goal"].is_null()) {
    worst["time_to_goal"] = ordered_json();  // all are there, or not
  }
  const char* const kCertified = "certified_min_distance";  // known only if it is for both
  const auto& certified = other[kCertified];
  worst[kCertified] =
      certified.is_number() && one[kCertified].is_number()
          ? ordered_json(std::min(certified.get<double>(), one[kCertified].get<double>()))
          : ordered_json();
  return worst;
}

class Runner {
 public:
  Runner(const loading::LoadedDiagram& loaded, const RunOptions& options)
      : loaded_(loaded),
        simulator_(*loaded.diagram, loaded.simulator.integration),
        duration_(options.duration.value_or(loaded.simulator.duration)) {
    simulator_.SetLog(options.log);
    const double factor = options.realtime_factor.value_or(loaded.simulator.realtime_factor);
    simulator_.SetRealtimeFactor(factor);
    result_.paced = factor > 0.0;
    if (options.profile) simulator_.EnableProfile();
    if (!options.csv_folder.empty()) {
      recorder_ = std::make_unique<SignalRecorder>(options.csv_folder, loaded, simulator_);
    }
    AddRecordedInstants();
    for (RunObserver* const observer : options.observers) {
      observer->Attach(simulator_, result_.paced, duration_);
      observers_.push_back(observer);
    }
    if (options.progress) {
      simulator_.AddMonitor([progress = options.progress](const Context& context) {
        return progress(context.time());
      });
    }
    for (const files::Expectation& expectation : loaded.expectations) {
      const double at = expectation.bound.at.value_or(duration_);
      if (at > duration_) {
        throw ConfigError(fmt::format("expect.{}.at: got {} s; expected at most the duration {} s",
                                      expectation.name, at, duration_));
      }
      result_.expectations.push_back(
          {expectation.name, std::nullopt, BoundText(expectation.bound), at, false});
    }
  }

  RunResult Run() {
    const auto start = std::chrono::steady_clock::now();
    try {
      simulator_.Initialize();
      AdvanceThroughExpectations();
    } catch (const SimulationError& error) {
      result_.failure = error.what();
    }
    result_.wall_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result_.duration = simulator_.context().time();
    result_.statistics = simulator_.statistics();
    result_.profile = simulator_.profile();
    result_.metrics = MetricsOf(loaded_, simulator_.context());
    ExpectNoContact();
    try {
      if (recorder_) recorder_->Finish();
    } catch (const ConfigError& error) {
      if (result_.failure.empty()) result_.failure = error.what();
    }
    for (RunObserver* const observer : observers_) observer->Finish(result_);
    return std::move(result_);
  }

 private:
  /// A run stops where its signals are recorded also if nobody records them, so that recording does
  /// not change a bit of it.
  void AddRecordedInstants() {
    std::vector<Period> periods;
    for (const files::RecordedSignal& signal : loaded_.record) {
      if (std::find(periods.begin(), periods.end(), signal.period) != periods.end()) continue;
      periods.push_back(signal.period);
      simulator_.AddPublish(signal.period, [](const Context&) {});
    }
  }

  void AdvanceThroughExpectations() {
    std::vector<double> stops{duration_};
    for (const auto& expectation : result_.expectations) {
      if (expectation.at < duration_) stops.push_back(expectation.at);
    }
    std::sort(stops.begin(), stops.end());
    for (const double stop : stops) {
      if (!AdvanceTo(stop)) {
        result_.interrupted = true;
        return;
      }
      CheckAt(stop);
    }
  }

  /// Without events a run is one step, after which alone an interrupt would be seen.
  bool AdvanceTo(double stop) {
    constexpr double kSlice = 1.0;  // s
    while (loaded_.diagram->schedule().groups.empty() &&
           stop - simulator_.context().time() > kSlice) {
      if (!simulator_.AdvanceTo(simulator_.context().time() + kSlice)) return false;
    }
    return simulator_.AdvanceTo(stop);
  }

  void CheckAt(double time) {
    for (std::size_t i = 0; i < loaded_.expectations.size(); ++i) {
      ExpectationResult& result = result_.expectations[i];
      if (result.at != time || result.value) continue;
      const files::Expectation& expectation = loaded_.expectations[i];
      result.value = expectation.judges.empty()
                         ? ValueOf(expectation, simulator_.context())
                         : MemberOf(MetricsOf(expectation.judges, simulator_.context()),
                                    expectation.member);
      result.ok = result.value && Holds(expectation.bound, *result.value);
    }
  }

  /// What a file expects without saying so. It is listed if it was not met, unless an expectation
  /// of the file allows a contact or says already that there was one.
  void ExpectNoContact() {
    const auto least = MemberOf(result_.metrics, "min_distance");
    if (!least || *least > 0.0) return;
    for (std::size_t i = 0; i < loaded_.expectations.size(); ++i) {
      const files::Expectation& expectation = loaded_.expectations[i];
      const bool said = IsOfContact(expectation) && !result_.expectations[i].ok;
      if (said || AllowsContact(expectation)) return;
    }
    result_.expectations.push_back({"min_distance", least,
                                    "> 0 (no contact, unless `expect` allows it)", result_.duration,
                                    false});
  }

  const loading::LoadedDiagram& loaded_;
  Simulator simulator_;
  double duration_;
  std::unique_ptr<SignalRecorder> recorder_;
  std::vector<RunObserver*> observers_;
  RunResult result_{};
};

}  // namespace

bool RunResult::ExpectationsMet() const {
  return std::all_of(expectations.begin(), expectations.end(),
                     [](const ExpectationResult& result) { return result.ok; });
}

std::string MetricsOf(const loading::LoadedDiagram& loaded, const Context& context) {
  return MetricsOf(loaded.metrics, context);
}

std::string MetricsOf(const files::NamedOutputs& judges, const Context& context) {
  ordered_json all = ordered_json::object();
  try {
    for (const auto& [name, output] : judges) {
      std::string text;
      EvalJson(output, context, text);
      const auto metrics = ordered_json::parse(text);
      all = all.empty() ? metrics : WorstOf(all, metrics);
    }
  } catch (const SimulationError&) {
    return "{}";  // what failed a run fails here again
  }
  return all.dump();
}

RunResult Run(const loading::LoadedDiagram& loaded, const RunOptions& options) {
  if (options.duration && !(*options.duration >= 0.0 && *options.duration <= 1e7)) {
    throw ConfigError(fmt::format("duration: got {} s; expected in [0, 1e7]", *options.duration));
  }
  return Runner(loaded, options).Run();
}

}  // namespace oca::runs
