// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_version.h>

#include <cstddef>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "oca/framework/dataflow/schedule.h"
#include "oca/framework/simulation/integration_method.h"

namespace oca {

/// What ARKODE's ERKStep and CVODE have under names of their own.
struct SundialsFamily {
  const char* prefix;  ///< of the calls
  const char* evolve_call;
  int normal, one_step;  ///< how far `evolve` goes
  int (*set_user_data)(void* memory, void* self);
  int (*set_weights)(void* memory, int (*weights)(N_Vector y, N_Vector w, void* self));
  int (*set_most_steps)(void* memory, long most);
  int (*set_most_rejections)(void* memory, int most);
  int (*set_max_step)(void* memory, sunrealtype step);
  int (*set_stop_time)(void* memory, sunrealtype time);
  int (*evolve)(void* memory, sunrealtype to, N_Vector y, sunrealtype* reached, int mode);
  int (*interpolate)(void* memory, sunrealtype time, int derivative, N_Vector into);
  int (*count_steps)(void* memory, long* count);
  int (*count_rejections)(void* memory, long* count);
  int (*count_derivatives)(void* memory, long* count);
  char* (*flag_name)(long flag);
#if SUNDIALS_VERSION_MAJOR < 7
  int (*set_error_handler)(void* memory,
                           void (*handler)(int, const char*, const char*, char*, void*),
                           void* data);
#endif
};

/// An integration method of SUNDIALS: vector, tolerances, right-hand side and errors. A derived
/// class creates `memory_` of its family, calls SetUp, then WarmUp.
class SundialsMethod : public IntegrationMethod {
 public:
  ~SundialsMethod() override;
  void IntegrateTo(Context& context, double to) override { Evolve(context, to, family_.normal); }
  void Step(Context& context, double to) override { Evolve(context, to, family_.one_step); }
  void Interpolate(Context& context, double time, double* state) override;

 protected:
  SundialsMethod(const SundialsFamily& family, const Schedule& schedule,
                 const IntegratorOptions& options);
  void SetUp(const IntegratorOptions& options);
  /// The first step takes memory; it is made here, at rest, so that no later one does.
  void WarmUp();
  void LoadState(Context& context);
  void ForgetCounters() { counted_ = {}; }
  /// throws SimulationError unless the flag of prefix + `call` is good, and what a
  ///        calculation threw
  void Check(int flag, const char* call) {
    if (flag < 0 || failure_) Fail(flag, call);
  }
  /// After a step, with the context's state.
  virtual void Evolved(Context& /*context*/) {}
  /// Largest step times fastest rate that accuracy alone asks for; above it the step is held by
  /// stability.
  virtual double LargestReach() const = 0;

  static int RightHandSide(sunrealtype t, N_Vector y, N_Vector ydot, void* self);
  /// Forward differences, column by column. SUNDIALS has its own, which takes memory from the heap
  /// for every Jacobian.
  ///
  /// source Dennis and Schnabel 1983, section 5.4: increments of sqrt(epsilon) times the size of
  ///        the state, which is typically no less than where the absolute tolerance takes over
  static int DenseJacobian(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix jacobian, void* self,
                           N_Vector moved, N_Vector f_moved, N_Vector unused);

  const Schedule& schedule_;
  std::vector<double> state_;  // y_ lies over it
  SUNContext sundials_{nullptr};
  N_Vector y_{nullptr};
  void* memory_{nullptr};

 private:
  /// Counters that SUNDIALS keeps and sets to zero at a restart.
  struct Counters {
    long steps{0}, rejected{0}, derivative_calls{0};
  };

  static int ErrorWeights(N_Vector y, N_Vector weights, void* self);
  void SetTolerances(const IntegratorOptions& options);
  void Evolve(Context& context, double to, int mode);
  void CountAll();
  [[noreturn]] void Fail(int flag, const char* call);
  /// Says whether it is the system that is stiff or the limit that is low.
  std::string TooManySteps(double time);

  const SundialsFamily& family_;
  std::vector<double> relative_, absolute_;
  const int max_steps_;        // between two events
  double from_{0.0};           // s; where the present integration started
  N_Vector between_{nullptr};  // for interpolation; lies over what the caller gives
  Context* context_{nullptr};
  std::exception_ptr failure_;
  Counters counted_;
};

/// ARKODE's explicit Runge-Kutta with error control, by the name of its table.
std::unique_ptr<IntegrationMethod> MakeErkMethod(const Schedule& schedule,
                                                 const IntegratorOptions& options,
                                                 const char* table);
/// Adams' with fixed-point iteration, or backward differences with Newton and a dense Jacobian.
enum class CvodeFormulas { kAdams, kBdf };
/// CVODE.
std::unique_ptr<IntegrationMethod> MakeCvodeMethod(const Schedule& schedule,
                                                   const IntegratorOptions& options,
                                                   CvodeFormulas formulas);

}  // namespace oca
