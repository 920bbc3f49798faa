// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/evaluator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/json_text.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/framework/simulation/simulator.h"

namespace oca::runs {
namespace {

using nlohmann::ordered_json;

}  // namespace

class Evaluator::Bench {
 public:
  Bench(const files::CatalogueRow& row, const Value& params, systems::ModelSet models)
      : row_(row), params_(params), models_(std::move(models)) {
    const auto probe = Make();
    stateless_ = probe->states().empty() && probe->events().empty();
    for (const auto& input : probe->inputs()) input_names_.push_back(input.name);
    for (const auto& event : probe->events()) {
      if (event.stage == System::Stage::kUpdate || event.stage == System::Stage::kReset) {
        const Period& period = event.every.period;
        if (!Ticks() || period.seconds() < period_.seconds()) period_ = period;
      }
    }
  }

  std::string Serve(const std::string& line) {
    const auto given = oca::internal::ReadJsonTree(line);
    if (!given.is_object()) throw ConfigError("got no JSON object; expected inputs by port name");
    for (const auto& [key, value] : given.items()) {
      if (key == "time" && !HasInput("time")) continue;
      if (!HasInput(key)) {
        throw ConfigError(fmt::format("no input port '{}'{}", key, DidYouMean(key, input_names_)));
      }
    }
    // A line that is refused leaves everything as it was.
    if (!simulator_) Start(given);
    const Context before = simulator_->context();
    const Clock stood = clock_;
    try {
      return Advance(given);
    } catch (...) {
      simulator_->context() = before;
      clock_ = stood;
      if (!served_) simulator_.reset();
      throw;
    }
  }

 private:
  /// Where a line stands, counted: `periods` after `start`, which is 0 for the ticks themselves.
  struct Clock {
    double start{0.0};
    std::int64_t periods{0};
  };

  /// Whether a line is a period.
  bool Ticks() const { return period_.positive(); }

  double TimeOf(const Clock& clock) const {
    return clock.start + static_cast<double>(clock.periods * period_.numerator()) /
                             static_cast<double>(period_.denominator());
  }

  /// A time that misses a tick by the rounding of who added up periods is that tick.
  Clock ClockAt(double time) const {
    constexpr double kRounding = 1e-6;  // of a period: what many sums of it may have lost
    constexpr double kExact = 9e15;     // that a double counts to
    if (!Ticks()) return {time, 0};
    const double ticks = time / period_.seconds();
    const double nearest = std::round(ticks);
    const bool on_tick = std::fabs(nearest) * static_cast<double>(period_.numerator()) <= kExact &&
                         std::fabs(ticks - nearest) <= kRounding;
    return on_tick ? Clock{0.0, static_cast<std::int64_t>(nearest)} : Clock{time, 0};
  }

  /// All ticks in between are run.
  void CheckJump(const Clock& clock) const {
    constexpr double kMostTicks = 1e7;
    const double from = served_ ? TimeOf(clock_) : 0.0;
    const double most = from + kMostTicks * period_.seconds();
    if (!Ticks() || TimeOf(clock) <= most) return;
    throw ConfigError(
        fmt::format("time: got {}; expected at most {}, 1e7 periods on", TimeOf(clock), most));
  }

  bool HasInput(const std::string& name) const {
    return std::find(input_names_.begin(), input_names_.end(), name) != input_names_.end();
  }

  std::unique_ptr<System> Make() const {
    Problems problems;
    auto system = row_.Make(params_, "", models_, problems);
    problems.Throw();
    return system;
  }

  /// The first line settles lengths that the parameters leave open.
  void Start(const ordered_json& given) {
    std::map<std::string, int> sizes;
    for (const auto& [key, value] : given.items()) {
      if (HasInput(key)) sizes[key] = value.is_array() ? static_cast<int>(value.size()) : -1;
    }
    auto system = Make();
    for (const auto& info : system->inputs()) {
      if (info.type != &kVectorType && sizes.contains(info.name)) sizes[info.name] = -1;
    }
    diagram_ = MakeDiagramOf(std::move(system), sizes);
    IntegratorOptions options;  // for comparison with other software, not for speed
    options.relative_tolerance = 1e-10;
    options.absolute_tolerance = 1e-12;
    simulator_ = std::make_unique<Simulator>(*diagram_, options);
  }

  std::string Advance(const ordered_json& given) {
    const auto time = given.find("time");
    const bool timed = time != given.end() && !HasInput("time");
    if (timed && !time->is_number()) throw ConfigError("time: expected a number of seconds");
    const Clock clock = timed ? ClockAt(time->get<double>()) : clock_;
    CheckJump(clock);
    if (timed && !served_) simulator_->context().SetTime(std::min(0.0, TimeOf(clock)));
    if (timed && Ticks() && served_) simulator_->AdvanceTo(TimeOf(clock));
    for (const auto& input : diagram_->inputs()) {
      const auto value = given.find(input.name);
      if (value == given.end()) {
        if (served_ || input.optional) continue;
        throw ConfigError(
            fmt::format("input '{}': missing; expected {}", input.name, input.type->name));
      }
      try {
        FixJson(diagram_->FindInput(input.name), simulator_->context(),
                oca::internal::JsonText(*value));
      } catch (const ConfigError& error) {
        throw ConfigError(fmt::format("{}: {}", input.name, error.what()));
      }
    }
    if (!served_) simulator_->Initialize();
    if (timed && stateless_) {
      simulator_->context().SetTime(TimeOf(clock));  // back in time, too
    } else if (timed && (!Ticks() || !served_)) {
      simulator_->AdvanceTo(TimeOf(clock));
    }
    std::vector<std::string> outputs(diagram_->outputs().size());
    Show(outputs, false);
    clock_ = clock;
    if (Ticks()) {
      ++clock_.periods;
      simulator_->AdvanceTo(TimeOf(clock_));
    }
    Show(outputs, true);
    served_ = true;
    std::string answer = "{";
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      answer +=
          fmt::format("{}\"{}\":{}", i == 0 ? "" : ",", diagram_->outputs()[i].name, outputs[i]);
    }
    return answer + "}";
  }

  /// The outputs as JSON; `after` the period only held ones anew.
  void Show(std::vector<std::string>& outputs, bool after) const {
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      const OutputHandle output = diagram_->FindOutput(diagram_->outputs()[i].name);
      if (after && !ShowsState(output)) continue;
      outputs[i].clear();
      EvalJson(output, simulator_->context(), outputs[i]);
    }
  }

  const files::CatalogueRow& row_;
  const Value params_;
  const systems::ModelSet models_;
  std::vector<std::string> input_names_;
  Period period_{};  ///< 0: nothing ticks
  Clock clock_{};
  bool stateless_{false};
  std::unique_ptr<Diagram> diagram_;
  std::unique_ptr<Simulator> simulator_;
  bool served_{false};
};

Evaluator::Evaluator(const files::CatalogueRow& row, const Value& params, systems::ModelSet models)
    : bench_(std::make_unique<Bench>(row, params, std::move(models))) {}
Evaluator::~Evaluator() = default;
std::string Evaluator::Serve(const std::string& line) { return bench_->Serve(line); }

}  // namespace oca::runs
