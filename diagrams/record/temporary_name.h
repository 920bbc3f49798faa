// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace oca::record::internal {

/// A name for mkdtemp and mkstemp, `/tmp/STEM_XXXXXX`. throws ConfigError if there is no folder for it
std::string TemporaryName(const std::string& stem);

}  // namespace oca::record::internal
