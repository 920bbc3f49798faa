// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/temporary_name.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "oca/framework/dataflow/error.h"

namespace oca::record::internal {

std::string TemporaryName(const std::string& stem) {
  std::error_code error;
  const auto folder = std::filesystem::temp_directory_path(error);
  if (!error) return (folder / (stem + "_XXXXXX")).string();
  const char* const named = std::getenv("TMPDIR");
  throw ConfigError(fmt::format("TMPDIR: got {}; expected a folder for temporary files",
                                named == nullptr ? "no /tmp" : named));
}

}  // namespace oca::record::internal
