// SPDX-License-Identifier: BSD-3-Clause
// The same bands for Ceres, which knows nothing of their blocks.
#include <gtest/gtest.h>

#include "oca/models/random.h"
#include "tests/models/planning/band_in_ceres.h"

namespace oca::planning::test {
namespace band_optimizer_ceres_test {

constexpr std::uint64_t kScenes = 20;

TEST(BandOptimizerCeresTest, ABandCostsWhatItsFormulaSays) {
  models::Random random(7);
  for (std::uint64_t seed = 0; seed < kScenes; ++seed) {
    const BandScene scene = MakeBandScene(seed);
    BandOptimizer band(scene.model, {});
    BandCurve curve = StraightBand();
    for (Eigen::Index i = 0; i < curve.controls().size(); ++i) {
      curve.controls().data()[i] = random.Uniform(-0.5, 0.5);
    }
    curve.controls().rightCols(3).setZero();
    band.Prepare(curve, scene.request, scene.bodies, true);
    const double cost = band.Cost(curve);
    EXPECT_NEAR(RelaxByCeres(scene, {}, 0, 0.0, curve).before, cost, 1e-9 * cost) << seed;
  }
}

// The cost has many minima, and from a start in the middle of a box it is chance which one a step
// leads to. Where both end in the same it must be the same to the last digits that either seeks.
TEST(BandOptimizerCeresTest, FromTheSameStartItMostlyEndsWhereCeresDoes) {
  int same = 0, cheaper = 0, dearer = 0;
  for (std::uint64_t seed = 0; seed < kScenes; ++seed) {
    const BandScene scene = MakeBandScene(seed);
    BandOptimizer band(scene.model, {});
    BandCurve ours = StraightBand(), theirs = ours;
    band.Prepare(ours, scene.request, scene.bodies, true);
    double last = band.Cost(ours);
    double cost = band.Relax(ours, 100);
    for (int again = 0; again < 20 && cost < (1.0 - 1e-6) * last; ++again) {
      last = cost;
      cost = band.Relax(ours, 100);
    }
    const CeresAnswer answer = RelaxByCeres(scene, {}, 300, 1e-6, theirs);
    EXPECT_NEAR(band.Cost(theirs), answer.after, 1e-6 * answer.after) << seed;
    const double ratio = cost / answer.after;
    ++(ratio < 0.99 ? cheaper : ratio > 1.01 ? dearer : same);
  }
  EXPECT_GE(same, 10);
  EXPECT_LE(dearer, 8);
  RecordProperty("same", same);
  RecordProperty("cheaper", cheaper);
  RecordProperty("dearer", dearer);
}

}  // namespace band_optimizer_ceres_test
}  // namespace oca::planning::test
