// SPDX-License-Identifier: BSD-3-Clause
#include "framework/integrator.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "framework/error.h"
#include "framework/plan.h"
#include "framework/sundials_integrator.h"

namespace oca {
namespace {

void CheckPositive(double value, const char* name) {
  if (!(value > 0.0)) {
    throw ConfigError(fmt::format("simulator: {}; got {}; expected > 0", name, value));
  }
}

/// Explicit Runge-Kutta with equal steps no longer than `fixed_step` between two events.
class FixedStepIntegrator : public Integrator {
 public:
  FixedStepIntegrator(const Plan& plan, double fixed_step)
      : plan_(plan), fixed_step_(fixed_step), start_(plan.continuous_size), at_(start_.size()) {}

  void Restart(Context& /*context*/, bool /*jumped*/) override { ++statistics_.restarts; }

  void IntegrateTo(Context& context, double to) override {
    const double from = context.time();
    // The margin keeps 0.01 s / 1 ms at ten steps although the quotient rounds up.
    const double count = std::max(1.0, std::ceil((to - from) / fixed_step_ - 1e-9));
    const double h = (to - from) / count;
    for (double i = 0.0; i < count; ++i) {
      std::copy_n(plan_.continuous(context), start_.size(), start_.data());
      Step(context, from + i * h, h);
      plan_.SetTimeAndState(context, i + 1.0 < count ? from + (i + 1.0) * h : to, at_.data());
      ++statistics_.steps;
    }
  }

 protected:
  virtual void Step(Context& context, double t, double h) = 0;

  void Derivatives(Context& context, double t, const std::vector<double>& state,
                   std::vector<double>& derivatives) {
    plan_.SetTimeAndState(context, t, state.data());
    plan_.EvaluateDerivatives(context, derivatives.data());
    ++statistics_.derivative_calls;
  }

  const Plan& plan_;
  const double fixed_step_;
  std::vector<double> start_;  // x at the start of a step
  std::vector<double> at_;     // argument of the next evaluation; x at the end of a step
};

/// A method of S stages by its tableau: stage i at t + c_i h from a_ij, the result from b_j.
template <std::size_t S>
struct Tableau {
  std::array<double, S> c;
  std::array<std::array<double, S>, S> a;
  std::array<double, S> b;
};

/// Kutta 1901, the classical method of order 4.
constexpr Tableau<4> kRk4{
    {0, .5, .5, 1}, {{{}, {.5}, {0, .5}, {0, 0, 1}}}, {1. / 6, 1. / 3, 1. / 3, 1. / 6}};

/// Dormand and Prince 1980, J. Comput. Appl. Math. 6, the solution of order 5.
constexpr Tableau<6> kDormandPrince5{
    {0, 1. / 5, 3. / 10, 4. / 5, 8. / 9, 1},
    {{{},
      {1. / 5},
      {3. / 40, 9. / 40},
      {44. / 45, -56. / 15, 32. / 9},
      {19372. / 6561, -25360. / 2187, 64448. / 6561, -212. / 729},
      {9017. / 3168, -355. / 33, 46732. / 5247, 49. / 176, -5103. / 18656}}},
    {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84}};

template <std::size_t S>
class TableauIntegrator final : public FixedStepIntegrator {
 public:
  TableauIntegrator(const Plan& plan, double fixed_step, const Tableau<S>& tableau)
      : FixedStepIntegrator(plan, fixed_step), tableau_(tableau) {
    for (auto& stage : stages_) stage.resize(start_.size());
  }

 private:
  void Step(Context& context, double t, double h) override {
    for (std::size_t i = 0; i < S; ++i) {
      Combine(h, tableau_.a[i], i);
      Derivatives(context, t + tableau_.c[i] * h, at_, stages_[i]);
    }
    Combine(h, tableau_.b, S);
  }

  /// at = start + h sum_j weight_j stage_j over the first `count` stages.
  void Combine(double h, const std::array<double, S>& weights, std::size_t count) {
    at_ = start_;
    for (std::size_t j = 0; j < count; ++j) {
      if (weights[j] == 0.0) continue;
      const double weight = h * weights[j];
      for (std::size_t k = 0; k < at_.size(); ++k) at_[k] += weight * stages_[j][k];
    }
  }

  const Tableau<S> tableau_;
  std::array<std::vector<double>, S> stages_;
};

}  // namespace

std::span<const char* const> EnumNames(IntegratorKind) {
  static constexpr const char* kNames[] = {"erk_dp5",   "erk_bs3",   "cvode_adams",
                                           "cvode_bdf", "fixed_dp5", "fixed_rk4"};
  return kNames;
}

std::unique_ptr<Integrator> MakeIntegrator(const Plan& plan, const IntegratorOptions& options) {
  CheckPositive(options.relative_tolerance, "relative_tolerance");
  CheckPositive(options.absolute_tolerance, "absolute_tolerance");
  CheckPositive(options.max_step, "max_step");
  CheckPositive(options.fixed_step, "fixed_step");
  CheckPositive(options.max_steps, "max_steps");
  switch (options.integrator) {
    case IntegratorKind::kFixedRk4:
      return std::make_unique<TableauIntegrator<4>>(plan, options.fixed_step, kRk4);
    case IntegratorKind::kFixedDp5:
      return std::make_unique<TableauIntegrator<6>>(plan, options.fixed_step, kDormandPrince5);
    default:
      return MakeSundialsIntegrator(plan, options);
  }
}

}  // namespace oca
