// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

namespace oca::geometry::internal {

/// Refuses Collada text that assimp would crash on or never end with: it walks elements by recursion,
/// reads the numbers that an <accessor> promises of an array whether the array has them or not, and
/// waits for ever for an index to end that is no number.
/// throws ModelError naming the file
void CheckCollada(const std::filesystem::path& file, std::string_view text);

}  // namespace oca::geometry::internal
