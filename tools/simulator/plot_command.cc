// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/record_plots.h"
#include "oca/diagrams/record/report_figures.h"
#include "oca/diagrams/runs/output_files.h"
#include "oca/diagrams/sweep/method_figure.h"
#include "oca/framework/dataflow/error.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/record_commands.h"

namespace oca::tools {
namespace {

std::vector<record::PlotPanel> PanelsOf(const PlotArguments& arguments) {
  const bool methods = arguments.figure == "method-comparison";
  if (methods && arguments.records.empty()) {
    throw ConfigError("plot: method-comparison: got no folder; expected some that `sweep` wrote");
  }
  if (methods) return sweep::MethodPanels(arguments.records);
  if (!arguments.figure.empty()) return record::FigurePanels(arguments.figure);
  if (arguments.records.empty() || arguments.signals.empty()) {
    throw ConfigError("plot: got nothing to draw; expected records and --signal, or --figure");
  }
  return record::SignalPanels(arguments.records, arguments.signals);
}

}  // namespace

int PlotCommand(const PlotArguments& arguments) {
  runs::CheckOutputs(
      {{"-o", arguments.output}},
      runs::InputsOf({arguments.records.begin(), arguments.records.end()}, "what is drawn"));
  record::WritePlot(arguments.output, PanelsOf(arguments));
  return kFine;
}

}  // namespace oca::tools
