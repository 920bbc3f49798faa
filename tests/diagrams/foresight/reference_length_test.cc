// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/foresight/reference_length.h"

#include <gtest/gtest.h>

#include "oca/diagrams/loading/loader.h"

namespace oca::foresight {
namespace reference_length_test {

/// Of searches that end with their first path.
std::optional<double> Length(const std::string& file,
                             const std::vector<files::Override>& overrides = {}) {
  const auto loaded = loading::LoadDiagram(OCA_SOURCE_DIR "/diagrams/" + file, overrides);
  const Foresight scene(*loaded.diagram, loaded.models, "", loaded.simulator.duration);
  return ReferenceLength(scene, 0.0);
}

TEST(ReferenceLengthTest, IsTheStraightWayWhereNothingIsInIt) {
  const auto length = Length("first.yaml", {{"systems.obstacles.obstacles", "[]"}});
  EXPECT_NEAR(length.value(), 2.6, 1e-9);  // of one joint alone
}

TEST(ReferenceLengthTest, IsLongerAroundWhatStandsInIt) {
  const double length = Length("first.yaml").value();
  EXPECT_GT(length, 2.61);
  EXPECT_LT(length, 6.0);
}

TEST(ReferenceLengthTest, IsNoneWhereSomethingMoves) {
  EXPECT_EQ(Length("scenarios/head_on.yaml"), std::nullopt);
}

}  // namespace reference_length_test
}  // namespace oca::foresight
