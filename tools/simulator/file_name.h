// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace oca::tools {

/// For options that name a file or folder to write: without a name nothing would be written, and
/// nobody told.
CLI::Validator FileName();

}  // namespace oca::tools
