// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/graph.h"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <vector>

#include "oca/framework/dataflow/dynamic_port.h"

namespace oca::runs {
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

/// A name that Mermaid takes; its own has dots where diagrams nest.
std::string Id(std::string path) {
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', dot)) {
    path.replace(dot, 1, "__");
  }
  return "s_" + path;
}

}  // namespace

std::string DotGraph(const loading::LoadedDiagram& loaded) {
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

std::string MermaidGraph(const loading::LoadedDiagram& loaded) {
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

}  // namespace oca::runs
