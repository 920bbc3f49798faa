// SPDX-License-Identifier: BSD-3-Clause
#include "systems/elastic_band.h"

#include <gtest/gtest.h>

namespace oca::systems {
namespace {

TEST(ElasticBandTest, RefusesToPlanMoreOftenThanItControls) {
  EXPECT_THROW(ElasticBand({.period = Period(1, 10)}, {}), std::exception);
}

}  // namespace
}  // namespace oca::systems
