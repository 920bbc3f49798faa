// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/graph.h"
#include "oca/framework/dataflow/error.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/terminal.h"

namespace oca::tools {
namespace {

/// Graphviz lays out; it is a program, so that nobody needs it who does not draw.
int PrintSvg(const std::string& dot) {
  std::fflush(stdout);
  std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen("dot -Tsvg", "w"), pclose);
  if (!pipe) throw ConfigError("graph: cannot start `dot`");
  std::fwrite(dot.data(), 1, dot.size(), pipe.get());
  if (pclose(pipe.release()) != 0) throw ConfigError("graph: `dot` failed");
  return kFine;
}

bool HasGraphviz() { return std::system("command -v dot > /dev/null 2>&1") == 0; }

}  // namespace

int GraphCommand(const GraphArguments& arguments, const files::Catalogue& catalogue) {
  std::vector<files::Override> overrides;
  for (const std::string& text : arguments.overrides) {
    overrides.push_back(files::Override::Parse(text));
  }
  const loading::LoadedDiagram loaded = loading::LoadDiagram(arguments.file, overrides, catalogue);
  if (arguments.format == "mermaid") {
    WriteData(runs::MermaidGraph(loaded));
  } else if (arguments.format == "dot") {
    WriteData(runs::DotGraph(loaded));
  } else {
    if (!HasGraphviz()) {
      throw ConfigError("graph: svg needs the program `dot` (apt-get install graphviz)");
    }
    return PrintSvg(runs::DotGraph(loaded));
  }
  return kFine;
}

}  // namespace oca::tools
