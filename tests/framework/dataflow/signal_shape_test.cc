// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/signal_shape.h"

#include <gtest/gtest.h>

#include "oca/framework/dataflow/error.h"

namespace oca {

/// An object with a member of every kind.
struct Weather {
  double wind{2.5};
};
template <>
struct Signal<Weather> {
  static constexpr const char* kName = "Weather";
  static Fault Check(const Weather&, Look) { return {}; }
  static void WriteJson(const Weather& weather, std::string& out) {
    out += R"({"wind":)" + std::to_string(weather.wind) +
           R"(,"sky":"grey","rain":true,"since":null,"hours":[{"at":1}],"gusts":[]})";
  }
  static Weather ReadJson(std::string_view) { return {}; }
};
struct Noise {};
template <>
struct Signal<Noise> {
  static constexpr const char* kName = "Noise";
  static Fault Check(const Noise&, Look) { return {}; }
  static void WriteJson(const Noise&, std::string& out) { out += "nan"; }
  static Noise ReadJson(std::string_view) { return {}; }
};

namespace signal_shape_test {

using Kind = SignalShape::Kind;

TEST(SignalShapeTest, KnowsTheMembersOfATypeAndTheirKindsInOrder) {
  const SignalShape shape = ShapeOf(TypeOf<Weather>());
  ASSERT_EQ(shape.kind, Kind::kObject);
  const std::vector<std::pair<std::string, Kind>> expected{
      {"wind", Kind::kNumber}, {"sky", Kind::kText},   {"rain", Kind::kFlag},
      {"since", Kind::kAny},   {"hours", Kind::kList}, {"gusts", Kind::kList}};
  ASSERT_EQ(shape.members.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(shape.members[i].first, expected[i].first);
    EXPECT_EQ(shape.members[i].second.kind, expected[i].second) << expected[i].first;
  }
  const SignalShape& hours = shape.members[4].second;
  ASSERT_EQ(hours.item.size(), 1u);
  EXPECT_EQ(hours.item[0].members.at(0).first, "at");
  EXPECT_TRUE(shape.members[5].second.item.empty());
}

TEST(SignalShapeTest, FindsANumberOfAValueByItsName) {
  const Weather storm{30.0};
  EXPECT_EQ(MemberNumber(TypeOf<Weather>(), &storm, "wind"), 30.0);
  EXPECT_EQ(MemberNumber(TypeOf<Weather>(), &storm, "sky"), std::nullopt);
  EXPECT_EQ(MemberNumber(TypeOf<Weather>(), &storm, "snow"), std::nullopt);
}

TEST(SignalShapeTest, RefusesATypeThatWritesNoJson) {
  EXPECT_THROW(ShapeOf(TypeOf<Noise>()), ConfigError);
}

}  // namespace signal_shape_test
}  // namespace oca
