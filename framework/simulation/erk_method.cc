// SPDX-License-Identifier: BSD-3-Clause
// ARKODE's explicit Runge-Kutta methods, of sundials_method.h.
#include <arkode/arkode_erkstep.h>

#include "oca/framework/simulation/sundials_method.h"

namespace oca {
namespace {

constexpr SundialsFamily kErk {
  .prefix = "ERKStep", .evolve_call = "Evolve", .normal = ARK_NORMAL, .one_step = ARK_ONE_STEP,
  .set_user_data = ERKStepSetUserData, .set_weights = ERKStepWFtolerances,
  .set_most_steps = ERKStepSetMaxNumSteps, .set_most_rejections = ERKStepSetMaxErrTestFails,
  .set_max_step = ERKStepSetMaxStep, .set_stop_time = ERKStepSetStopTime, .evolve = ERKStepEvolve,
  .interpolate = ERKStepGetDky, .count_steps = ERKStepGetNumSteps,
  .count_rejections = ERKStepGetNumErrTestFails, .count_derivatives = ERKStepGetNumRhsEvals,
  .flag_name = ERKStepGetReturnFlagName,
#if SUNDIALS_VERSION_MAJOR < 7
  .set_error_handler = ERKStepSetErrHandlerFn,
#endif
};

class ErkMethod final : public SundialsMethod {
 public:
  ErkMethod(const Schedule& schedule, const IntegratorOptions& options, const char* table)
      : SundialsMethod(kErk, schedule, options) {
    memory_ = ERKStepCreate(RightHandSide, 0.0, y_, sundials_);
    SetUp(options);
    Check(ERKStepSetTableName(memory_, table), "SetTableName");
    // Every step ends with an interpolation at its end, which a straight line gives as exactly.
    if (schedule.witnesses.empty()) {
      Check(ERKStepSetInterpolantDegree(memory_, 1), "SetInterpolantDegree");
    }
    WarmUp();
  }
  ~ErkMethod() override { ERKStepFree(&memory_); }

  void Restart(Context& context, bool jumped) override {
    LoadState(context);
    // What follows must depend on the Context alone, so that a resumed run gives the same bits: the
    // step is the one that the Context keeps, and the controller looks at no earlier errors.
    const double step = jumped ? 0.0 : schedule_.integrator_step(context);
    schedule_.integrator_step(context) = step;
    // A long integration has the controller that SUNDIALS prefers, which looks at two errors.
    const int controller = step == 0.0 ? ARK_ADAPT_PI : ARK_ADAPT_I;
    if (controller != controller_) {
      Check(ERKStepSetAdaptivityMethod(memory_, controller, 1, 0, nullptr), "SetAdaptivityMethod");
      controller_ = controller;
    }
    if (step == 0.0) {
      Check(ERKStepReInit(memory_, RightHandSide, context.time(), y_), "ReInit");
      ForgetCounters();
    } else {
      Check(ERKStepReset(memory_, context.time(), y_), "Reset");
    }
    Check(ERKStepSetInitStep(memory_, step), "SetInitStep");
    ++statistics_.restarts;
  }

 private:
  void Evolved(Context& context) override {
    double next = 0.0;
    ERKStepGetCurrentStep(memory_, &next);
    schedule_.integrator_step(context) = next;
  }
  // The methods are stable on the negative axis to 3.3 (Dormand-Prince) and 2.5 (Bogacki-Shampine).
  double LargestReach() const override { return 2.0; }

  int controller_{-1};
};

}  // namespace

std::unique_ptr<IntegrationMethod> MakeErkMethod(const Schedule& schedule,
                                                 const IntegratorOptions& options,
                                                 const char* table) {
  return std::make_unique<ErkMethod>(schedule, options, table);
}

}  // namespace oca
