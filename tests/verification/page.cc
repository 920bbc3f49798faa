// SPDX-License-Identifier: BSD-3-Clause
#include "tests/verification/page.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <vector>

#include "tests/verification/problems.h"
#include "tests/verification/work_precision_figure.h"
#include "tests/verification/yardstick.h"

namespace oca::verification {
namespace {

struct Method {
  IntegratorKind kind;
  const char* colour;
};
constexpr Method kAdaptive[] = {{IntegratorKind::kErkDp5, "#1f77b4"},
                                {IntegratorKind::kErkBs3, "#2ca02c"},
                                {IntegratorKind::kCvodeAdams, "#d62728"},
                                {IntegratorKind::kCvodeBdf, "#9467bd"}};
constexpr Method kFixed[] = {{IntegratorKind::kFixedDp5, "#17becf"},
                             {IntegratorKind::kFixedRk4, "#ff7f0e"}};

const char* NameOf(IntegratorKind kind) { return EnumNames(kind)[static_cast<std::size_t>(kind)]; }

bool Suits(const Problem& problem, IntegratorKind kind) {
  return !problem.stiff || kind == IntegratorKind::kCvodeBdf;
}

constexpr const char* kHead = R"(# What the integrators reach

Made by `build/release/tests/verification/verification_page tests/verification`, which writes this page and the figure; a test
compares both with what the command gives. References hold to 15 digits, from the source named. `error` is the largest over the
components of the state at the end (of `robertson` relative to each component), `SUNDIALS` the error that ERKStep or CVODE reach
when called directly, without diagram and simulator, with the same tolerance or step; the absolute tolerance is a thousandth of
the relative one (of `robertson` 1e-8 of it). `calls` are right-hand-side calls. The tests hold each error to five times that of
SUNDIALS.

![Error against right-hand-side calls](work_precision.svg)

A line is an integrator of ours over the tolerances 1e-3 to 1e-11 (with equal steps: 10 to 1280 a second), a circle SUNDIALS
itself.

## Problems

| problem | equation | to t = | reference from |
|---|---|---|---|
)";

void AddProblems(std::string& page) {
  for (const Problem& problem : Problems()) {
    fmt::format_to(std::back_inserter(page), "| {} | {} | {} | {} |\n", problem.name,
                   problem.equation, problem.end, problem.source);
  }
}

void AddRow(std::string& page, const Problem& problem, const IntegratorOptions& options,
            const std::string& setting) {
  const Outcome ours = Simulate(problem, options);
  const Outcome theirs = Measure(problem, options);
  fmt::format_to(std::back_inserter(page), "| {} | {} | {} | {:.1e} | {:.1e} | {} | {} | {} |\n",
                 problem.name, NameOf(options.integrator), setting, ours.error, theirs.error,
                 ours.steps, ours.calls, theirs.calls);
}

void AddAdaptive(std::string& page) {
  page += R"(
## With error control

| problem | integrator | tolerance | error | SUNDIALS | steps | calls | calls of SUNDIALS |
|---|---|---|---|---|---|---|---|
)";
  for (const Problem& problem : Problems()) {
    for (const Method& method : kAdaptive) {
      if (!Suits(problem, method.kind)) continue;
      for (const double tolerance : {1e-6, 1e-9}) {
        AddRow(page, problem, WithTolerance(problem, method.kind, tolerance),
               fmt::format("{:.0e}", tolerance));
      }
    }
  }
}

void AddFixed(std::string& page) {
  page += R"(
## With equal steps

| problem | integrator | step | error | SUNDIALS | steps | calls | calls of SUNDIALS |
|---|---|---|---|---|---|---|---|
)";
  for (const Problem& problem : Problems()) {
    for (const Method& method : kFixed) {
      if (!Suits(problem, method.kind)) continue;
      for (const double step : {1e-2, 1e-3}) {
        AddRow(page, problem, {.integrator = method.kind, .fixed_step = step},
               fmt::format("{}", step));
      }
    }
  }
}

void AddOrders(std::string& page) {
  page += R"(
## Observed order

The binary logarithm of what halving the step gains, from the given number of steps a second and from twice as many; 5 is expected
of fixed_dp5 and 4 of fixed_rk4. The number is chosen so that errors are small enough to follow their order and stand above rounding.

| problem | integrator | steps a second | order | at twice as many |
|---|---|---|---|---|
)";
  for (const auto& [name, steps] : OrderCases()) {
    const Problem& problem = ProblemNamed(name);
    for (const Method& method : kFixed) {
      fmt::format_to(std::back_inserter(page), "| {} | {} | {} | {:.2f} | {:.2f} |\n", name,
                     NameOf(method.kind), steps, ObservedOrder(problem, method.kind, steps),
                     ObservedOrder(problem, method.kind, 2 * steps));
    }
  }
}

WorkPrecisionFigure::Curve CurveOf(const Problem& problem, const Method& method,
                                   const std::vector<IntegratorOptions>& settings) {
  WorkPrecisionFigure::Curve curve{NameOf(method.kind), method.colour, {}, {}};
  for (const IntegratorOptions& options : settings) {
    const Outcome ours = Simulate(problem, options);
    const Outcome theirs = Measure(problem, options);
    curve.points.push_back({static_cast<double>(ours.calls), ours.error});
    curve.marks.push_back({static_cast<double>(theirs.calls), theirs.error});
  }
  return curve;
}

}  // namespace

std::string MakePage() {
  std::string page = kHead;
  AddProblems(page);
  AddAdaptive(page);
  AddFixed(page);
  AddOrders(page);
  return page;
}

std::string MakeFigure() {
  WorkPrecisionFigure figure;
  for (const Problem& problem : Problems()) {
    if (problem.plant != nullptr || problem.name == "pendulum_period") continue;
    WorkPrecisionFigure::Panel panel{problem.name, {}};
    for (const Method& method : kAdaptive) {
      if (!Suits(problem, method.kind)) continue;
      std::vector<IntegratorOptions> settings;
      for (int digits = 3; digits <= 11; ++digits) {
        settings.push_back(WithTolerance(problem, method.kind, std::pow(10.0, -digits)));
      }
      panel.curves.push_back(CurveOf(problem, method, settings));
    }
    for (const Method& method : kFixed) {
      if (!Suits(problem, method.kind)) continue;
      std::vector<IntegratorOptions> settings;
      for (int steps = 10; steps <= 1280; steps *= 2) {
        settings.push_back({.integrator = method.kind, .fixed_step = 1.0 / steps});
      }
      panel.curves.push_back(CurveOf(problem, method, settings));
    }
    figure.Add(std::move(panel));
  }
  return figure.Svg();
}

}  // namespace oca::verification
