// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/diagrams/loading/nested_files.h"

namespace oca::runs {
namespace graph_test {

using testing::HasSubstr;

class GraphTest : public loading::nested_files::NestedFiles {
 protected:
  const loading::LoadedDiagram loaded = Load(loading::nested_files::TwoStages());
};

TEST_F(GraphTest, MermaidHasEachFileInAFrameAndHeldStatesDashed) {
  const auto stage = [](const std::string& name) {
    return "  subgraph s_" + name + "[\"" + name + "\"]\n  s_" + name +
           "__gain[\"gain<br/><small>Gain</small>\"]\n  s_" + name +
           "__lag[\"lag<br/><small>FirstOrderLag</small>\"]\n  end\n";
  };
  EXPECT_EQ(MermaidGraph(loaded),
            "flowchart LR\n"
            "  s_source[\"source<br/><small>Constant</small>\"]\n" +
                stage("first") + stage("second") +
                "  s_source -->|value → in| s_first__gain\n"
                "  s_first__gain -->|out → in| s_first__lag\n"
                "  s_first__lag -.->|out → in| s_second__gain\n"
                "  s_second__gain -->|out → in| s_second__lag\n");
}

TEST_F(GraphTest, DotHasTheSame) {
  const std::string dot = DotGraph(loaded);
  EXPECT_THAT(dot, testing::StartsWith("digraph \"row\" {"));
  EXPECT_THAT(dot, HasSubstr("subgraph \"cluster_first\" { label=<<b>first</b> "
                             "<font point-size=\"10\">stage.yaml</font>>"));
  EXPECT_THAT(dot, HasSubstr("  \"source\" -> \"first.gain\" [label=\"value → in\"];\n"));
  EXPECT_THAT(dot, HasSubstr("  \"first.lag\" -> \"second.gain\" [label=\"out → in\", "
                             "style=dashed];\n"));
}

TEST_F(GraphTest, NamesAreEscapedInDot) {
  const auto quoted = Load("name: 'a \"b\" \\ c'\nsystems: {s: {type: Constant, value: [1]}}\n");
  EXPECT_THAT(DotGraph(quoted), testing::StartsWith("digraph \"a \\\"b\\\" \\\\ c\" {"));
}

}  // namespace graph_test
}  // namespace oca::runs
