// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/simulation/sundials_method.h"

#include <fmt/format.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/params.h"
#include "oca/framework/simulation/stiffness.h"
#include "oca/framework/simulation/sundials_vector.h"

namespace oca {
namespace {

/// In a row, of one step. A kink in a right-hand side, as at a joint's stop, takes more than the 7
/// that SUNDIALS allows.
constexpr int kMostRejections = 40;

}  // namespace

SundialsMethod::SundialsMethod(const SundialsFamily& family, const Schedule& schedule,
                               const IntegratorOptions& options)
    : schedule_(schedule),
      state_(schedule.continuous_size),
      family_(family),
      relative_(schedule.continuous_size, options.relative_tolerance),
      absolute_(schedule.continuous_size, options.absolute_tolerance),
      max_steps_(options.max_steps) {
  SetTolerances(options);
#if SUNDIALS_VERSION_MAJOR >= 7
  SUNContext_Create(SUN_COMM_NULL, &sundials_);
  SUNContext_ClearErrHandlers(sundials_);
  SUNContext_PushErrHandler(
      sundials_, [](int, const char*, const char*, const char*, SUNErrCode, void*, SUNContext) {},
      nullptr);
#else
  SUNContext_Create(nullptr, &sundials_);
#endif
  const auto size = static_cast<sunindextype>(state_.size());
  y_ = internal::MakeSerialVector(size, state_.data(), sundials_);
  between_ = internal::MakeSerialVector(size, nullptr, sundials_);
}

SundialsMethod::~SundialsMethod() {
  if (y_ != nullptr) N_VDestroy(y_);
  if (between_ != nullptr) N_VDestroy(between_);
  SUNContext_Free(&sundials_);
}

void SundialsMethod::SetTolerances(const IntegratorOptions& options) {
  std::vector<std::string> used;
  for (const auto& derivative : schedule_.derivatives) {
    const auto found = options.tolerances.find(schedule_.PathOf(*derivative.system));
    if (found == options.tolerances.end()) continue;
    used.push_back(found->first);
    Validated(found->second, "simulator_tolerances." + found->first);
    const std::size_t begin =
        (derivative.out.offset - schedule_.derivative_offset) / sizeof(double);
    std::fill_n(relative_.begin() + begin, derivative.out.size, found->second.relative);
    std::fill_n(absolute_.begin() + begin, derivative.out.size, found->second.absolute);
  }
  for (const auto& [path, tolerances] : options.tolerances) {
    if (std::find(used.begin(), used.end(), path) != used.end()) continue;
    throw ConfigError(fmt::format(
        "simulator: tolerances; got '{}'; expected a system with continuous state", path));
  }
}

void SundialsMethod::SetUp(const IntegratorOptions& options) {
  if (memory_ == nullptr) {
    throw SimulationError("simulator", "", 0.0,
                          fmt::format("{}Create failed with no memory", family_.prefix));
  }
  Check(family_.set_user_data(memory_, this), "SetUserData");
#if SUNDIALS_VERSION_MAJOR < 7
  family_.set_error_handler(
      memory_, [](int, const char*, const char*, char*, void*) {}, nullptr);
#endif
  Check(family_.set_weights(memory_, ErrorWeights), "WFtolerances");
  Check(family_.set_most_steps(memory_, options.max_steps), "SetMaxNumSteps");
  Check(family_.set_most_rejections(memory_, kMostRejections), "SetMaxErrTestFails");
  if (std::isfinite(options.max_step)) {
    Check(family_.set_max_step(memory_, options.max_step), "SetMaxStep");
  }
}

void SundialsMethod::WarmUp() {
  if (state_.empty()) return;
  double reached = 0.0;
  Check(family_.evolve(memory_, 1.0, y_, &reached, family_.one_step), family_.evolve_call);
  ForgetCounters();
  statistics_ = {};
}

void SundialsMethod::LoadState(Context& context) {
  context_ = &context;
  std::copy_n(schedule_.continuous(context), state_.size(), state_.data());
}

void SundialsMethod::Interpolate(Context& context, double time, double* state) {
  context_ = &context;
  N_VSetArrayPointer(state, between_);
  Check(family_.interpolate(memory_, time, 0, between_), "GetDky");
}

void SundialsMethod::Evolve(Context& context, double to, int mode) {
  context_ = &context;
  Check(family_.set_stop_time(memory_, to), "SetStopTime");
  double reached = from_ = context.time();
  const int flag = family_.evolve(memory_, to, y_, &reached, mode);
  CountAll();
  Check(flag, family_.evolve_call);
  schedule_.SetTimeAndState(context, mode == family_.normal ? to : reached, state_.data());
  Evolved(context);
}

void SundialsMethod::CountAll() {
  Counters now;
  family_.count_steps(memory_, &now.steps);
  family_.count_rejections(memory_, &now.rejected);
  family_.count_derivatives(memory_, &now.derivative_calls);
  statistics_.steps += now.steps - counted_.steps;
  statistics_.rejected_steps += now.rejected - counted_.rejected;
  statistics_.derivative_calls += now.derivative_calls - counted_.derivative_calls;
  counted_ = now;
}

int SundialsMethod::RightHandSide(sunrealtype t, N_Vector y, N_Vector ydot, void* self) {
  auto& integrator = *static_cast<SundialsMethod*>(self);
  // SUNDIALS may retry hundreds of times after a failure.
  if (integrator.failure_) return -1;
  if (integrator.context_ == nullptr) {  // warming up
    N_VConst(0.0, ydot);
    return 0;
  }
  try {
    integrator.schedule_.SetTimeAndState(*integrator.context_, t, NV_DATA_S(y));
    integrator.schedule_.EvaluateDerivatives(*integrator.context_, NV_DATA_S(ydot));
    return 0;
  } catch (...) {
    integrator.failure_ = std::current_exception();
    return -1;
  }
}

int SundialsMethod::ErrorWeights(N_Vector y, N_Vector weights, void* self) {
  const auto& integrator = *static_cast<const SundialsMethod*>(self);
  const double* x = NV_DATA_S(y);
  double* w = NV_DATA_S(weights);
  for (std::size_t i = 0; i < integrator.state_.size(); ++i) {
    w[i] = 1.0 / (integrator.relative_[i] * std::fabs(x[i]) + integrator.absolute_[i]);
  }
  return 0;
}

int SundialsMethod::DenseJacobian(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix jacobian,
                                  void* self, N_Vector moved, N_Vector f_moved,
                                  N_Vector /*unused*/) {
  auto& integrator = *static_cast<SundialsMethod*>(self);
  const double root_epsilon = std::sqrt(std::numeric_limits<double>::epsilon());
  double* x = NV_DATA_S(moved);
  const double* f = NV_DATA_S(fy);
  const double* f_of_x = NV_DATA_S(f_moved);
  const std::size_t n = integrator.state_.size();
  std::copy_n(NV_DATA_S(y), n, x);
  for (std::size_t j = 0; j < n; ++j) {
    const double at = x[j];
    const double typical = integrator.absolute_[j] / integrator.relative_[j];
    x[j] += root_epsilon * std::max(std::fabs(at), typical);
    const double increment = x[j] - at;  // as it was rounded
    if (const int flag = RightHandSide(t, moved, f_moved, self); flag != 0) return flag;
    double* column = SUNDenseMatrix_Column(jacobian, static_cast<sunindextype>(j));
    for (std::size_t i = 0; i < n; ++i) column[i] = (f_of_x[i] - f[i]) / increment;
    x[j] = at;
  }
  integrator.statistics_.derivative_calls += static_cast<std::int64_t>(n);
  return 0;
}

void SundialsMethod::Fail(int flag, const char* call) {
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  char* const name = family_.flag_name(flag);
  const std::string text = name == nullptr ? "an unknown error" : name;
  std::free(name);
  const double time = context_ == nullptr ? 0.0 : context_->time();
  throw SimulationError("simulator", "", time,
                        text.ends_with("TOO_MUCH_WORK")
                            ? TooManySteps(time)
                            : fmt::format("{}{} failed with {}", family_.prefix, call, text));
}

std::string SundialsMethod::TooManySteps(double time) {
  const double step = (time - from_) / max_steps_;  // on average
  const double rate = internal::FastestRate(state_, [&](const double* x, double* derivative) {
    try {
      schedule_.SetTimeAndState(*context_, time, x);
      schedule_.EvaluateDerivatives(*context_, derivative);
      return true;
    } catch (const std::exception&) {
      return false;
    }
  });
  if (step * rate > LargestReach()) {
    return fmt::format(
        "stiff system; got a fastest rate of {:.3g} 1/s, which holds the steps to {:.3g} s, and "
        "no event within max_steps = {}; expected the integrator cvode_bdf",
        rate, step, max_steps_);
  }
  return fmt::format(
      "steps to the next event; got more than max_steps = {}, of {:.3g} s on average; expected a "
      "larger max_steps or looser tolerances",
      max_steps_, step);
}

}  // namespace oca
