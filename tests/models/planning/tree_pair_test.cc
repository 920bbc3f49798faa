// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/tree_pair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "oca/models/planning/band_planner.h"
#include "oca/models/planning/batch_kernel.h"
#include "oca/models/planning/rrt_connect.h"
#include "tests/models/planning/scene.h"

namespace oca::planning {
namespace tree_pair_test {

using Eigen::VectorXd;

constexpr double kMargin = 0.001;

/// 1 mm thick, across the arm's way from q_0 = -0.5 to 0.5: who looks at the ends steps over it.
robot::PlacedBody ThinPlate() { return test::BoxAt({0.4, 0.001, 0.4}, {0.7, 0.0, 0.0}); }

const VectorXd kBelow = Eigen::Vector2d(-0.5, 0.0);
const VectorXd kAbove = Eigen::Vector2d(0.5, 0.0);

TEST(SearchTreeTest, CutsOffWhatSamplesDidNotSeeAndWhatIsBehindIt) {
  robot::Clearance clearance(test::Arm("planar2"), false, {ThinPlate()});
  CertifiedMotion motion(clearance, kMargin);
  SearchTree tree(kBelow);
  ASSERT_TRUE(tree.Grow(kAbove, {1.0, 1.0, 0.0, 100}, 1, motion).arrived);  // stepped over it
  const VectorXd beyond = Eigen::Vector2d(0.9, 0.2);
  tree.Grow(beyond, {0.3, 0.0625, 0.0, 100}, 100, motion);
  const int all = tree.size();
  ASSERT_GE(all, 4);
  EXPECT_FALSE(tree.Prove(tree.last(), motion));
  EXPECT_LT(tree.size(), all - 1);
  EXPECT_EQ(VectorXd(tree.q(0)), kBelow);
  for (int node = 0; node < tree.size(); ++node) {
    EXPECT_LT(tree.q(node)[0], 0.0) << node;  // this side of the plate
    EXPECT_TRUE(tree.Prove(node, motion));
    EXPECT_EQ(tree.PathTo(node).front(), kBelow);
  }
}

TEST(SearchTreeTest, KeepsBranchesThatDoNotPassWhatIsCutOff) {
  robot::Clearance clearance(test::Arm("planar2"), false, {ThinPlate()});
  CertifiedMotion motion(clearance, kMargin);
  SearchTree tree(kBelow);
  tree.Grow(kAbove, {1.0, 1.0, 0.0, 100}, 1, motion);
  const int wrong = tree.last();
  const VectorXd side = Eigen::Vector2d(-1.2, 0.4);
  ASSERT_TRUE(tree.Grow(side, {0.3, 0.0625, 0.0, 100}, 100, motion).arrived);
  ASSERT_FALSE(tree.Prove(wrong, motion));
  EXPECT_EQ(VectorXd(tree.q(tree.last())), side);
  EXPECT_TRUE(tree.Prove(tree.last(), motion));
}

TEST(TreePairTest, LooksCloserOnceSamplesHaveMisled) {
  robot::Clearance clearance(test::Arm("planar2"), false, test::Post());
  const VectorXd start = Eigen::Vector2d(0.0, 0.0), goal = Eigen::Vector2d(1.5, 0.0);
  int misled = 0, found = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    CertifiedMotion motion(clearance, kMargin);
    TreePair trees(start, &goal);
    models::Random random(seed);
    const SearchRoom room(clearance.model(), start, goal);
    for (int i = 0; i < 2000; ++i) {
      const double spacing = trees.spacing();
      if (!trees.Grow(room.Draw(random), kLongestEdge, 2000, motion)) continue;
      if (const auto path = trees.Prove(motion)) {
        EXPECT_EQ(path->front(), start);
        EXPECT_EQ(path->back(), goal);
        for (std::size_t k = 1; k < path->size(); ++k) {
          EXPECT_EQ(motion.ClearShare((*path)[k - 1], (*path)[k]), 1.0);
        }
        ++found;
        break;
      }
      ++misled;
      EXPECT_EQ(trees.spacing(), std::max(0.5 * spacing, kLeastSampleSpacing));
    }
  }
  EXPECT_EQ(found, 100);
  EXPECT_GT(misled, 0);
}

/// Boxes about an arm, and two positions among them that are clear.
struct Scene {
  explicit Scene(std::uint64_t seed) {
    models::Random random(seed);
    for (int i = 0; i < 14; ++i) {
      const double angle = random.Uniform(-3.1, 3.1), away = random.Uniform(0.4, 0.9);
      bodies.push_back(
          test::BoxAt({0.2, 0.15, 0.25},
                      {away * std::cos(angle), away * std::sin(angle), random.Uniform(0.0, 1.0)}));
    }
    robot::Clearance clearance(model, true, bodies);
    CertifiedMotion motion(clearance, 0.02);
    for (VectorXd* end : {&start, &goal}) {
      do {
        *end = VectorXd::NullaryExpr(7, [&](auto) { return random.Uniform(-1.6, 1.6); });
      } while (!motion.Clear(*end));
    }
  }
  std::optional<std::vector<VectorXd>> Path() const {
    robot::Clearance clearance(model, true, bodies);
    return RrtConnect(clearance, start, goal, {.most_nodes = 2000, .shortcuts = 50});
  }
  BandPlan Band() const {
    std::vector<BandBody> around;
    for (const robot::PlacedBody& body : bodies) {
      around.push_back(
          {models::Name("box"), body.collider, [X = body.X_WO](double) { return X; }, true});
    }
    BandTask task;
    for (VectorXd& x : task.deviation) x.setZero(7);
    task.request = [this](double time, int derivative, Eigen::Ref<VectorXd> out) {
      const double s = std::clamp(time / 4.0, 0.0, 1.0);
      const double shape[3] = {s * s * (3.0 - 2.0 * s), 1.5 * s * (1.0 - s),
                               0.375 * (1.0 - 2.0 * s)};
      const bool rests = s == 0.0 || s == 1.0;
      out = (derivative > 0 && rests ? 0.0 : shape[derivative]) * (goal - start);
      if (derivative == 0) out += start;
    };
    task.request_end = 4.0;
    task.bodies = around;
    PathSearch search;
    task.path_search = &search;
    return BandPlanner(model, {.most_evaluations = 1000}, true).Plan(task, nullptr);
  }

  std::shared_ptr<const robot::RobotModel> model = test::Arm("lwr4");
  std::vector<robot::PlacedBody> bodies;
  VectorXd start, goal;
};

TEST(BatchKernelTest, PlansOf100ScenesAreTheSameBitsOnAllProcessors) {
  int found = 0, bent = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Scene scene(seed);
    const auto path = scene.Path();
    const BandPlan band = scene.Band();
    internal::ForcePortable(true);
    const auto portable_path = scene.Path();
    const BandPlan portable_band = scene.Band();
    internal::ForcePortable(false);
    ASSERT_EQ(path, portable_path) << seed;
    ASSERT_TRUE(band.curve.controls() == portable_band.curve.controls()) << seed;
    found += path && path->size() > 2;
    bent += !band.curve.controls().isZero(0.0);
  }
  EXPECT_GT(found, 30);
  EXPECT_GT(bent, 30);
}

}  // namespace tree_pair_test
}  // namespace oca::planning
