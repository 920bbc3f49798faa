// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/output_files.h"

#include <fmt/format.h>

#include "oca/framework/dataflow/error.h"

namespace oca::runs {
namespace {

namespace fs = std::filesystem;

bool Same(const fs::path& one, const fs::path& other) {
  std::error_code error;
  if (fs::exists(one, error) && fs::exists(other, error)) {
    return fs::equivalent(one, other, error) && !error && !fs::is_other(one, error);
  }
  const fs::path place = fs::weakly_canonical(fs::absolute(one), error);
  return !error && place == fs::weakly_canonical(fs::absolute(other), error) && !error;
}

[[noreturn]] void Refuse(const OutputFile& output, const std::string& role) {
  throw ConfigError(fmt::format("{}: {} is {}; expected another file to write", output.what,
                                output.path.string(), role));
}

}  // namespace

std::vector<InputFile> InputsOf(const std::vector<fs::path>& files, const std::string& role) {
  std::vector<InputFile> inputs;
  for (const fs::path& file : files) inputs.push_back({file, role});
  return inputs;
}

void CheckOutputs(const std::vector<OutputFile>& outputs, const std::vector<InputFile>& inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].path.empty()) continue;
    for (const InputFile& input : inputs) {
      if (Same(outputs[i].path, input.path)) Refuse(outputs[i], input.role);
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (outputs[j].path.empty() || !Same(outputs[i].path, outputs[j].path)) continue;
      Refuse(outputs[i], "what " + outputs[j].what + " writes");
    }
  }
}

}  // namespace oca::runs
