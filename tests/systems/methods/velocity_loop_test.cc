// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/velocity_loop.h"

#include <gtest/gtest.h>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/framework/simulation/simulator.h"
#include "tests/allocation_count.h"
#include "tests/systems/system_bench.h"
#include "tests/systems/test_models.h"

namespace oca::systems {
namespace velocity_loop_test {

constexpr double kDt = 0.01;
VelocityLoop::Params Hundred() { return {.period = Period(1, 100)}; }

/// An arm that starts at (0.1, 0).
class Loop {
 public:
  Loop() : bench_(Hundred(), TestModels("planar2")) {
    Set({0.1, 0}, {0, 0});
    bench_->measured_position.Fix(bench_.context(), Eigen::Vector2d(0.1, 0));
  }
  void Set(const Eigen::Vector2d& request, const Eigen::Vector2d& chosen) {
    bench_->position.Fix(bench_.context(), request);
    bench_->chosen.Fix(bench_.context(), chosen);
  }
  Eigen::VectorXd Wish() { return bench_->wish.Eval(bench_.context()); }
  Eigen::VectorXd Delta() { return bench_->delta.Eval(bench_.context()); }
  SystemBench<VelocityLoop>& bench() { return bench_; }

 private:
  SystemBench<VelocityLoop> bench_;
};

TEST(VelocityLoopTest, WishesForTheWayBackByHand) {
  Loop loop;
  loop.bench().AdvanceTo(0.0);
  loop.Set({0.3, -0.1}, {0, 0});
  EXPECT_NEAR((loop.Wish() - Eigen::Vector2d(5 * 0.2, -5 * 0.1)).norm(), 0.0, 1e-12);
}

TEST(VelocityLoopTest, TheDeltaLeadsWhereTheChosenVelocityDoes) {
  Loop loop;
  loop.Set({0.3, 0}, {0.5, -1.0});
  loop.bench().AdvanceTo(0.5 * kDt);
  // From (0.1, 0) with (0.5, -1) rad/s for 10 ms, whatever the request does meanwhile.
  EXPECT_NEAR((loop.Delta() - Eigen::Vector2d(0.105 - 0.3, -0.01)).norm(), 0.0, 1e-14);
  loop.Set({0.4, 0}, {0.5, -1.0});
  EXPECT_NEAR((loop.Delta() - Eigen::Vector2d(0.105 - 0.4, -0.01)).norm(), 0.0, 1e-14);
  loop.bench().AdvanceTo(1.5 * kDt);
  EXPECT_NEAR((loop.Delta() - Eigen::Vector2d(0.110 - 0.4, -0.02)).norm(), 0.0, 1e-14);
}

TEST(VelocityLoopTest, AWishThatIsGrantedMeetsTheRequest) {
  Loop loop;
  for (int k = 0; k < 400; ++k) {
    loop.Set({0.3, 0}, loop.Wish());
    loop.bench().AdvanceTo((k + 0.5) * kDt);
  }
  EXPECT_NEAR(loop.Delta().norm(), 0.0, 1e-6);
}

TEST(VelocityLoopTest, RefusesAGainThatAPeriodCannotCarry) {
  const auto make = [](double gain, Period period) {
    VelocityLoop::Params params = Hundred();
    params.position_gain = gain;
    params.period = period;
    VelocityLoop{params, TestModels("planar2")};
  };
  EXPECT_NO_THROW(make(100.0, Period(1, 100)));
  EXPECT_THROW(make(100.1, Period(1, 100)), ConfigError);
  EXPECT_THROW(make(0.0, Period(1, 100)), ConfigError);
  EXPECT_THROW(make(1.0, Period()), ConfigError);
}

TEST(VelocityLoopTest, TicksWithoutTheHeap) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  Loop loop;
  loop.bench().AdvanceTo(0.1);
  const std::int64_t before = AllocationCount();
  loop.bench().AdvanceTo(0.5);
  EXPECT_EQ(AllocationCount(), before);
}

}  // namespace velocity_loop_test
}  // namespace oca::systems
