// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/report_figures.h"

#include <filesystem>
#include <utility>

#include "oca/diagrams/files/data_folders.h"
#include "oca/diagrams/record/plot_hints.h"
#include "oca/diagrams/runs/in_memory.h"
#include "oca/diagrams/runs/run.h"
#include "oca/diagrams/runs/signal_facts.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/repulsive_law.h"

namespace oca::record {
namespace {

namespace fs = std::filesystem;

/// A diagram file that comes with OCA.
fs::path OwnDiagram(const std::string& name) {
  for (const fs::path& data : files::DataFolders()) {
    std::error_code error;
    if (fs::exists(data / "diagrams" / name, error)) return data / "diagrams" / name;
  }
  return name;  // which is then said to be missing
}

/// Joints over time, of one of the plots that the diagram deserves.
struct JointPlot {
  const char* title;
  const char* hint;
};

std::vector<PlotPanel> JointPanels(const std::string& diagram,
                                   const std::vector<files::Override>& overrides,
                                   const std::vector<JointPlot>& plots) {
  const loading::LoadedDiagram loaded = loading::LoadDiagram(OwnDiagram(diagram), overrides);
  std::vector<OutputHandle> outputs;
  std::vector<std::string> signals;
  for (const JointPlot& plot : plots) {
    for (const PlotHint& hint : PlotHintsOf(loaded)) {
      if (hint.id == plot.hint) outputs.push_back(hint.outputs.at(0));
    }
    signals.push_back(loaded.diagram->PathOf(outputs.back()));
  }
  runs::InMemory series(signals, Period(1, 100));
  const runs::RunResult result = runs::Run(loaded, {.outputs = {&series}});
  if (result.failure) throw ConfigError(diagram + ": " + result.failure->message);

  const Eigen::VectorXd times = series.times();
  std::vector<PlotPanel> panels;
  for (std::size_t i = 0; i < plots.size(); ++i) {
    PlotPanel panel{plots[i].title, "time [s]", "joint [rad]"};
    const std::vector<std::string> joints = runs::SignalFacts(loaded).JointsOf(outputs[i]);
    const Eigen::MatrixXd values = series.Matrix(signals[i]);
    for (int joint = 0; joint < values.cols(); ++joint) {
      const Eigen::VectorXd column = values.col(joint);
      panel.curves.push_back({joints.at(static_cast<std::size_t>(joint)),
                              {times.begin(), times.end()},
                              {column.begin(), column.end()},
                              joint});
    }
    panels.push_back(std::move(panel));
  }
  return panels;
}

std::vector<PlotPanel> StaticTest(bool limited) {
  std::vector<files::Override> overrides;
  if (!limited) overrides.push_back({"parameters.limit_deltas", "false"});
  return JointPanels("static_test.yaml", overrides,
                     {{"(a) Requested joints, without avoidance", "requested"},
                      {"(b) Deltas of the avoidance", "delta"},
                      {"(c) Final joints, with the deltas", "final"}});
}

/// The law of the field of the report's tests with gain 1 and range 1 m; as there, cut off at 300.
std::vector<PlotPanel> RepulsiveForce() {
  const robot::RepulsiveLaw law{.gain = 1.0, .range = 1.0, .floor = 0.01};
  PlotCurve curve{"F_rep", {}, {}};
  for (int i = 1; i <= 600; ++i) {
    curve.x.push_back(0.002 * i);
    curve.y.push_back(law.Force(curve.x.back()));
  }
  PlotPanel panel{"Repulsive force, gain 1, range 1 m", "distance [m]", "force [N]"};
  panel.curves.push_back(std::move(curve));
  panel.y_min = 0.0;
  panel.y_max = 300.0;
  panel.x_min = 0.0;
  return {panel};
}

}  // namespace

std::vector<std::string> FigureNames() { return {"report-3.5", "report-4.1", "report-4.2"}; }

std::vector<PlotPanel> FigurePanels(const std::string& name) {
  if (name == "report-3.5") return RepulsiveForce();
  if (name == "report-4.1") return StaticTest(false);
  if (name == "report-4.2") return StaticTest(true);
  throw ConfigError("plot: no figure '" + name +
                    "' from runs of our own; expected report-3.5, report-4.1 or report-4.2");
}

}  // namespace oca::record
