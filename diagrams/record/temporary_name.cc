// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/temporary_name.h"

#include <fmt/format.h>

#include <cstdlib>
#include <system_error>

#include "oca/framework/dataflow/error.h"

namespace oca::record::internal {

std::filesystem::path TemporaryFolder() {
  std::error_code error;
  auto folder = std::filesystem::temp_directory_path(error);
  if (!error) return folder;
  const char* const named = std::getenv("TMPDIR");
  throw ConfigError(fmt::format("TMPDIR: got {}; expected a folder for temporary files",
                                named == nullptr ? "no /tmp" : named));
}

std::string TemporaryName(const std::string& stem) {
  return (TemporaryFolder() / (stem + "_XXXXXX")).string();
}

}  // namespace oca::record::internal
