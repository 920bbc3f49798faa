// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "oca/diagrams/record/mcap_reader.h"
#include "oca/diagrams/record/mcap_sink.h"
#include "oca/diagrams/record/recording.h"
#include "oca/diagrams/runs/run.h"

namespace oca::record::test {

inline constexpr std::uint64_t kEpoch = 1'700'000'000'000'000'000;

/// A diagram of this repository.
inline loading::LoadedDiagram Load(const std::string& name,
                                   const std::vector<files::Override>& overrides = {}) {
  return loading::LoadDiagram(std::string(OCA_SOURCE_DIR "/diagrams/") + name, overrides);
}

struct Recorded {
  runs::RunResult result;
  McapFile file;
};

/// Runs a diagram with a recorder that writes to memory.
inline Recorded RunRecorded(const loading::LoadedDiagram& loaded, runs::RunOptions options = {},
                            Log* log = nullptr) {
  std::ostringstream stream;
  McapSink sink(stream, Compression::kZstd);
  RecorderOptions settings;
  settings.start_epoch = kEpoch;
  Recording recording({&sink}, settings);
  options.outputs.push_back(&recording);
  options.log = log;
  runs::RunResult result = runs::Run(loaded, options);
  return {std::move(result), McapFile::Parse(stream.str(), "memory")};
}

}  // namespace oca::record::test
