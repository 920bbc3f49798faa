// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <map>
#include <memory>

#include "diagrams/loader.h"
#include "framework/dynamic_port.h"
#include "framework/error.h"
#include "tools/commands.h"

namespace oca::tools {
namespace {

struct Edge {
  std::string from, output, to, input;
  bool state;
};

std::vector<Edge> EdgesOf(const diagrams::LoadedDiagram& loaded) {
  std::map<const System*, std::string> names;
  for (const Diagram::Child& child : loaded.diagram->children()) {
    names[child.system.get()] = child.name;
  }
  std::vector<Edge> edges;
  for (const Diagram::Connection& connection : loaded.diagram->connections()) {
    edges.push_back(
        {names[connection.from.system],
         connection.from.system->outputs()[connection.from.index].name, names[connection.to.system],
         connection.to.system->inputs()[connection.to.index].name, ShowsState(connection.from)});
  }
  return edges;
}

/// Inside the quotes of DOT.
std::string Escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '"' || c == '\\') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

/// Solid: computed within the instant. Dashed: a held state, which is what closes loops.
std::string Dot(const diagrams::LoadedDiagram& loaded) {
  std::string dot = fmt::format(
      "digraph \"{}\" {{\n  rankdir=TB; bgcolor=white; nodesep=0.25; ranksep=0.45;\n"
      "  node [shape=box, style=\"rounded,filled\", fillcolor=\"#eef3fa\", color=\"#4a6fa5\", "
      "fontname=Helvetica, fontsize=12, margin=\"0.15,0.08\"];\n"
      "  edge [color=\"#555555\", fontname=Helvetica, fontsize=9, fontcolor=\"#333333\", "
      "arrowsize=0.7];\n",
      Escaped(loaded.name));
  for (const auto& block : loaded.systems) {
    dot += fmt::format(
        "  \"{}\" [label=<<b>{}</b><br/><font point-size=\"10\" color=\"#555555\">{}</font>>];\n",
        block.name, block.name, block.type);
  }
  for (const Edge& edge : EdgesOf(loaded)) {
    const std::string label =
        edge.output == edge.input ? edge.output : edge.output + " → " + edge.input;
    dot += fmt::format("  \"{}\" -> \"{}\" [label=\"{}\"{}];\n", edge.from, edge.to, label,
                       edge.state ? ", style=dashed" : "");
  }
  return dot + "}\n";
}

std::string Mermaid(const diagrams::LoadedDiagram& loaded) {
  std::string text = "flowchart LR\n";
  for (const auto& block : loaded.systems) {
    text += fmt::format("  s_{0}[\"{0}<br/><small>{1}</small>\"]\n", block.name, block.type);
  }
  for (const Edge& edge : EdgesOf(loaded)) {
    text += fmt::format("  s_{} {}|{} → {}| s_{}\n", edge.from, edge.state ? "-.->" : "-->",
                        edge.output, edge.input, edge.to);
  }
  return text;
}

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

int GraphCommand(const GraphArguments& arguments, const diagrams::Catalogue& catalogue) {
  std::vector<diagrams::Override> overrides;
  for (const std::string& text : arguments.overrides) {
    overrides.push_back(diagrams::Override::Parse(text));
  }
  const diagrams::LoadedDiagram loaded =
      diagrams::LoadDiagram(arguments.file, overrides, catalogue);
  if (arguments.format == "mermaid") {
    std::cout << Mermaid(loaded);
  } else if (arguments.format == "dot") {
    std::cout << Dot(loaded);
  } else {
    if (!HasGraphviz()) {
      throw ConfigError("graph: svg needs the program `dot` (apt-get install graphviz)");
    }
    return PrintSvg(Dot(loaded));
  }
  return kFine;
}

}  // namespace oca::tools
