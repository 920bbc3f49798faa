// SPDX-License-Identifier: BSD-3-Clause
// After Initialize nothing takes memory from the heap, SUNDIALS included: every malloc is counted,
// which is where operator new takes its memory too.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <new>

#include "framework/simulator.h"
#include "tests/framework/blocks.h"
#include "tests/framework/integrator_kinds.h"

// Sanitizers bring a malloc of their own; there the tests below are skipped.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
constexpr bool kCounting = true;
static thread_local int allocations = 0;

extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* memory, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);

void* malloc(std::size_t bytes) {
  ++allocations;
  return __libc_malloc(bytes);
}
void* calloc(std::size_t count, std::size_t bytes) {
  ++allocations;
  return __libc_calloc(count, bytes);
}
void* realloc(void* memory, std::size_t bytes) {
  ++allocations;
  return __libc_realloc(memory, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  ++allocations;
  return __libc_memalign(alignment, bytes);
}
}
#else
constexpr bool kCounting = false;
static int allocations = 0;
#endif

namespace oca {
namespace {

class HeapTest : public testing::TestWithParam<IntegratorKind> {
 protected:
  void SetUp() override {
    if (!kCounting) GTEST_SKIP() << "malloc is not ours to count here";
  }
};
INSTANTIATE_TEST_SUITE_P(Integrators, HeapTest, testing::ValuesIn(kAllIntegrators), NameOfKind);

TEST(HeapCounterTest, SeesWhatNewMallocAndCallocTake) {
  if (!kCounting) GTEST_SKIP() << "malloc is not ours to count here";
  const int before = allocations;
  const Eigen::VectorXd vector = Eigen::VectorXd::Zero(100);
  EXPECT_EQ(allocations, before + 1) << vector.size();
  void* volatile block = std::calloc(10, 10);
  EXPECT_EQ(allocations, before + 2);
  std::free(block);
  ::operator delete(::operator new(64, std::align_val_t(64)), std::align_val_t(64));
  EXPECT_EQ(allocations, before + 3);
}

/// A sampled loop around a stiff lag, two more rates, a publish and a reset.
struct Loop {
  Loop() {
    DiagramBuilder builder;
    const auto& lag = builder.Add<blocks::Ode>(
        "lag", 0.2, [](double t, double x, double u) { return 40.0 * (std::sin(t) - x) + u; });
    const auto& other = builder.Add<blocks::Ode>(
        "other", 0.2, [](double, double x, double u) { return u * u - std::sin(x); });
    const auto& control = builder.Add<blocks::Map>("control", [](double x) { return -1.5 * x; });
    const auto& hold = builder.Add<blocks::Delay>("hold", Every{Period(1, 100)});
    const auto& slow = builder.Add<blocks::Delay>("slow", Every{Period(1, 30)});
    const auto& printer = builder.Add<blocks::Printer>("printer", Every{Period(1, 60)},
                                                       [this](double, double x) { last = x; });
    builder.Connect(lag.out, control.in);
    builder.Connect(control.out, hold.in);
    builder.Connect(hold.out, lag.in);
    builder.Connect(lag.out, slow.in);
    builder.Connect(slow.out, other.in);
    builder.Connect(other.out, printer.in);
    diagram = builder.Build();
  }
  double last{0.0};
  std::unique_ptr<Diagram> diagram;
};

TEST_P(HeapTest, AThousandTicksAfterInitializeTakeNothing) {
  Loop loop;
  Simulator simulator(*loop.diagram, {.integrator = GetParam()});
  int monitored = 0;
  simulator.AddMonitor([&](const Context&) { return ++monitored > 0; });
  simulator.Initialize();
  const int before = allocations;
  for (int tick = 1; tick <= 1000; ++tick) simulator.AdvanceTo(tick / 100.0);
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(monitored, 1000);
  EXPECT_NE(loop.last, 0.0);
}

TEST_P(HeapTest, AnUnbrokenRunTakesNothing) {
  Loop loop;
  Simulator simulator(*loop.diagram, {.integrator = GetParam()});
  simulator.Initialize();
  const int before = allocations;
  simulator.AdvanceTo(10.0);
  EXPECT_EQ(allocations - before, 0);
}

TEST_P(HeapTest, SavingIntoAndRestoringFromAContextTakesNothing) {
  Loop loop;
  Simulator simulator(*loop.diagram, {.integrator = GetParam()});
  simulator.Initialize();
  Context saved = simulator.context();
  const int before = allocations;
  for (int i = 1; i <= 10; ++i) {
    simulator.AdvanceTo(0.1 * i);
    saved = simulator.context();
    simulator.AdvanceTo(0.1 * i + 0.05);
    simulator.context() = saved;
  }
  EXPECT_EQ(allocations - before, 0);
}

TEST(HeapObjectTest, AssigningAContextWithObjectsReusesTheirCapacity) {
  if (!kCounting) GTEST_SKIP() << "malloc is not ours to count here";
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::LabelSink>());
  const auto in = diagram->GetInput<Label>("in");
  const auto out = diagram->GetOutput<Label>("out");
  Context one = diagram->MakeContext();
  in.Fix(one, Label{std::string(100, 'a')});
  out.Eval(one);
  Context two = one;
  const Label other{std::string(90, 'b')};
  const int before = allocations;
  in.Fix(one, other);
  out.Eval(one);
  two = one;
  EXPECT_EQ(allocations - before, 0);
  EXPECT_EQ(out.Eval(two).text, other.text);
}

}  // namespace
}  // namespace oca
