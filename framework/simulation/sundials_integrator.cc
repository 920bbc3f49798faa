// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/simulation/sundials_integrator.h"

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <fmt/format.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/schedule.h"
#include "oca/framework/simulation/stiffness.h"
#include "oca/framework/simulation/sundials_vector.h"

namespace oca {
namespace {

/// In a row, of one step. A kink in a right-hand side, as at a joint's stop, takes more than the 7
/// that SUNDIALS allows.
constexpr int kMostRejections = 40;

/// What both families share: the vector, the tolerances, and the right-hand side.
class SundialsIntegrator : public Integrator {
 public:
  SundialsIntegrator(const Schedule& schedule, const IntegratorOptions& options)
      : schedule_(schedule),
        relative_(schedule.continuous_size, options.relative_tolerance),
        absolute_(schedule.continuous_size, options.absolute_tolerance),
        state_(schedule.continuous_size),
        max_steps_(options.max_steps) {
    SetTolerances(options);
#if SUNDIALS_VERSION_MAJOR >= 7
    SUNContext_Create(SUN_COMM_NULL, &sundials_);
    SUNContext_ClearErrHandlers(sundials_);
    SUNContext_PushErrHandler(
        sundials_, [](int, const char*, const char*, const char*, SUNErrCode, void*, SUNContext){},
        nullptr);
#else
    SUNContext_Create(nullptr, &sundials_);
#endif
    const auto size = static_cast<sunindextype>(state_.size());
    y_ = internal::MakeSerialVector(size, state_.data(), sundials_);
    between_ = internal::MakeSerialVector(size, nullptr, sundials_);
  }
  ~SundialsIntegrator() override {
    if (y_ != nullptr) N_VDestroy(y_);
    if (between_ != nullptr) N_VDestroy(between_);
    SUNContext_Free(&sundials_);
  }

 protected:
  /// Counters that SUNDIALS keeps and sets to zero at a restart.
  struct Counters {
    long steps{0}, rejected{0}, derivative_calls{0};
  };
  virtual Counters ReadCounters() const = 0;

  void LoadState(Context& context) {
    context_ = &context;
    std::copy_n(schedule_.continuous(context), state_.size(), state_.data());
  }

  void CountAll() {
    const Counters now = ReadCounters();
    statistics_.steps += now.steps - counted_.steps;
    statistics_.rejected_steps += now.rejected - counted_.rejected;
    statistics_.derivative_calls += now.derivative_calls - counted_.derivative_calls;
    counted_ = now;
  }
  void ForgetCounters() {
    counted_ = {};
    ++statistics_.restarts;
  }

  static int RightHandSide(sunrealtype t, N_Vector y, N_Vector ydot, void* self) {
    auto& integrator = *static_cast<SundialsIntegrator*>(self);
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

  static int ErrorWeights(N_Vector y, N_Vector weights, void* self) {
    const auto& integrator = *static_cast<const SundialsIntegrator*>(self);
    const double* x = NV_DATA_S(y);
    double* w = NV_DATA_S(weights);
    for (std::size_t i = 0; i < integrator.state_.size(); ++i) {
      w[i] = 1.0 / (integrator.relative_[i] * std::fabs(x[i]) + integrator.absolute_[i]);
    }
    return 0;
  }

  /// Forward differences, column by column. SUNDIALS has its own, which takes memory from the heap
  /// for every Jacobian.
  ///
  /// source Dennis and Schnabel 1983, section 5.4: increments of sqrt(epsilon) times the size of
  ///        the state, which is typically no less than where the absolute tolerance takes over
  static int DenseJacobian(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix jacobian, void* self,
                           N_Vector moved, N_Vector f_moved, N_Vector /*unused*/) {
    auto& integrator = *static_cast<SundialsIntegrator*>(self);
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

  /// Rethrows what a calculation threw; otherwise turns a negative flag into an error.
  void Check(int flag, const char* call, const char* name) {
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    if (flag >= 0) return;
    const double time = context_ == nullptr ? 0.0 : context_->time();
    throw SimulationError("simulator", "", time,
                          std::string_view(name).ends_with("TOO_MUCH_WORK")
                              ? TooManySteps(time)
                              : fmt::format("{} failed with {}", call, name));
  }

  /// Largest step times fastest rate that accuracy alone asks for; above it the step is held by
  /// stability.
  virtual double LargestReach() const = 0;

  /// Says whether it is the system that is stiff or the limit that is low.
  std::string TooManySteps(double time) {
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

  const Schedule& schedule_;
  std::vector<double> relative_, absolute_;
  std::vector<double> state_;  // y_ lies over it
  const int max_steps_;        // between two events
  double from_{0.0};           // s; where the present integration started
  SUNContext sundials_{nullptr};
  N_Vector y_{nullptr};
  N_Vector between_{nullptr};  // for interpolation; lies over what the caller gives
  Context* context_{nullptr};
  std::exception_ptr failure_;
  Counters counted_;

 private:
  void SetTolerances(const IntegratorOptions& options) {
    std::vector<std::string> used;
    for (const auto& derivative : schedule_.derivatives) {
      const auto found = options.tolerances.find(schedule_.PathOf(*derivative.system));
      if (found == options.tolerances.end()) continue;
      used.push_back(found->first);
      if (!(found->second.relative > 0.0) || !(found->second.absolute > 0.0)) {
        throw ConfigError(fmt::format("simulator: tolerances of {}; got {} and {}; expected > 0",
                                      found->first, found->second.relative,
                                      found->second.absolute));
      }
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
};

#if SUNDIALS_VERSION_MAJOR < 7
void Silence(int, const char*, const char*, char*, void*) {}
#endif

/// ARKODE's explicit Runge-Kutta with error control.
class ErkIntegrator final : public SundialsIntegrator {
 public:
  ErkIntegrator(const Schedule& schedule, const IntegratorOptions& options, const char* table)
      : SundialsIntegrator(schedule, options) {
    memory_ = ERKStepCreate(RightHandSide, 0.0, y_, sundials_);
    if (memory_ == nullptr) Check(-1, "ERKStepCreate", "no memory");
    static_cast<void>(ERKStepSetUserData(memory_, static_cast<SundialsIntegrator*>(this)));
#if SUNDIALS_VERSION_MAJOR < 7
    ERKStepSetErrHandlerFn(memory_, Silence, nullptr);
#endif
    CheckFlag(ERKStepWFtolerances(memory_, ErrorWeights), "ERKStepWFtolerances");
    CheckFlag(ERKStepSetTableName(memory_, table), "ERKStepSetTableName");
    CheckFlag(ERKStepSetMaxNumSteps(memory_, options.max_steps), "ERKStepSetMaxNumSteps");
    CheckFlag(ERKStepSetMaxErrTestFails(memory_, kMostRejections), "ERKStepSetMaxErrTestFails");
    if (std::isfinite(options.max_step)) {
      CheckFlag(ERKStepSetMaxStep(memory_, options.max_step), "ERKStepSetMaxStep");
    }
    // Every step ends with an interpolation at its end, which a straight line gives as exactly.
    if (schedule.witnesses.empty()) {
      CheckFlag(ERKStepSetInterpolantDegree(memory_, 1), "ERKStepSetInterpolantDegree");
    }
    WarmUp();
  }
  ~ErkIntegrator() override { ERKStepFree(&memory_); }

  void Restart(Context& context, bool jumped) override {
    LoadState(context);
    // What follows must depend on the Context alone, so that a resumed run gives the same bits: the
    // step is the one that the Context keeps, and the controller looks at no earlier errors.
    const double step = jumped ? 0.0 : schedule_.integrator_step(context);
    schedule_.integrator_step(context) = step;
    // A long integration has the controller that SUNDIALS prefers, which looks at two errors.
    const int controller = step == 0.0 ? ARK_ADAPT_PI : ARK_ADAPT_I;
    if (controller != controller_) {
      CheckFlag(ERKStepSetAdaptivityMethod(memory_, controller, 1, 0, nullptr),
                "ERKStepSetAdaptivityMethod");
      controller_ = controller;
    }
    if (step == 0.0) {
      CheckFlag(ERKStepReInit(memory_, RightHandSide, context.time(), y_), "ERKStepReInit");
      counted_ = {};
    } else {
      CheckFlag(ERKStepReset(memory_, context.time(), y_), "ERKStepReset");
    }
    CheckFlag(ERKStepSetInitStep(memory_, step), "ERKStepSetInitStep");
    ++statistics_.restarts;
  }

  void IntegrateTo(Context& context, double to) override { Evolve(context, to, ARK_NORMAL); }

  void Step(Context& context, double to) override { Evolve(context, to, ARK_ONE_STEP); }

  void Interpolate(Context& context, double time, double* state) override {
    context_ = &context;
    N_VSetArrayPointer(state, between_);
    CheckFlag(ERKStepGetDky(memory_, time, 0, between_), "ERKStepGetDky");
  }

 protected:
  Counters ReadCounters() const override {
    Counters counters;
    ERKStepGetNumSteps(memory_, &counters.steps);
    ERKStepGetNumErrTestFails(memory_, &counters.rejected);
    ERKStepGetNumRhsEvals(memory_, &counters.derivative_calls);
    return counters;
  }
  // The methods are stable on the negative axis to 3.3 (Dormand-Prince) and 2.5 (Bogacki-Shampine).
  double LargestReach() const override { return 2.0; }

 private:
  void Evolve(Context& context, double to, int mode) {
    context_ = &context;
    CheckFlag(ERKStepSetStopTime(memory_, to), "ERKStepSetStopTime");
    double reached = from_ = context.time();
    const int flag = ERKStepEvolve(memory_, to, y_, &reached, mode);
    CountAll();
    CheckFlag(flag, "ERKStepEvolve");
    schedule_.SetTimeAndState(context, mode == ARK_NORMAL ? to : reached, state_.data());
    double next = 0.0;
    ERKStepGetCurrentStep(memory_, &next);
    schedule_.integrator_step(context) = next;
  }

  /// The first step takes memory; it is made here, at rest, so that no later one does.
  void WarmUp() {
    if (state_.empty()) return;
    double reached = 0.0;
    CheckFlag(ERKStepEvolve(memory_, 1.0, y_, &reached, ARK_ONE_STEP), "ERKStepEvolve");
    ForgetCounters();
    statistics_ = {};
  }

  void CheckFlag(int flag, const char* call) {
    if (flag >= 0 && !failure_) return;
    char* name = ERKStepGetReturnFlagName(flag);
    const std::string text = name == nullptr ? "an unknown error" : name;
    std::free(name);
    Check(flag, call, text.c_str());
  }

  void* memory_{nullptr};
  int controller_{-1};
};

/// CVODE: Adams with fixed-point iteration, or BDF with Newton and a dense Jacobian.
class CvodeIntegrator final : public SundialsIntegrator {
 public:
  CvodeIntegrator(const Schedule& schedule, const IntegratorOptions& options, int method)
      : SundialsIntegrator(schedule, options) {
    memory_ = CVodeCreate(method, sundials_);
    if (memory_ == nullptr) Check(-1, "CVodeCreate", "no memory");
    CVodeSetUserData(memory_, static_cast<SundialsIntegrator*>(this));
#if SUNDIALS_VERSION_MAJOR < 7
    CVodeSetErrHandlerFn(memory_, Silence, nullptr);
#endif
    CheckFlag(CVodeInit(memory_, RightHandSide, 0.0, y_), "CVodeInit");
    CheckFlag(CVodeWFtolerances(memory_, ErrorWeights), "CVodeWFtolerances");
    CheckFlag(CVodeSetMaxNumSteps(memory_, options.max_steps), "CVodeSetMaxNumSteps");
    CheckFlag(CVodeSetMaxErrTestFails(memory_, kMostRejections), "CVodeSetMaxErrTestFails");
    if (std::isfinite(options.max_step)) {
      CheckFlag(CVodeSetMaxStep(memory_, options.max_step), "CVodeSetMaxStep");
    }
    if (method == CV_ADAMS) {
      iteration_ = SUNNonlinSol_FixedPoint(y_, 0, sundials_);
      CheckFlag(CVodeSetNonlinearSolver(memory_, iteration_), "CVodeSetNonlinearSolver");
    } else if (!state_.empty()) {
      const auto n = static_cast<sunindextype>(state_.size());
      jacobian_ = SUNDenseMatrix(n, n, sundials_);
      solver_ = SUNLinSol_Dense(y_, jacobian_, sundials_);
      CheckFlag(CVodeSetLinearSolver(memory_, solver_, jacobian_), "CVodeSetLinearSolver");
      CheckFlag(CVodeSetJacFn(memory_, DenseJacobian), "CVodeSetJacFn");
    }
    WarmUp();
  }
  ~CvodeIntegrator() override {
    CVodeFree(&memory_);
    if (iteration_ != nullptr) SUNNonlinSolFree(iteration_);
    if (solver_ != nullptr) SUNLinSolFree(solver_);
    if (jacobian_ != nullptr) SUNMatDestroy(jacobian_);
  }

  void Restart(Context& context, bool /*jumped*/) override {
    LoadState(context);
    CheckFlag(CVodeReInit(memory_, context.time(), y_), "CVodeReInit");
    ForgetCounters();
  }

  void IntegrateTo(Context& context, double to) override { Evolve(context, to, CV_NORMAL); }

  void Step(Context& context, double to) override { Evolve(context, to, CV_ONE_STEP); }

  void Interpolate(Context& context, double time, double* state) override {
    context_ = &context;
    N_VSetArrayPointer(state, between_);
    CheckFlag(CVodeGetDky(memory_, time, 0, between_), "CVodeGetDky");
  }

 protected:
  Counters ReadCounters() const override {
    Counters counters;
    CVodeGetNumSteps(memory_, &counters.steps);
    CVodeGetNumErrTestFails(memory_, &counters.rejected);
    CVodeGetNumRhsEvals(memory_, &counters.derivative_calls);
    return counters;
  }
  // Fixed-point iteration of Adams' formulas converges up to about one.
  double LargestReach() const override {
    return iteration_ != nullptr ? 0.5 : std::numeric_limits<double>::infinity();
  }

 private:
  void Evolve(Context& context, double to, int mode) {
    context_ = &context;
    CheckFlag(CVodeSetStopTime(memory_, to), "CVodeSetStopTime");
    double reached = from_ = context.time();
    const int flag = CVode(memory_, to, y_, &reached, mode);
    CountAll();
    CheckFlag(flag, "CVode");
    schedule_.SetTimeAndState(context, mode == CV_NORMAL ? to : reached, state_.data());
  }

  /// The first step takes memory; it is made here, at rest, so that no later one does.
  void WarmUp() {
    if (state_.empty()) return;
    double reached = 0.0;
    CheckFlag(CVode(memory_, 1.0, y_, &reached, CV_ONE_STEP), "CVode");
    ForgetCounters();
    statistics_ = {};
  }

  void CheckFlag(int flag, const char* call) {
    if (flag >= 0 && !failure_) return;
    char* name = CVodeGetReturnFlagName(flag);
    const std::string text = name == nullptr ? "an unknown error" : name;
    std::free(name);
    Check(flag, call, text.c_str());
  }

  void* memory_{nullptr};
  SUNNonlinearSolver iteration_{nullptr};
  SUNMatrix jacobian_{nullptr};
  SUNLinearSolver solver_{nullptr};
};

}  // namespace

std::unique_ptr<Integrator> MakeSundialsIntegrator(const Schedule& schedule,
                                                   const IntegratorOptions& options) {
  switch (options.integrator) {
    // Tables by name: their defaults differ between versions of SUNDIALS.
    case IntegratorKind::kErkDp5:
      return std::make_unique<ErkIntegrator>(schedule, options, "ARKODE_DORMAND_PRINCE_7_4_5");
    case IntegratorKind::kErkBs3:
      return std::make_unique<ErkIntegrator>(schedule, options, "ARKODE_BOGACKI_SHAMPINE_4_2_3");
    case IntegratorKind::kCvodeAdams:
      return std::make_unique<CvodeIntegrator>(schedule, options, CV_ADAMS);
    case IntegratorKind::kCvodeBdf:
      return std::make_unique<CvodeIntegrator>(schedule, options, CV_BDF);
    default:
      throw ConfigError("simulator: the integrator is not one of SUNDIALS'");
  }
}

}  // namespace oca
