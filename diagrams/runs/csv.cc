// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/csv.h"

#include <algorithm>
#include <optional>

#include "oca/diagrams/runs/signal_facts.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"

namespace oca::runs {
namespace {

/// `proximities` of `left.distance.proximities`
std::string PortOf(const std::string& signal) { return signal.substr(signal.rfind('.') + 1); }

bool IsVector(const files::RecordedSignal& signal) {
  return &TypeOfPort(signal.output) == &kVectorType;
}

}  // namespace

std::vector<OutputFile> Csv::Files(const loading::LoadedDiagram& loaded) const {
  std::vector<OutputFile> files{{"csv", folder_, true}};
  for (const files::RecordedSignal& signal : loaded.record) {
    files.push_back({"csv", SignalTable::FileOf(folder_, signal.name, IsVector(signal))});
  }
  return files;
}

void Csv::Prepare(const RunStart& run) {
  if (!run.loaded.record.empty()) return;
  throw ConfigError(
      "csv: section `record`; got no signals, so there is nothing to write; expected some, as in "
      "`-s 'record.signals={\"*\": 100}'`, which takes all of them a hundred times a second");
}

Csv::File& Csv::Add(const files::RecordedSignal& signal, const loading::LoadedDiagram& loaded,
                    const std::vector<std::string>& joints) {
  std::optional<std::vector<std::string>> columns;
  if (IsVector(signal)) {
    columns = SignalTable::Columns(signal.name.substr(signal.name.rfind('.') + 1),
                                   loaded.diagram->SizeOf(signal.output), joints);
  }
  files_.emplace_back(
      new File{signal.name, columns.has_value(), SignalTable(folder_, signal.name, columns)});
  return *files_.back();
}

Csv::File* Csv::Find(const std::string& signal) const {
  const auto found = std::find_if(files_.begin(), files_.end(),
                                  [&](const auto& file) { return file->signal == signal; });
  return found == files_.end() ? nullptr : found->get();
}

void Csv::Begin(const RunStart& run) {
  if (!run.continued) files_.clear();
  MakeFolder(folder_);
  const SignalFacts facts(run.loaded);
  for (const files::RecordedSignal& signal : run.loaded.record) {
    File* file = Find(signal.name);
    if (file == nullptr && run.continued) continue;
    if (file == nullptr) file = &Add(signal, run.loaded, facts.JointsOf(signal.output));
    file->output = signal.output;
    run.simulator.AddPublish(signal.period,
                             [file](const Context& context) { Write(*file, context); });
  }
}

void Csv::Write(File& file, const Context& context) {
  const std::int64_t time = Nanoseconds(context.time());
  if (time == file.time) return;  // where a run goes on with another diagram
  file.time = time;
  if (file.vector) {
    const auto& numbers = EvalVector(file.output, context);
    file.numbers.assign(numbers.begin(), numbers.end());
    file.table.Write(time, file.numbers);
  } else {
    file.json.clear();
    EvalJson(file.output, context, file.json);
    MakeObject(file.json, 0, PortOf(file.signal));
    file.table.Write(time, file.json);
  }
}

void Csv::End(const RunResult& /*result*/) {
  for (const auto& file : files_) file->table.Finish();
}

}  // namespace oca::runs
