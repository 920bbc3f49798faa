// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace oca::geometry::internal {

/// What LZF has compressed to `bytes`, if that gives `size` bytes exactly; none if it is damaged.
/// Takes memory only for as much as so many bytes can hold.
/// source Lehmann, LibLZF
std::optional<std::string> DecompressLzf(std::string_view bytes, std::size_t size);

}  // namespace oca::geometry::internal
