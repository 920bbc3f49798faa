// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/report_figures.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "oca/diagrams/files/data_folders.h"
#include "oca/diagrams/record/run_recorder.h"
#include "oca/diagrams/record/series.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/systems/fields/repulsive_field.h"

namespace oca::tools {
namespace {

namespace fs = std::filesystem;
using record::PlotCurve;
using record::PlotPanel;

/// A diagram file that comes with OCA.
fs::path OwnDiagram(const std::string& name) {
  for (const fs::path& data : files::DataFolders()) {
    std::error_code error;
    if (fs::exists(data / "diagrams" / name, error)) return data / "diagrams" / name;
  }
  return name;  // which is then said to be missing
}

record::McapFile RunInMemory(const std::string& diagram,
                             const std::vector<files::Override>& overrides) {
  const loading::LoadedDiagram loaded = loading::LoadDiagram(OwnDiagram(diagram), overrides);
  std::ostringstream stream;
  record::McapSink sink(stream, record::Compression::kNone);
  record::RecorderOptions settings;
  settings.attach_files = false;
  record::RunRecorder recorder(loaded, settings, {&sink}, nullptr);
  runs::RunOptions options;
  options.observers.push_back(&recorder);
  const runs::RunResult result = runs::Run(loaded, options);
  if (!result.failure.empty()) throw ConfigError(diagram + ": " + result.failure);
  return record::McapFile::Parse(stream.str(), diagram);
}

/// The joints that a record suggests to plot as `id`.
PlotPanel JointPanel(const record::McapFile& run, const std::string& title, const std::string& id) {
  PlotPanel panel{title, "time [s]", "joint [rad]"};
  const auto hints = nlohmann::json::parse(run.FindMetadata("oca.plots")->at("plots"));
  for (const auto& hint : hints) {
    if (hint["id"] != id) continue;
    std::string signal = hint["topics"][0].get<std::string>().substr(1);
    std::replace(signal.begin(), signal.end(), '/', '.');
    for (record::Series& series : record::ReadSeries(run, signal)) {
      const int colour = static_cast<int>(panel.curves.size());
      const std::string joint = series.name.substr(series.name.rfind('.') + 1);
      panel.curves.push_back({joint, std::move(series.times), std::move(series.values), colour});
    }
  }
  return panel;
}

std::vector<PlotPanel> StaticTest(bool limited) {
  std::vector<files::Override> overrides;
  if (!limited) overrides.push_back({"parameters.limit_deltas", "false"});
  const record::McapFile run = RunInMemory("static_test.yaml", overrides);
  return {JointPanel(run, "(a) Requested joints, without avoidance", "requested"),
          JointPanel(run, "(b) Deltas of the avoidance", "delta"),
          JointPanel(run, "(c) Final joints, with the deltas", "final")};
}

/// What a RepulsiveField with gain 1 and range 1 m answers; as in the report, cut off at 300.
std::vector<PlotPanel> RepulsiveForce() {
  systems::RepulsiveField::Params params = systems::RepulsiveField::Example();
  params.force_gain = 1.0;
  params.max_distance = 1.0;
  const auto diagram = MakeDiagramOf(std::make_unique<systems::RepulsiveField>(params));
  Context context = diagram->MakeContext();
  const auto input = diagram->GetInput<systems::ProximitySet>("proximities");
  const auto output = diagram->GetOutput<systems::LinkForceSet>("forces");
  PlotCurve curve{"F_rep", {}, {}};
  for (int i = 1; i <= 600; ++i) {
    systems::ProximitySet set;
    set.proximities.resize(1);
    set.proximities[0].link = models::Name("link");
    set.proximities[0].obstacle = models::Name("obstacle");
    set.proximities[0].distance = 0.002 * i;
    input.Fix(context, set);
    const auto& forces = output.Eval(context).forces;
    curve.x.push_back(0.002 * i);
    curve.y.push_back(forces.empty() ? 0.0 : forces[0].force.norm());
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

}  // namespace oca::tools
