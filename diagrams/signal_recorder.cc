// SPDX-License-Identifier: BSD-3-Clause
#include "diagrams/signal_recorder.h"

#include <fmt/format.h>

#include <iterator>

#include "framework/dynamic_port.h"
#include "framework/error.h"

namespace oca::diagrams {

SignalRecorder::SignalRecorder(const std::filesystem::path& folder,
                               const std::vector<RecordedSignal>& signals, Simulator& simulator) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw ConfigError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
  }
  for (const RecordedSignal& signal : signals) {
    auto file = std::make_unique<File>();
    file->output = signal.output;
    file->vector = &TypeOfPort(signal.output) == &kVectorType;
    file->path = folder / (signal.name + (file->vector ? ".csv" : ".jsonl"));
    file->stream.open(file->path, std::ios::trunc);
    if (!file->stream) {
      throw ConfigError(fmt::format("{}: cannot be written", file->path.string()));
    }
    if (file->vector) {
      const std::string port = signal.name.substr(signal.name.find('.') + 1);
      file->stream << "time";
      const int size = VectorSize(signal.output, simulator.context());
      for (int i = 0; i < size; ++i) file->stream << fmt::format(",{}[{}]", port, i);
      file->stream << '\n';
    }
    simulator.AddPublish(signal.period, [this, target = file.get()](const Context& context) {
      Write(*target, context);
    });
    files_.push_back(std::move(file));
  }
}

SignalRecorder::~SignalRecorder() = default;

void SignalRecorder::Write(File& file, const Context& context) {
  std::string& line = file.line;
  line.clear();
  if (file.vector) {
    fmt::format_to(std::back_inserter(line), "{}", context.time());
    for (const double value : EvalVector(file.output, context)) {
      fmt::format_to(std::back_inserter(line), ",{}", value);
    }
  } else {
    fmt::format_to(std::back_inserter(line), "{{\"time\":{},\"value\":", context.time());
    EvalJson(file.output, context, line);
    line += '}';
  }
  line += '\n';
  file.stream.write(line.data(), static_cast<std::streamsize>(line.size()));
}

void SignalRecorder::Finish() {
  for (const auto& file : files_) {
    file->stream.close();
    if (!file->stream) {
      throw ConfigError(
          fmt::format("{}: could not be written to the end (disk full?)", file->path.string()));
    }
  }
}

}  // namespace oca::diagrams
