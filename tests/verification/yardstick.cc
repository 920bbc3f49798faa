// SPDX-License-Identifier: BSD-3-Clause
#include "tests/verification/yardstick.h"

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace oca::verification {
namespace {

void Check(int flag) {
  if (flag < 0) throw std::runtime_error("SUNDIALS refuses: " + std::to_string(flag));
}

/// What both families share.
class Solver {
 public:
  explicit Solver(const Problem& problem) : problem_(problem) {
#if SUNDIALS_VERSION_MAJOR >= 7
    SUNContext_Create(SUN_COMM_NULL, &sundials_);
#else
    SUNContext_Create(nullptr, &sundials_);
#endif
    y_ = N_VNew_Serial(static_cast<sunindextype>(problem.initial.size()), sundials_);
    std::copy(problem.initial.begin(), problem.initial.end(), NV_DATA_S(y_));
  }
  virtual ~Solver() {
    N_VDestroy(y_);
    SUNContext_Free(&sundials_);
  }
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  Outcome Run() {
    const auto samples = static_cast<long>(
        problem_.sample == nullptr ? 1 : std::llround(problem_.end / problem_.period.seconds()));
    for (long k = 0; k < samples; ++k) {
      const auto tick = [&](long i) {
        return problem_.end * static_cast<double>(i) / static_cast<double>(samples);
      };
      if (problem_.sample != nullptr) u_ = problem_.sample(tick(k), NV_DATA_S(y_));
      if (k > 0) Restart(tick(k));
      Advance(tick(k + 1));
      Count();
    }
    const double* const x = NV_DATA_S(y_);
    outcome_.error = problem_.ErrorOf({x, x + problem_.initial.size()});
    return outcome_;
  }

 protected:
  virtual void Restart(double t) = 0;
  virtual void Advance(double to) = 0;
  /// Brings the counts of the outcome up to date.
  virtual void Count() = 0;

  static int Derive(sunrealtype t, N_Vector y, N_Vector ydot, void* self) {
    const auto& solver = *static_cast<const Solver*>(self);
    solver.problem_.derive(t, NV_DATA_S(y), solver.u_, NV_DATA_S(ydot));
    return 0;
  }

  const Problem& problem_;
  SUNContext sundials_{nullptr};
  N_Vector y_{nullptr};
  double u_{0.0};
  Outcome outcome_{};
};

const char* TableOf(IntegratorKind kind) {
  switch (kind) {
    case IntegratorKind::kErkBs3:
      return "ARKODE_BOGACKI_SHAMPINE_4_2_3";
    case IntegratorKind::kFixedRk4:
      return "ARKODE_ZONNEVELD_5_3_4";
    default:
      return "ARKODE_DORMAND_PRINCE_7_4_5";
  }
}

class Erk final : public Solver {
 public:
  Erk(const Problem& problem, const IntegratorOptions& options) : Solver(problem) {
    memory_ = ERKStepCreate(Derive, 0.0, y_, sundials_);
    Check(ERKStepSetUserData(memory_, static_cast<Solver*>(this)));
    Check(ERKStepSStolerances(memory_, options.relative_tolerance, options.absolute_tolerance));
    Check(ERKStepSetTableName(memory_, TableOf(options.integrator)));
    Check(ERKStepSetMaxNumSteps(memory_, options.max_steps));
    const bool fixed = options.integrator == IntegratorKind::kFixedDp5 ||
                       options.integrator == IntegratorKind::kFixedRk4;
    if (fixed) Check(ERKStepSetFixedStep(memory_, options.fixed_step));
  }
  ~Erk() override { ERKStepFree(&memory_); }

 private:
  void Restart(double t) override { Check(ERKStepReset(memory_, t, y_)); }
  void Advance(double to) override {
    double reached = 0.0;
    Check(ERKStepSetStopTime(memory_, to));
    Check(ERKStepEvolve(memory_, to, y_, &reached, ARK_NORMAL));
  }
  void Count() override {
    long steps = 0, calls = 0;
    ERKStepGetNumSteps(memory_, &steps);
    ERKStepGetNumRhsEvals(memory_, &calls);
    outcome_.steps = steps;  // a reset keeps the counters
    outcome_.calls = calls;
  }
  void* memory_{nullptr};
};

class Cvode final : public Solver {
 public:
  Cvode(const Problem& problem, const IntegratorOptions& options) : Solver(problem) {
    const bool adams = options.integrator == IntegratorKind::kCvodeAdams;
    const auto n = static_cast<sunindextype>(problem.initial.size());
    memory_ = CVodeCreate(adams ? CV_ADAMS : CV_BDF, sundials_);
    Check(CVodeInit(memory_, Derive, 0.0, y_));
    Check(CVodeSetUserData(memory_, static_cast<Solver*>(this)));
    Check(CVodeSStolerances(memory_, options.relative_tolerance, options.absolute_tolerance));
    Check(CVodeSetMaxNumSteps(memory_, options.max_steps));
    iteration_ = adams ? SUNNonlinSol_FixedPoint(y_, 0, sundials_) : nullptr;
    jacobian_ = SUNDenseMatrix(n, n, sundials_);
    solver_ = SUNLinSol_Dense(y_, jacobian_, sundials_);
    Check(adams ? CVodeSetNonlinearSolver(memory_, iteration_)
                : CVodeSetLinearSolver(memory_, solver_, jacobian_));
  }
  ~Cvode() override {
    CVodeFree(&memory_);
    if (iteration_ != nullptr) SUNNonlinSolFree(iteration_);
    SUNLinSolFree(solver_);
    SUNMatDestroy(jacobian_);
  }

 private:
  void Restart(double t) override { Check(CVodeReInit(memory_, t, y_)); }
  void Advance(double to) override {
    double reached = 0.0;
    Check(CVodeSetStopTime(memory_, to));
    Check(CVode(memory_, to, y_, &reached, CV_NORMAL));
  }
  void Count() override {
    long steps = 0, calls = 0, of_jacobians = 0;
    CVodeGetNumSteps(memory_, &steps);
    CVodeGetNumRhsEvals(memory_, &calls);
    if (iteration_ == nullptr) CVodeGetNumLinRhsEvals(memory_, &of_jacobians);
    outcome_.steps += steps;
    outcome_.calls += calls + of_jacobians;
  }
  void* memory_{nullptr};
  SUNNonlinearSolver iteration_{nullptr};
  SUNMatrix jacobian_{nullptr};
  SUNLinearSolver solver_{nullptr};
};

}  // namespace

Outcome Measure(const Problem& problem, const IntegratorOptions& options) {
  switch (options.integrator) {
    case IntegratorKind::kCvodeAdams:
    case IntegratorKind::kCvodeBdf:
      return Cvode(problem, options).Run();
    default:
      return Erk(problem, options).Run();
  }
}

}  // namespace oca::verification
