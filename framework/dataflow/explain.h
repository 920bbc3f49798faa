// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <string>

namespace oca::internal {

/// What an exception says, for a person: of those that the standard library and the reader of JSON
/// throw, which name functions of their own, in words of ours.
std::string Explain(const std::exception& error);

}  // namespace oca::internal
