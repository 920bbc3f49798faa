// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/tools/program.h"

namespace oca::tools {

inline constexpr const char* kSmall =
    "name: small\n"
    "simulator: {duration: 0.5, seed: 7}\n"
    "systems:\n"
    "  source: {type: Constant, value: [1, 2]}\n"
    "  lag: {type: FirstOrderLag, time_constant: 0.1}\n"
    "connections: [source.value -> lag.in]\n"
    "record: {signals: {lag.out: 10}}\n"
    "expect: {'lag.out[1]': {at_most: 2}}\n";

/// Runs the program, on a small diagram file too.
class CommandLineTest : public testing::Test {
 protected:
  std::string Small(const std::string& from = "", const std::string& to = "") {
    std::string text = kSmall;
    if (!from.empty()) text.replace(text.find(from), from.size(), to);
    return run.folder().Write("small.yaml", text).string();
  }
  Program run;
};

}  // namespace oca::tools
