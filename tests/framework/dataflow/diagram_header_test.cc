// SPDX-License-Identifier: BSD-3-Clause
// Whoever includes diagram.h alone reads and writes ports: this file does not compile or link
// otherwise. No other header of the framework may be included here.
#include <gtest/gtest.h>

#include "oca/framework/dataflow/diagram.h"

namespace oca {
namespace diagram_header_test {

class Double final : public System {
 public:
  struct Params {
    double factor{2.0};
    double offset{0.0};
  };
  explicit Double(const Params& params, double more = 0.0)
      : params_(params),
        more_(more),
        in(DeclareInput<Vector>("in", {1})),
        out(DeclareOutput<Vector, &Double::Calc>("out", {1}, in)) {}

 private:
  void Calc(VectorView x, MutableVectorView y) const {
    y[0] = params_.factor * x[0] + params_.offset + more_;
  }
  const Params params_;
  const double more_;

 public:
  const Input<Vector> in;
  const Output<Vector> out;
};

TEST(DiagramHeaderTest, IsEnoughToFixAnInputAndToEvaluateAnOutput) {
  const auto diagram = MakeDiagramOf(std::make_unique<Double>(Double::Params{}));
  Context context = diagram->MakeContext();
  diagram->GetInput<Vector>("in").Fix(context, Eigen::VectorXd::Constant(1, 3.0));
  EXPECT_EQ(diagram->GetOutput<Vector>("out").Eval(context)[0], 6.0);
}

TEST(DiagramHeaderTest, AddTakesParametersInBracesAndWhatTheConstructorTakesBeside) {
  DiagramBuilder builder;
  const auto& first = builder.Add<Double>("first", {.factor = 5.0});
  const auto& second = builder.Add<Double>("second", {.offset = 0.5}, 0.25);
  const Double::Params named{.factor = -1.0};
  const auto& third = builder.Add<Double>("third", named);
  builder.ExportInput("in", first.in);
  builder.Connect(first.out, second.in);
  builder.Connect(second.out, third.in);
  const auto diagram = builder.Build();
  Context context = diagram->MakeContext();
  diagram->GetInput<Vector>("in").Fix(context, Eigen::VectorXd::Constant(1, 1.0));
  EXPECT_EQ(first.out.Eval(context)[0], 5.0);
  EXPECT_EQ(second.out.Eval(context)[0], 10.75);
  EXPECT_EQ(third.out.Eval(context)[0], -10.75);
}

TEST(DiagramHeaderTest, AddTakesTheDefaultsIfNoParametersAreGiven) {
  DiagramBuilder builder;
  const auto& twice = builder.Add<Double>("twice");
  builder.ExportInput("in", twice.in);
  const auto diagram = builder.Build();
  Context context = diagram->MakeContext();
  diagram->GetInput<Vector>("in").Fix(context, Eigen::VectorXd::Constant(1, 3.0));
  EXPECT_EQ(twice.out.Eval(context)[0], 6.0);
}

}  // namespace diagram_header_test
}  // namespace oca
