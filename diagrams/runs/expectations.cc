// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/expectations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/signal_shape.h"

namespace oca::runs {
namespace {

using systems::MotionMetricsValue;

/// Those that an expectation is about, if it is about metrics.
std::optional<MotionMetricsValue> MetricsOf(const files::Expectation& expectation,
                                            const Context& context) {
  if (!expectation.judges.empty()) return MetricsOfAll(JudgementsOf(expectation.judges, context));
  if (expectation.member.empty()) return std::nullopt;
  if (&TypeOfPort(expectation.output) != &TypeOf<MotionMetricsValue>()) return std::nullopt;
  return *static_cast<const MotionMetricsValue*>(EvalObject(expectation.output, context));
}

std::optional<double> ValueOf(const files::Expectation& expectation, const Context& context) {
  const auto metrics = MetricsOf(expectation, context);
  if (metrics) return systems::NumberIn(*metrics, expectation.member);
  if (!expectation.judges.empty()) return std::nullopt;
  if (expectation.member.empty()) {
    return EvalVector(expectation.output, context)[static_cast<std::size_t>(expectation.index)];
  }
  return MemberNumber(TypeOfPort(expectation.output), EvalObject(expectation.output, context),
                      expectation.member);
}

/// A proved lower bound of a least distance that nobody measured, for nothing came within reach.
std::optional<double> ProvedOf(const files::Expectation& expectation, const Context& context) {
  if (expectation.member != "min_distance") return std::nullopt;
  const auto metrics = MetricsOf(expectation, context);
  return metrics ? metrics->certified_min_distance : std::nullopt;
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

/// Links of several arms may have the same names: `left/lwr4_link_6`, as judged by left.metrics.
MotionMetricsValue WithItsArm(const Judgement& judgement) {
  const std::string arm = judgement.judge.substr(0, judgement.judge.rfind('.'));
  MotionMetricsValue metrics = judgement.metrics;
  for (models::Name* const link : {&metrics.min_distance_link, &metrics.stuck_link}) {
    if (!link->empty()) *link = models::Name(fmt::format("{}/{}", arm, link->text()));
  }
  return metrics;
}

}  // namespace

std::optional<MotionMetricsValue> MetricsOfAll(const std::vector<Judgement>& judgements) {
  if (judgements.size() == 1) return judgements[0].metrics;
  std::optional<MotionMetricsValue> worst;
  for (const Judgement& one : judgements) {
    const MotionMetricsValue metrics = WithItsArm(one);
    worst = worst ? systems::WorstOf(*worst, metrics) : metrics;
  }
  return worst;
}

ExpectationCheck::ExpectationCheck(const loading::LoadedDiagram& loaded, double duration)
    : stops_{duration} {
  for (const files::Expectation& expectation : loaded.expectations) {
    const double at = expectation.bound.at.value_or(duration);
    if (at > duration) {
      throw ConfigError(fmt::format("expect.{}.at: got {} s; expected at most the duration {} s",
                                    expectation.name, at, duration));
    }
    results_.push_back({expectation.name, std::nullopt, BoundText(expectation.bound), at, false});
    if (at < duration) stops_.push_back(at);
  }
  std::sort(stops_.begin(), stops_.end());
}

void ExpectationCheck::CheckAt(double stop, const loading::LoadedDiagram& loaded,
                               const Context& context) {
  for (std::size_t i = 0; i < results_.size(); ++i) {
    ExpectationResult& result = results_[i];
    if (result.at != stop || result.value) continue;
    result.value = ValueOf(loaded.expectations[i], context);
    const files::ExpectParams& bound = loaded.expectations[i].bound;
    result.ok = result.value && Holds(bound, *result.value);
    if (result.value || bound.at_most || bound.equal) continue;
    const auto proved = ProvedOf(loaded.expectations[i], context);
    if (!proved || *proved < *bound.at_least) continue;
    result.value = proved;
    result.bound += ", proved by certified_min_distance";
    result.ok = true;
  }
}

std::vector<ExpectationResult> ExpectationCheck::Finish(
    const loading::LoadedDiagram& loaded, const std::optional<MotionMetricsValue>& metrics,
    double end) {
  std::vector<ExpectationResult> all = results_;
  const auto least = metrics ? metrics->min_distance : std::nullopt;
  if (!least || *least > 0.0) return all;
  for (std::size_t i = 0; i < results_.size(); ++i) {
    const files::Expectation& expectation = loaded.expectations[i];
    const bool said = IsOfContact(expectation) && !results_[i].ok;
    if (said || AllowsContact(expectation)) return all;
  }
  all.push_back({"min_distance", least, "> 0 (no contact, unless `expect` allows it)", end, false});
  return all;
}

}  // namespace oca::runs
