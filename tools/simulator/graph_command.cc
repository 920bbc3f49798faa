// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>

#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "tools/simulator/commands.h"

namespace oca::tools {
namespace {

struct Edge {
  std::string from, output, to, input;
  bool state;
};

/// All connections between leaves, reader by reader.
std::vector<Edge> EdgesOf(const Diagram& diagram) {
  std::vector<Edge> edges;
  for (const Diagram::Leaf& leaf : diagram.systems()) {
    for (const auto& [from, to] : diagram.DriversOf(*leaf.system)) {
      edges.push_back({diagram.PathOf(*from.system),
                       from.system->outputs()[static_cast<std::size_t>(from.index)].name, leaf.path,
                       to.system->inputs()[static_cast<std::size_t>(to.index)].name,
                       ShowsState(from)});
    }
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

/// Whether a path is that of a system of the file that is used at `prefix`, not deeper.
bool IsAt(const std::string& prefix, const std::string& path) {
  return path.starts_with(prefix) && path.find('.', prefix.size()) == std::string::npos;
}

/// Goes through the systems, file by file: calls system(block, name in its file), open(used file,
/// its name), close().
template <class OnSystem, class OnOpen, class OnClose>
void VisitFiles(const loading::LoadedDiagram& loaded, const std::string& prefix,
                const OnSystem& system, const OnOpen& open, const OnClose& close) {
  for (const auto& block : loaded.systems) {
    if (IsAt(prefix, block.name)) system(block, block.name.substr(prefix.size()));
  }
  for (const auto& used : loaded.used_files) {
    if (!IsAt(prefix, used.path)) continue;
    open(used, used.path.substr(prefix.size()));
    VisitFiles(loaded, used.path + ".", system, open, close);
    close();
  }
}

/// Solid: computed within the instant. Dashed: a held state, which is what closes loops.
std::string Dot(const loading::LoadedDiagram& loaded) {
  std::string dot = fmt::format(
      "digraph \"{}\" {{\n  rankdir=TB; bgcolor=white; nodesep=0.25; ranksep=0.45;\n"
      "  node [shape=box, style=\"rounded,filled\", fillcolor=\"#eef3fa\", color=\"#4a6fa5\", "
      "fontname=Helvetica, fontsize=12, margin=\"0.15,0.08\"];\n"
      "  edge [color=\"#555555\", fontname=Helvetica, fontsize=9, fontcolor=\"#333333\", "
      "arrowsize=0.7];\n",
      Escaped(loaded.name));
  const auto system = [&](const auto& block, const std::string& name) {
    dot += fmt::format(
        "  \"{}\" [label=<<b>{}</b><br/><font point-size=\"10\" color=\"#555555\">{}</font>>];\n",
        block.name, name, block.type);
  };
  const auto open = [&](const auto& used, const std::string& name) {
    dot += fmt::format(
        "  subgraph \"cluster_{}\" {{ label=<<b>{}</b> <font point-size=\"10\">{}</font>>; "
        "fontname=Helvetica; fontcolor=\"#333333\"; color=\"#b0bccd\"; style=rounded;\n",
        used.path, name, Escaped(std::filesystem::path(used.file).filename().string()));
  };
  VisitFiles(loaded, "", system, open, [&] { dot += "  }\n"; });
  for (const Edge& edge : EdgesOf(*loaded.diagram)) {
    const std::string label =
        edge.output == edge.input ? edge.output : edge.output + " → " + edge.input;
    dot += fmt::format("  \"{}\" -> \"{}\" [label=\"{}\"{}];\n", edge.from, edge.to, label,
                       edge.state ? ", style=dashed" : "");
  }
  return dot + "}\n";
}

/// A name that Mermaid takes; its own has dots where diagrams nest.
std::string Id(std::string path) {
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', dot)) {
    path.replace(dot, 1, "__");
  }
  return "s_" + path;
}

std::string Mermaid(const loading::LoadedDiagram& loaded) {
  std::string text = "flowchart LR\n";
  const auto system = [&](const auto& block, const std::string& name) {
    text += fmt::format("  {}[\"{}<br/><small>{}</small>\"]\n", Id(block.name), name, block.type);
  };
  const auto open = [&](const auto& used, const std::string& name) {
    text += fmt::format("  subgraph {}[\"{}\"]\n", Id(used.path), name);
  };
  VisitFiles(loaded, "", system, open, [&] { text += "  end\n"; });
  for (const Edge& edge : EdgesOf(*loaded.diagram)) {
    text += fmt::format("  {} {}|{} → {}| {}\n", Id(edge.from), edge.state ? "-.->" : "-->",
                        edge.output, edge.input, Id(edge.to));
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

int GraphCommand(const GraphArguments& arguments, const files::Catalogue& catalogue) {
  std::vector<files::Override> overrides;
  for (const std::string& text : arguments.overrides) {
    overrides.push_back(files::Override::Parse(text));
  }
  const loading::LoadedDiagram loaded = loading::LoadDiagram(arguments.file, overrides, catalogue);
  if (arguments.format == "mermaid") {
    WriteData(Mermaid(loaded));
  } else if (arguments.format == "dot") {
    WriteData(Dot(loaded));
  } else {
    if (!HasGraphviz()) {
      throw ConfigError("graph: svg needs the program `dot` (apt-get install graphviz)");
    }
    return PrintSvg(Dot(loaded));
  }
  return kFine;
}

}  // namespace oca::tools
