// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/simulation/integration_method.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/schedule.h"
#include "oca/framework/simulation/sundials_method.h"

namespace oca {
namespace {

/// Explicit Runge-Kutta with equal steps no longer than `fixed_step` between two events.
class FixedStepIntegrator : public IntegrationMethod {
 public:
  FixedStepIntegrator(const Schedule& schedule, const IntegratorOptions& options)
      : schedule_(schedule),
        fixed_step_(options.fixed_step),
        max_steps_(options.max_steps),
        start_(schedule.continuous_size),
        at_(start_.size()),
        slope_(start_.size()),
        end_slope_(start_.size()) {}

  void Restart(Context& /*context*/, bool /*jumped*/) override { ++statistics_.restarts; }

  void IntegrateTo(Context& context, double to) override {
    const double from = context.time();
    const double count = StepsTo(from, to);
    if (!(count <= max_steps_)) {
      throw SimulationError(
          "simulator", "", from,
          fmt::format("steps to the next event; got {:g}; expected at most max_steps = {}", count,
                      max_steps_));
    }
    const double h = (to - from) / count;
    for (std::int64_t i = 0; i < static_cast<std::int64_t>(count); ++i) {
      std::copy_n(schedule_.continuous(context), start_.size(), start_.data());
      Advance(context, from + static_cast<double>(i) * h, h);
      schedule_.SetTimeAndState(context, i + 1.0 < count ? from + (i + 1.0) * h : to, at_.data());
      ++statistics_.steps;
    }
  }

  void Step(Context& context, double to) override {
    step_start_ = context.time();
    const double count = StepsTo(step_start_, to);
    step_ = (to - step_start_) / count;
    std::copy_n(schedule_.continuous(context), start_.size(), start_.data());
    Advance(context, step_start_, step_);
    Derivatives(context, count > 1.0 ? step_start_ + step_ : to, at_, end_slope_);
    ++statistics_.steps;
  }

  /// source Hairer, Norsett, Wanner 1993, section II.6: with no bulge, cubic Hermite interpolation
  void Interpolate(Context& /*context*/, double time, double* state) override {
    const double s = (time - step_start_) / step_;
    for (std::size_t k = 0; k < at_.size(); ++k) {
      const double rise = at_[k] - start_[k];
      const double entry = step_ * slope_[k] - rise;
      const double exit = rise - step_ * end_slope_[k] - entry;
      state[k] =
          start_[k] + s * (rise + (1.0 - s) * (entry + s * (exit + (1.0 - s) * Bulge(k, step_))));
    }
  }

 protected:
  /// Makes a step of `h` from start_ at `t`; the state is then in at_ and its first slope in
  /// slope_.
  virtual void Advance(Context& context, double t, double h) = 0;
  /// The quartic part of the interpolant.
  virtual double Bulge(std::size_t k, double h) const = 0;

  double StepsTo(double from, double to) const {
    // The margin keeps 0.01 s / 1 ms at ten steps although the quotient rounds up.
    return std::max(1.0, std::ceil((to - from) / fixed_step_ - 1e-9));
  }

  void Derivatives(Context& context, double t, const std::vector<double>& state,
                   std::vector<double>& derivatives) {
    schedule_.SetTimeAndState(context, t, state.data());
    schedule_.EvaluateDerivatives(context, derivatives.data());
    ++statistics_.derivative_calls;
  }

  const Schedule& schedule_;
  const double fixed_step_;
  const int max_steps_;        ///< between two events
  std::vector<double> start_;  // x at the start of a step
  std::vector<double> at_;     // argument of the next evaluation; x at the end of a step
  std::vector<double> slope_, end_slope_;  // x' at the start and the end of a step
  double step_start_{0.0}, step_{0.0};     // s; of the last Step
};

/// A method of S stages by its tableau: stage i at t + c_i h from a_ij, the result from b_j. The
/// quartic part of the interpolant is h (sum_j d_j stage_j + d_S x'(t + h)).
template <std::size_t S>
struct Tableau {
  std::array<double, S> c;
  std::array<std::array<double, S>, S> a;
  std::array<double, S> b;
  std::array<double, S + 1> d;
};

/// Kutta 1901, the classical method of order 4.
constexpr Tableau<4> kRk4{
    {0, .5, .5, 1}, {{{}, {.5}, {0, .5}, {0, 0, 1}}}, {1. / 6, 1. / 3, 1. / 3, 1. / 6}, {}};

/// Dormand and Prince 1980, J. Comput. Appl. Math. 6, the solution of order 5; d from Shampine
/// 1986, Math. Comput. 46, as in Hairer, Norsett, Wanner 1993, section II.6.
constexpr Tableau<6> kDormandPrince5{
    {0, 1. / 5, 3. / 10, 4. / 5, 8. / 9, 1},
    {{{},
      {1. / 5},
      {3. / 40, 9. / 40},
      {44. / 45, -56. / 15, 32. / 9},
      {19372. / 6561, -25360. / 2187, 64448. / 6561, -212. / 729},
      {9017. / 3168, -355. / 33, 46732. / 5247, 49. / 176, -5103. / 18656}}},
    {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84},
    {-12715105075. / 11282082432, 0, 87487479700. / 32700410799, -10690763975. / 1880347072,
     701980252875. / 199316789632, -1453857185. / 822651844, 69997945. / 29380423}};

template <std::size_t S>
class TableauIntegrator final : public FixedStepIntegrator {
 public:
  TableauIntegrator(const Schedule& schedule, const IntegratorOptions& options,
                    const Tableau<S>& tableau)
      : FixedStepIntegrator(schedule, options), tableau_(tableau) {
    for (auto& stage : later_stages_) stage.resize(start_.size());
  }

 private:
  void Advance(Context& context, double t, double h) override {
    at_ = start_;
    Derivatives(context, t, at_, slope_);
    for (std::size_t i = 1; i < S; ++i) {
      Combine(h, tableau_.a[i], i);
      Derivatives(context, t + tableau_.c[i] * h, at_, later_stages_[i - 1]);
    }
    Combine(h, tableau_.b, S);
  }

  double Bulge(std::size_t k, double h) const override {
    double sum = tableau_.d[S] * end_slope_[k];
    for (std::size_t j = 0; j < S; ++j) sum += tableau_.d[j] * Stage(j)[k];
    return h * sum;
  }

  const std::vector<double>& Stage(std::size_t j) const {
    return j == 0 ? slope_ : later_stages_[j - 1];
  }

  /// at = start + h sum_j weight_j stage_j over the first `count` stages.
  void Combine(double h, const std::array<double, S>& weights, std::size_t count) {
    const auto size = static_cast<Eigen::Index>(at_.size());
    Eigen::Map<Eigen::VectorXd> at(at_.data(), size);
    at = Eigen::Map<const Eigen::VectorXd>(start_.data(), size);
    for (std::size_t j = 0; j < count; ++j) {
      if (weights[j] == 0.0) continue;
      at += h * weights[j] * Eigen::Map<const Eigen::VectorXd>(Stage(j).data(), size);
    }
  }

  const Tableau<S> tableau_;
  std::array<std::vector<double>, S - 1> later_stages_;
};

}  // namespace

std::unique_ptr<IntegrationMethod> MakeIntegrationMethod(const Schedule& schedule,
                                                         const IntegratorOptions& options) {
  Validated(options, "simulator");
  switch (options.integrator) {
    case IntegratorKind::kFixedRk4:
      return std::make_unique<TableauIntegrator<4>>(schedule, options, kRk4);
    case IntegratorKind::kFixedDp5:
      return std::make_unique<TableauIntegrator<6>>(schedule, options, kDormandPrince5);
    // Tables by name: their defaults differ between versions of SUNDIALS.
    case IntegratorKind::kErkDp5:
      return MakeErkMethod(schedule, options, "ARKODE_DORMAND_PRINCE_7_4_5");
    case IntegratorKind::kErkBs3:
      return MakeErkMethod(schedule, options, "ARKODE_BOGACKI_SHAMPINE_4_2_3");
    case IntegratorKind::kCvodeAdams:
      return MakeCvodeMethod(schedule, options, CvodeFormulas::kAdams);
    case IntegratorKind::kCvodeBdf:
      return MakeCvodeMethod(schedule, options, CvodeFormulas::kBdf);
  }
  throw ConfigError(
      "simulator: integrator; got no such method; expected one of those that "
      "IntegratorKind names");
}

}  // namespace oca
