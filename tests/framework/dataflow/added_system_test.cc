// SPDX-License-Identifier: BSD-3-Clause
// A system that cannot be made is named.
#include <gtest/gtest.h>

#include <string>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/params.h"
#include "tests/refusal.h"

namespace oca {
namespace added_system_test {

using test::Refusal;

class Lagging final : public System {
 public:
  struct Params {
    double time_constant{1.0};
    double limit{2.0};
    bool borrows{false};
    static void Describe(Fields<Params>& fields) {
      fields.Add("time_constant", &Params::time_constant, "s", "until 63 %").Above(0.0);
      fields.Add("limit", &Params::limit, "", "of the output");
      fields.Add("borrows", &Params::borrows, "", "whether it shows a state of nobody");
    }
  };
  explicit Lagging(const Params& params) {
    if (params.limit < params.time_constant)
      throw ConfigError("limit: too low\nlimit: too low yet");
    if (params.borrows) AddStateOutput("state", StateHandle{});
  }
};

TEST(AddedSystemTest, WhatAConstructorRefusesIsToldWithTheNameOfItsSystem) {
  DiagramBuilder builder;
  EXPECT_EQ(Refusal<ConfigError>([&] { builder.Add<Lagging>("lag", {.time_constant = -1.0}); }),
            "lag.time_constant: got -1 s; expected > 0");
  EXPECT_EQ(Refusal<ConfigError>([&] { builder.Add<Lagging>("lag", {.time_constant = 3.0}); }),
            "lag: limit: too low\nlag: limit: too low yet");
}

TEST(AddedSystemTest, AWiringErrorOfAConstructorKeepsItsKindAndItsProblems) {
  DiagramBuilder builder;
  try {
    builder.Add<Lagging>("lag", {.borrows = true});
    ADD_FAILURE() << "a state of no system was taken";
  } catch (const WiringError& error) {
    ASSERT_EQ(error.problems.size(), 1u);
    EXPECT_EQ(error.problems[0].ToString(), error.what());
    EXPECT_EQ(std::string(error.what()).rfind("lag: state: ", 0), 0u) << error.what();
  }
}

}  // namespace added_system_test
}  // namespace oca
