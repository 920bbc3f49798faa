// SPDX-License-Identifier: BSD-3-Clause
// What a SafetyFilter makes of a request: its speed, its past, and that it is known to be clear.
#include <gtest/gtest.h>

#include <initializer_list>
#include <memory>

#include "tests/systems/methods/filter_bench.h"

namespace oca::systems {
namespace safety_filter_request_test {

using filter_bench::BesideTheTip;
using filter_bench::Hundred;
using filter_bench::kDt;

/// A filter of planar2 at (0, 0) whose inputs `names` are wired from outside, so that optional ones
/// can be fixed; nothing is near and no motion requested.
class Wired {
 public:
  Wired(const SafetyFilter::Params& params, std::initializer_list<const char*> names) {
    DiagramBuilder builder;
    filter_ = &builder.Add<SafetyFilter>("filter", params, TestModels("planar2"));
    for (const char* name : names) builder.ExportInput(name, filter_->FindInput(name));
    for (const char* name : {"proximities", "links", "position", "measured_position"}) {
      builder.ExportInput(name, filter_->FindInput(name));
    }
    diagram_ = builder.Build();
    simulator_ = std::make_unique<Simulator>(*diagram_);
    const auto model = TestModels("planar2").Get("");
    LinkPoses poses;
    NameLinks(*model, poses);
    robot::ForwardKinematics(*model, Eigen::Vector2d::Zero(), poses.poses);
    filter().links.Fix(context(), poses);
    filter().proximities.Fix(context(), ProximitySet{});
    filter().measured_position.Fix(context(), Eigen::Vector2d::Zero());
    filter().position.Fix(context(), Eigen::Vector2d::Zero());
  }
  const SafetyFilter& filter() const { return *filter_; }
  const Diagram& diagram() const { return *diagram_; }
  Simulator& simulator() { return *simulator_; }
  Context& context() { return simulator_->context(); }
  /// The velocity of the next tick: the arm stands in (0, 0), so it leads to velocity * period.
  Eigen::VectorXd Answer() {
    simulator().AdvanceTo(context().time() + 0.75 * kDt);
    filter().position.Fix(context(), Eigen::Vector2d::Zero());
    return filter().delta.Eval(context()) / kDt;
  }

 private:
  const SafetyFilter* filter_;
  std::unique_ptr<Diagram> diagram_;
  std::unique_ptr<Simulator> simulator_;
};

TEST(SafetyFilterRequestTest, EvadesWithTheJointThatHasNowhereToGo) {
  // The request has led joint 1 only, for half a second.
  const auto speed_of_joint_1 = [](double progress_weight) {
    SafetyFilter::Params params = Hundred();
    params.progress_weight = progress_weight;
    Wired wired(params, {"command", "velocity"});
    Context& context = wired.context();
    wired.diagram().GetInput<Vector>("command").Fix(context, Eigen::Vector2d::Zero());
    wired.diagram().GetInput<Vector>("velocity").Fix(context, Eigen::Vector2d(1, 0));
    wired.simulator().AdvanceTo(50.5 * kDt);
    wired.filter().proximities.Fix(context, BesideTheTip(0.05, 0.0));
    return wired.Answer()[0];
  };
  // (1, 0) onto (0.9, 0.4) . u = 0, with equal weights and with 11 : 1 or nearly so.
  EXPECT_NEAR(speed_of_joint_1(0.0), 1 - 0.81 / 0.97, 1e-12);
  EXPECT_NEAR(speed_of_joint_1(10.0), 1 - 0.81 / 11 / (0.81 / 11 + 0.16), 0.03);
}

TEST(SafetyFilterRequestTest, LetsARequestThroughThatIsClearOfWhatItWasPlannedWith) {
  const Eigen::Vector2d wish(0.5, 0.0);
  const auto answer = [&](const ClearMotion& clear, double distance) {
    Wired wired(Hundred(), {"clear"});
    wired.filter().proximities.Fix(wired.context(), BesideTheTip(distance, 1.0));
    wired.filter().position.Fix(wired.context(), wish / Hundred().position_gain);
    wired.diagram().GetInput<ClearMotion>("clear").Fix(wired.context(), clear);
    return wired.Answer();
  };
  const ClearMotion known{.clear_for = 0.1, .bodies = {models::Name("ball")}};
  EXPECT_TRUE(answer(known, 0.06).isApprox(wish, 1e-9));
  EXPECT_TRUE(answer(known, 0.01).isApprox(wish, 1e-9));  // nor is there a wish to recover
  const Eigen::VectorXd guarded = answer({}, 0.06);
  EXPECT_LT(guarded[0], -0.5);
  EXPECT_EQ(answer({.clear_for = 0.0, .bodies = known.bodies}, 0.06), guarded);
  EXPECT_EQ(answer({.clear_for = 0.1, .bodies = {models::Name("wall")}}, 0.06), guarded);
  EXPECT_EQ(answer({.clear_for = 0.1, .bodies = {}, .own_links = true}, 0.06), guarded);
}

TEST(SafetyFilterRequestTest, NoWishIsFastEnoughToPayForADistance) {
  // Without the box the arm would pay slack for a wish of 1e4 rad/s and more towards the ball.
  for (const double wish : {10.0, 1e4, 1e8}) {
    Wired wired(Hundred(), {"velocity"});
    wired.filter().proximities.Fix(wired.context(), BesideTheTip(0.08, 0.0));
    wired.filter().position.Fix(wired.context(), Eigen::Vector2d(0.0, 0.0));
    wired.diagram().GetInput<Vector>("velocity").Fix(wired.context(), Eigen::Vector2d(wish, 0.0));
    const Eigen::VectorXd u = wired.Answer();
    EXPECT_LE(0.9 * u[0] + 0.4 * u[1], 0.15 + 1e-9) << wish << ": " << u.transpose();
  }
}

}  // namespace safety_filter_request_test
}  // namespace oca::systems
