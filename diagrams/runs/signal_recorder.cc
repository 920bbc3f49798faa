// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/signal_recorder.h"

#include <optional>

#include "oca/diagrams/runs/signal_facts.h"
#include "oca/framework/dataflow/dynamic_port.h"

namespace oca::runs {

SignalRecorder::SignalRecorder(const std::filesystem::path& folder,
                               const loading::LoadedDiagram& loaded, Simulator& simulator) {
  MakeFolder(folder);
  const SignalFacts facts(loaded);
  for (const files::RecordedSignal& signal : loaded.record) {
    std::optional<std::vector<std::string>> columns;
    const bool vector = &TypeOfPort(signal.output) == &kVectorType;
    if (vector) {
      columns = SignalTable::Columns(signal.name.substr(signal.name.find('.') + 1),
                                     loaded.diagram->SizeOf(signal.output),
                                     facts.JointsOf(signal.output));
    }
    files_.emplace_back(
        new File{signal.output, vector, SignalTable(folder, signal.name, columns), {}, {}});
    simulator.AddPublish(signal.period, [target = files_.back().get()](const Context& context) {
      Write(*target, context);
    });
  }
}

SignalRecorder::~SignalRecorder() = default;

void SignalRecorder::Write(File& file, const Context& context) {
  const std::int64_t time = Nanoseconds(context.time());
  if (file.vector) {
    const auto& numbers = EvalVector(file.output, context);
    file.numbers.assign(numbers.begin(), numbers.end());
    file.table.Write(time, file.numbers);
  } else {
    file.json.clear();
    EvalJson(file.output, context, file.json);
    file.table.Write(time, file.json);
  }
}

void SignalRecorder::Finish() {
  for (const auto& file : files_) file->table.Finish();
}

std::vector<std::filesystem::path> SignalFiles(const std::filesystem::path& folder,
                                               const loading::LoadedDiagram& loaded) {
  std::vector<std::filesystem::path> files;
  for (const files::RecordedSignal& signal : loaded.record) {
    files.push_back(
        SignalTable::FileOf(folder, signal.name, &TypeOfPort(signal.output) == &kVectorType));
  }
  return files;
}

}  // namespace oca::runs
