// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "oca/framework/dataflow/integrator_options.h"
#include "oca/framework/dataflow/period.h"
#include "tests/verification/plants.h"

namespace oca::verification {

/// x' = f(t, x, u) with an answer that is known to 15 digits.
///
/// The plants are here too, written out by hand: a solver that knows no diagram can then do the
/// same work, as a yardstick.
struct Problem {
  std::string name;
  std::string equation;
  std::string source;  ///< of the answer
  std::vector<double> initial;
  void (*derive)(double t, const double* x, double u, double* derivative);
  double end;                  ///< s
  std::vector<double> answer;  ///< the state at `end`
  bool stiff{false};           ///< only cvode_bdf can
  bool relative{false};        ///< errors count relative to each component's answer
  double absolute{1e-3};       ///< absolute tolerance for a relative tolerance of 1
  /// A control u = sample(t, x) that is held from one whole multiple of the period to the next.
  Period period{};
  double (*sample)(double t, const double* x){nullptr};
  /// The plant of product systems that this is; nullptr if a lone system is made of it.
  const PlantCase* plant{nullptr};

  double ErrorOf(const std::vector<double>& state) const;
};

/// The named problems, then the plants.
const std::vector<Problem>& Problems();
/// throws std::out_of_range if there is none of that name.
const Problem& ProblemNamed(const std::string& name);

/// What solving a problem cost and gave.
struct Outcome {
  double error;
  long steps;
  long calls;  ///< of the right-hand side
};

/// Solves it with a diagram and the Simulator.
Outcome Simulate(const Problem& problem, const IntegratorOptions& options);

/// The options of an adaptive integrator for a problem: both tolerances from the relative one.
IntegratorOptions WithTolerance(const Problem& problem, IntegratorKind kind, double relative);

/// A problem whose errors at `steps` to `4 steps` equal steps a second follow their order: small
/// enough for the leading term, large enough to stand above rounding.
struct OrderCase {
  const char* problem;
  int steps;
};
const std::vector<OrderCase>& OrderCases();
/// The binary logarithm of what halving the step gains, from `steps` a second.
double ObservedOrder(const Problem& problem, IntegratorKind kind, int steps);

}  // namespace oca::verification
