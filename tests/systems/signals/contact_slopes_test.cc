// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/contact_slopes.h"

#include <gtest/gtest.h>

#include <limits>

#include "oca/framework/dataflow/error.h"

namespace oca::systems {
namespace contact_slopes_test {

using SlopesSignal = Signal<ContactSlopes>;

ContactSlopes One() {
  Proximity proximity;
  proximity.link = models::Name("link");
  proximity.point_on_link = {0.1, 0.2, 0.3};
  proximity.point_on_obstacle = {0.1, 0.2, 0.1};
  proximity.normal = {0.0, 0.6, 0.8};
  return {{SlopeAt(proximity, {0.0, 3.0, 4.0}, {1.0, 0.0, 0.0})}};
}

TEST(ContactSlopesTest, SurvivesTheWayThroughJson) {
  std::string text;
  SlopesSignal::WriteJson(One(), text);
  const ContactSlopes back = SlopesSignal::ReadJson(text);
  ASSERT_EQ(back.slopes.size(), 1u);
  EXPECT_EQ(back.slopes[0].link, models::Name("link"));
  EXPECT_EQ(back.slopes[0].point_on_link, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(back.slopes[0].slope, Eigen::Vector3d(0.0, 3.0, 4.0));
  EXPECT_EQ(back.slopes[0].damping, Eigen::Vector3d(1.0, 0.0, 0.0));
}

TEST(ContactSlopesTest, RefusesAMissingKey) {
  EXPECT_THROW(SlopesSignal::ReadJson(R"([{"link": "link"}])"), ConfigError);
}

TEST(ContactSlopesTest, IsNotFiniteWithOneNumberThatIsNot) {
  ContactSlopes value = One();
  EXPECT_TRUE(SlopesSignal::Check(value, Look::kFinite).ok());
  value.slopes[0].damping[2] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(SlopesSignal::Check(value, Look::kFinite).ok());
}

}  // namespace contact_slopes_test
}  // namespace oca::systems
