// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/sum.h"

#include <gmock/gmock.h>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/basics/constant.h"
#include "oca/systems/basics/integrator.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace sum_test {

using ::testing::HasSubstr;

std::string RefusalOf(const Sum::Params& params) {
  try {
    Sum sum(params);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(SumTest, AddsAndSubtractsBySign) {
  SystemBench<Sum> bench(Sum::Params{.signs = Eigen::Vector3d(1.0, -1.0, 1.0)});
  for (int i = 0; i < 3; ++i) {
    bench->in[i].Fix(bench.context(), Eigen::VectorXd::Constant(1, std::pow(10.0, i)));
  }
  EXPECT_EQ(bench->out.Eval(bench.context())[0], 1.0 - 10.0 + 100.0);
}

TEST(SumTest, AddsAnyAllowedNumberOfInputs) {
  for (int count = 1; count <= Sum::kMostInputs; ++count) {
    SystemBench<Sum> bench(Sum::Params{.inputs = count});
    ASSERT_EQ(bench->in.size(), static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      bench->in[i].Fix(bench.context(), Eigen::VectorXd::Constant(1, 1 << i));
    }
    EXPECT_EQ(bench->out.Eval(bench.context())[0], (1 << count) - 1);
  }
}

TEST(SumTest, NamesItsInputsByNumber) {
  const Sum sum(Sum::Params{.inputs = 2});
  EXPECT_EQ(sum.inputs()[0].name, "in0");
  EXPECT_EQ(sum.inputs()[1].name, "in1");
}

TEST(SumTest, RefusesToAddDifferentUnits) {
  DiagramBuilder builder;
  const auto& length = builder.Add<Constant>("length", Constant::Params{.value = 1.0, .unit = "m"});
  const auto& angle = builder.Add<Constant>("angle", Constant::Params{.value = 1.0, .unit = "rad"});
  const auto& sum = builder.Add<Sum>("sum", Sum::Params{.inputs = 2});
  builder.Connect(length.value, sum.in[0]);
  builder.Connect(angle.value, sum.in[1]);
  EXPECT_THROW(builder.Build(), WiringError);
}

TEST(SumTest, RefusesSignsThatAreNone) {
  EXPECT_EQ(RefusalOf({.signs = Eigen::Vector2d(1.0, 0.5)}),
            "signs[1]: no sign; got 0.5; expected +1 or -1");
}

TEST(SumTest, AddsTwoInputsUnlessToldOtherwise) {
  const Sum sum(Sum::Params{});
  EXPECT_EQ(sum.in.size(), 2u);
}

TEST(SumTest, RefusesTooFewInputsTooManyAndTwoAnswers) {
  EXPECT_THAT(RefusalOf({.inputs = -1}), HasSubstr("got -1"));
  EXPECT_THAT(RefusalOf({.inputs = 9}), HasSubstr("got 9"));
  EXPECT_THAT(RefusalOf({.signs = Eigen::VectorXd::Ones(9)}), HasSubstr("signs"));
  EXPECT_THAT(RefusalOf({.signs = Eigen::VectorXd::Ones(2), .inputs = 2}), HasSubstr("twice"));
}

}  // namespace sum_test
}  // namespace oca::systems
