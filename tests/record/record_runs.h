// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "diagrams/record/mcap_reader.h"
#include "diagrams/record/run_recorder.h"

namespace oca::record::test {

inline constexpr std::uint64_t kEpoch = 1'700'000'000'000'000'000;

/// A diagram of this repository.
inline diagrams::LoadedDiagram Load(const std::string& name,
                                    const std::vector<diagrams::Override>& overrides = {}) {
  return diagrams::LoadDiagram(std::string(OCA_SOURCE_DIR "/diagrams/") + name, overrides);
}

struct Recorded {
  diagrams::RunResult result;
  McapFile file;
};

/// Runs a diagram with a recorder that writes to memory.
inline Recorded RunRecorded(const diagrams::LoadedDiagram& loaded,
                            diagrams::RunOptions options = {}, Log* log = nullptr) {
  std::ostringstream stream;
  McapSink sink(stream, Compression::kZstd);
  RecorderOptions settings;
  settings.start_epoch = kEpoch;
  RunRecorder recorder(loaded, settings, {&sink}, log);
  options.observers.push_back(&recorder);
  options.log = &recorder;
  diagrams::RunResult result = diagrams::Run(loaded, options);
  return {std::move(result), McapFile::Parse(stream.str(), "memory")};
}

}  // namespace oca::record::test
