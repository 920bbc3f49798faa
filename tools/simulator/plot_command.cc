// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "oca/diagrams/record/series.h"
#include "oca/framework/dataflow/error.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/method_figure.h"
#include "tools/simulator/output_files.h"
#include "tools/simulator/record_commands.h"
#include "tools/simulator/report_figures.h"

namespace oca::tools {
namespace {

namespace fs = std::filesystem;
using record::PlotPanel;

std::vector<PlotPanel> SignalPanels(const PlotArguments& arguments) {
  std::vector<PlotPanel> panels;
  for (const std::string& pattern : arguments.signals) {
    panels.push_back({pattern, "time [s]", ""});
  }
  for (std::size_t run = 0; run < arguments.records.size(); ++run) {
    const record::McapFile file = record::McapFile::Read(arguments.records[run]);
    for (std::size_t i = 0; i < panels.size(); ++i) {
      std::set<std::string> units;
      int colour = 0;
      for (record::Series& series : record::ReadSeries(file, arguments.signals[i])) {
        if (!series.unit.empty()) units.insert(series.unit);
        // Without system and port, which the title names.
        const std::size_t port = series.name.find_first_of(".[", series.name.find('.') + 1);
        std::string label = port == std::string::npos ? series.name : series.name.substr(port);
        if (label.starts_with('.')) label.erase(0, 1);
        if (arguments.records.size() > 1) {
          label.insert(0, fs::path(arguments.records[run]).stem().string() + " ");
        }
        panels[i].curves.push_back({label, std::move(series.times), std::move(series.values),
                                    colour++, static_cast<int>(run)});
      }
      if (units.size() == 1) panels[i].y_label = "[" + *units.begin() + "]";
    }
  }
  for (const PlotPanel& panel : panels) {
    if (!panel.curves.empty()) continue;
    throw ConfigError(
        fmt::format("plot: no recorded signal matches '{}'; `simulator export` shows what there is",
                    panel.title));
  }
  return panels;
}

/// Runs a program without a shell; its exit status, 127 if there is none.
int RunProgram(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) < 0 || !WIFEXITED(status)) return 127;
  return WEXITSTATUS(status);
}

void Write(const fs::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream << text;
  if (!stream.flush()) throw ConfigError(fmt::format("{}: cannot be written", file.string()));
}

/// librsvg's rsvg-convert makes the pixels, two a unit.
void WritePng(const fs::path& file, const std::string& svg) {
  std::string drawing = (fs::temp_directory_path() / "oca_plot_XXXXXX").string();
  const int descriptor = mkstemp(drawing.data());
  if (descriptor < 0) throw ConfigError(fmt::format("{}: cannot be made", drawing));
  close(descriptor);
  Write(drawing, svg);
  const int status = RunProgram({"rsvg-convert", "--zoom=2", "-o", file.string(), drawing});
  fs::remove(drawing);
  if (status == 127) {
    throw ConfigError(fmt::format(
        "{}: PNG needs rsvg-convert (package librsvg2-bin); or name a .svg file", file.string()));
  }
  if (status != 0) throw ConfigError(fmt::format("{}: cannot be written", file.string()));
}

std::vector<PlotPanel> PanelsOf(const PlotArguments& arguments) {
  const bool methods = arguments.figure == "method-comparison";
  if (methods && arguments.records.empty()) {
    throw ConfigError("plot: method-comparison: got no folder; expected some that `sweep` wrote");
  }
  if (methods) return MethodPanels(arguments.records);
  if (!arguments.figure.empty()) return FigurePanels(arguments.figure);
  if (arguments.records.empty() || arguments.signals.empty()) {
    throw ConfigError("plot: got nothing to draw; expected records and --signal, or --figure");
  }
  return SignalPanels(arguments);
}

}  // namespace

int PlotCommand(const PlotArguments& arguments) {
  const fs::path file = arguments.output;
  if (file.extension() != ".svg" && file.extension() != ".png") {
    throw ConfigError(fmt::format("-o: got '{}'; expected a .svg or .png file", file.string()));
  }
  CheckOutputs({{"-o", file}},
               InputsOf({arguments.records.begin(), arguments.records.end()}, "what is drawn"));
  const std::string svg = record::SvgPlot(PanelsOf(arguments));
  if (file.extension() == ".svg") {
    Write(file, svg);
  } else {
    WritePng(file, svg);
  }
  return kFine;
}

}  // namespace oca::tools
