// SPDX-License-Identifier: BSD-3-Clause
// What Ctrl-C leaves of the program's commands.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/small_diagram.h"

namespace oca::tools {
namespace interrupt_test {

using nlohmann::json;

class InterruptTest : public CommandLineTest {};

TEST_F(InterruptTest, ARunEndsWithOneHundredAndThirtyAndCompleteRecords) {
  const Ran ran = run("timeout --foreground --preserve-status -s INT 1 $S run " + Small() +
                      " -t 1e6 --json --csv " + run.folder().path().string() + "/csv");
  EXPECT_EQ(ran.status, 130);
  const json result = json::parse(ran.out);
  EXPECT_TRUE(result["interrupted"].get<bool>());
  EXPECT_GT(result["duration"].get<double>(), 0.0);
  const std::string record = run.Read("csv/lag.out.csv");
  EXPECT_EQ(record.back(), '\n');
}

TEST_F(InterruptTest, EveryCommandEndsWithOneHundredAndThirtyAndNoHalfFile) {
  const std::string interrupt = "timeout --foreground --preserve-status -s INT 1 $S ";
  const std::string folder = run.folder().path().string();
  run("mkdir " + folder + "/none; mkfifo " + folder + "/silent");
  for (const std::string& command :
       {"robot check-collisions package://lwr4/lwr4.urdf --samples 99999999 --write-srdf " +
            folder + "/none/a.srdf",
        std::string("eval Gain --params '{\"gain\": 2}'"),
        "scenes package://ur5e/ur5e.urdf --srdf package://ur5e/ur5e.srdf --samples 9999 -o " +
            folder + "/scenes"}) {
    // Opened to be read and written, it neither says anything nor ends.
    EXPECT_EQ(run(interrupt + command + " <> " + folder + "/silent").status, 130) << command;
  }
  EXPECT_EQ(run("ls -A " + folder + "/none").out, "");
}

}  // namespace interrupt_test
}  // namespace oca::tools
