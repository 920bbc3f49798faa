// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/yaml_events.h"

#include <gtest/gtest.h>

namespace oca::models::test {
namespace yaml_events_test {

class Deaf final : public internal::YamlEvents {
  void OnNull(const internal::YamlMark&, std::size_t) override {}
  void OnAlias(const internal::YamlMark&, std::size_t) override {}
  void OnScalar(const Node&, const std::string&) override {}
  void OnListStart(const Node&) override {}
  void OnListEnd() override {}
  void OnMapStart(const Node&) override {}
  void OnMapEnd() override {}
};

TEST(YamlEventsTest, WhatIsNoYamlIsAnErrorLikeAllOthersAtItsPlace) {
  Deaf deaf;
  EXPECT_NO_THROW(internal::ReadYamlEvents("a: [1]", deaf));
  try {
    internal::ReadYamlEvents("a: 1\nb: [1", deaf);
    FAIL() << "was read";
  } catch (const Error& error) {
    const auto* const yaml = dynamic_cast<const internal::YamlError*>(&error);
    ASSERT_NE(yaml, nullptr) << error.what();
    EXPECT_GE(yaml->mark.line, 2);
  }
}

}  // namespace yaml_events_test
}  // namespace oca::models::test
