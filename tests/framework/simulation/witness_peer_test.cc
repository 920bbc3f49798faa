// SPDX-License-Identifier: BSD-3-Clause
// The crossings that CVODE's own root finding reports, where it is to be trusted: simple zeros,
// away from restarts.
#include <cvode/cvode.h>
#include <gtest/gtest.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <cmath>

#include "oca/framework/simulation/simulator.h"
#include "tests/framework/dataflow/blocks.h"
#include "tests/framework/simulation/integrator_kinds.h"

namespace oca {
namespace witness_peer_test {

constexpr double kStart = 2.0;  // rad
constexpr double kEnd = 20.0;   // s

/// A pendulum that notes when it passes its lowest point.
class Pendulum final : public System {
 public:
  Pendulum()
      : x(DeclareContinuousState("x", {2}, blocks::Vec({kStart, 0.0}))),
        count_(DeclareDiscreteState("count", {1}, 0.0)) {
    DeclareDerivative<&Pendulum::Derive>(x, x);
    const Witness low = DeclareWitness<&Pendulum::Angle>("low", Direction::kBoth, x);
    DeclareReset<&Pendulum::Note>(When{low}, Writes(count_), kTime);
  }
  mutable std::vector<double> times;  // s

 private:
  void Derive(VectorView now, MutableVectorView derivative) const {
    derivative << now[1], -std::sin(now[0]);
  }
  double Angle(VectorView now) const { return now[0]; }
  void Note(double t, MutableVectorView) const { times.push_back(t); }
  const ContinuousState x;
  const DiscreteState<Vector> count_;
};

int Derive(sunrealtype, N_Vector y, N_Vector ydot, void*) {
  NV_Ith_S(ydot, 0) = NV_Ith_S(y, 1);
  NV_Ith_S(ydot, 1) = -std::sin(NV_Ith_S(y, 0));
  return 0;
}
int Root(sunrealtype, N_Vector y, sunrealtype* g, void*) {
  g[0] = NV_Ith_S(y, 0);
  return 0;
}

std::vector<double> RootsOfCvode() {
  SUNContext sundials = nullptr;
#if SUNDIALS_VERSION_MAJOR >= 7
  SUNContext_Create(SUN_COMM_NULL, &sundials);
#else
  SUNContext_Create(nullptr, &sundials);
#endif
  N_Vector y = N_VNew_Serial(2, sundials);
  NV_Ith_S(y, 0) = kStart;
  NV_Ith_S(y, 1) = 0.0;
  void* memory = CVodeCreate(CV_BDF, sundials);
  CVodeInit(memory, Derive, 0.0, y);
  CVodeSStolerances(memory, 1e-12, 1e-13);
  CVodeSetMaxNumSteps(memory, 100000);
  SUNMatrix jacobian = SUNDenseMatrix(2, 2, sundials);
  SUNLinearSolver solver = SUNLinSol_Dense(y, jacobian, sundials);
  CVodeSetLinearSolver(memory, solver, jacobian);
  CVodeRootInit(memory, 1, Root);
  std::vector<double> roots;
  sunrealtype t = 0.0;
  while (CVode(memory, kEnd, y, &t, CV_NORMAL) == CV_ROOT_RETURN) roots.push_back(t);
  CVodeFree(&memory);
  SUNLinSolFree(solver);
  SUNMatDestroy(jacobian);
  N_VDestroy(y);
  SUNContext_Free(&sundials);
  return roots;
}

class WitnessPeerTest : public testing::TestWithParam<IntegratorKind> {};
INSTANTIATE_TEST_SUITE_P(Integrators, WitnessPeerTest, testing::ValuesIn(kAllIntegrators),
                         NameOfKind);

TEST_P(WitnessPeerTest, AgreesWithTheRootsThatCvodeFinds) {
  const std::vector<double> roots = RootsOfCvode();
  const auto diagram = MakeDiagramOf(std::make_unique<Pendulum>());
  const auto& pendulum = static_cast<const Pendulum&>(*diagram->FindSystem("system"));
  Simulator simulator(
      *diagram,
      {.integrator = GetParam(), .relative_tolerance = 1e-10, .absolute_tolerance = 1e-11});
  simulator.AdvanceTo(kEnd);
  ASSERT_EQ(roots.size(), 5u);
  ASSERT_EQ(pendulum.times.size(), roots.size());
  // A quarter of the period 8.349752926918495 s, then halves of it.
  for (std::size_t i = 0; i < roots.size(); ++i) {
    EXPECT_NEAR(pendulum.times[i], roots[i], 2e-7);
    EXPECT_NEAR(pendulum.times[i], (0.25 + 0.5 * static_cast<double>(i)) * 8.349752926918495, 2e-7);
  }
}

}  // namespace witness_peer_test
}  // namespace oca
