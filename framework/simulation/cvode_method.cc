// SPDX-License-Identifier: BSD-3-Clause
// CVODE's multi-step methods, of sundials_method.h.
#include <cvode/cvode.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <limits>

#include "oca/framework/simulation/sundials_method.h"

namespace oca {
namespace {

constexpr SundialsFamily kCvode {
  .prefix = "CVode", .evolve_call = "", .normal = CV_NORMAL, .one_step = CV_ONE_STEP,
  .set_user_data = CVodeSetUserData, .set_weights = CVodeWFtolerances,
  .set_most_steps = CVodeSetMaxNumSteps, .set_most_rejections = CVodeSetMaxErrTestFails,
  .set_max_step = CVodeSetMaxStep, .set_stop_time = CVodeSetStopTime, .evolve = CVode,
  .interpolate = CVodeGetDky, .count_steps = CVodeGetNumSteps,
  .count_rejections = CVodeGetNumErrTestFails, .count_derivatives = CVodeGetNumRhsEvals,
  .flag_name = CVodeGetReturnFlagName,
#if SUNDIALS_VERSION_MAJOR < 7
  .set_error_handler = CVodeSetErrHandlerFn,
#endif
};

class CvodeMethod final : public SundialsMethod {
 public:
  CvodeMethod(const Schedule& schedule, const IntegratorOptions& options, CvodeFormulas formulas)
      : SundialsMethod(kCvode, schedule, options) {
    memory_ = CVodeCreate(formulas == CvodeFormulas::kAdams ? CV_ADAMS : CV_BDF, sundials_);
    if (memory_ != nullptr) Check(CVodeInit(memory_, RightHandSide, 0.0, y_), "Init");
    SetUp(options);
    if (formulas == CvodeFormulas::kAdams) {
      iteration_ = SUNNonlinSol_FixedPoint(y_, 0, sundials_);
      Check(CVodeSetNonlinearSolver(memory_, iteration_), "SetNonlinearSolver");
    } else if (!state_.empty()) {
      const auto n = static_cast<sunindextype>(state_.size());
      jacobian_ = SUNDenseMatrix(n, n, sundials_);
      solver_ = SUNLinSol_Dense(y_, jacobian_, sundials_);
      Check(CVodeSetLinearSolver(memory_, solver_, jacobian_), "SetLinearSolver");
      Check(CVodeSetJacFn(memory_, DenseJacobian), "SetJacFn");
    }
    WarmUp();
  }
  ~CvodeMethod() override {
    CVodeFree(&memory_);
    if (iteration_ != nullptr) SUNNonlinSolFree(iteration_);
    if (solver_ != nullptr) SUNLinSolFree(solver_);
    if (jacobian_ != nullptr) SUNMatDestroy(jacobian_);
  }

  void Restart(Context& context, bool /*jumped*/) override {
    LoadState(context);
    Check(CVodeReInit(memory_, context.time(), y_), "ReInit");
    ForgetCounters();
    ++statistics_.restarts;
  }

 private:
  // Fixed-point iteration of Adams' formulas converges up to about one.
  double LargestReach() const override {
    return iteration_ != nullptr ? 0.5 : std::numeric_limits<double>::infinity();
  }

  SUNNonlinearSolver iteration_{nullptr};
  SUNMatrix jacobian_{nullptr};
  SUNLinearSolver solver_{nullptr};
};

}  // namespace

std::unique_ptr<IntegrationMethod> MakeCvodeMethod(const Schedule& schedule,
                                                   const IntegratorOptions& options,
                                                   CvodeFormulas formulas) {
  return std::make_unique<CvodeMethod>(schedule, options, formulas);
}

}  // namespace oca
