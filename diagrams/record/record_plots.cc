// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/record_plots.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <set>
#include <utility>

#include "oca/diagrams/record/mcap_reader.h"
#include "oca/diagrams/record/series.h"
#include "oca/diagrams/record/temporary_name.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/whole_file.h"

namespace oca::record {
namespace {

namespace fs = std::filesystem;

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

/// librsvg's rsvg-convert makes the pixels, two a unit.
void WritePng(const fs::path& file, const std::string& svg) {
  models::WholeFile pixels(file);
  models::UnfinishedFile drawing(internal::TemporaryFolder());
  models::WriteWhole(drawing.path(), svg);
  const int status = RunProgram(
      {"rsvg-convert", "--zoom=2", "-o", pixels.part().string(), drawing.path().string()});
  if (status == 127) {
    throw ConfigError(fmt::format(
        "{}: PNG needs rsvg-convert (package librsvg2-bin); or name a .svg file", file.string()));
  }
  if (status != 0) throw ConfigError(fmt::format("{}: cannot be written", file.string()));
  pixels.Commit();
}

}  // namespace

std::vector<PlotPanel> SignalPanels(const std::vector<std::string>& records,
                                    const std::vector<std::string>& patterns) {
  std::vector<PlotPanel> panels;
  for (const std::string& pattern : patterns) {
    panels.push_back({pattern, "time [s]", ""});
  }
  for (std::size_t run = 0; run < records.size(); ++run) {
    const McapFile file = McapFile::Read(records[run]);
    for (std::size_t i = 0; i < panels.size(); ++i) {
      std::set<std::string> units;
      int colour = 0;
      std::vector<Series> all = ReadSeries(file, patterns[i]);
      const bool one = std::all_of(all.begin(), all.end(), [&](const Series& series) {
        return series.signal == all.front().signal;
      });
      for (Series& series : all) {
        if (!series.unit.empty()) units.insert(series.unit);
        // Without system and port, which the title names, unless it stands for several.
        std::string label = series.name.substr(one ? series.signal.size() : 0);
        if (label.starts_with('.')) label.erase(0, 1);
        if (label.empty()) label = series.name;
        if (records.size() > 1) {
          label.insert(0, fs::path(records[run]).stem().string() + " ");
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

void WritePlot(const fs::path& file, const std::vector<PlotPanel>& panels) {
  if (file.extension() != ".svg" && file.extension() != ".png") {
    throw ConfigError(
        fmt::format("plot: file; got '{}'; expected a .svg or .png file", file.string()));
  }
  const std::string svg = SvgPlot(panels);
  if (file.extension() == ".svg") {
    models::WriteWhole(file, svg);
  } else {
    WritePng(file, svg);
  }
}

}  // namespace oca::record
