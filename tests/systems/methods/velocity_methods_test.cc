// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/velocity_methods.h"

#include <gtest/gtest.h>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/method_scene.h"

namespace oca::systems {
namespace velocity_methods_test {

TEST(VelocityMethodsTest, TheLastLinkIsTheTipUnlessOneIsNamed) {
  const auto model = LoadTestModel("planar2");
  EXPECT_EQ(model->links()[TipNumber(*model, "")].name.text(), "planar2_tip");
  EXPECT_EQ(model->links()[TipNumber(*model, "planar2_link_1")].name.text(), "planar2_link_1");
  EXPECT_THROW(TipNumber(*model, "nose"), ConfigError);
}

}  // namespace velocity_methods_test
}  // namespace oca::systems
