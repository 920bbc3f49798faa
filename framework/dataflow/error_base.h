// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace oca {

/// Base of every exception that OCA throws on purpose: of the framework's (error.h) and of models
/// (models/error.h), which know nothing else of each other.
/// The text reads `where: what; got X; expected Y`.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace oca
