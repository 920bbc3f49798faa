// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace oca::record::internal {

/// Where temporary files go: /tmp, or what TMPDIR says. throws ConfigError if there is no such
/// folder
std::filesystem::path TemporaryFolder();
/// A name for mkdtemp there, `STEM_XXXXXX`. throws as TemporaryFolder
std::string TemporaryName(const std::string& stem);

}  // namespace oca::record::internal
