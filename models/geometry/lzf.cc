// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/lzf.h"

#include <cstdint>

namespace oca::geometry::internal {

std::optional<std::string> DecompressLzf(std::string_view bytes, std::size_t size) {
  // Three bytes repeat 264 at most.
  if (size / 88 > bytes.size()) return std::nullopt;
  std::string text;
  text.reserve(size);
  std::size_t at = 0;
  const auto take = [&]() -> std::size_t { return static_cast<std::uint8_t>(bytes[at++]); };
  while (at < bytes.size()) {
    const std::size_t control = take();
    if (control < 32) {  // so many bytes and one more as they are
      const std::size_t count = control + 1;
      if (bytes.size() - at < count || size - text.size() < count) return std::nullopt;
      text.append(bytes.substr(at, count));
      at += count;
      continue;
    }
    std::size_t count = control >> 5;
    if (bytes.size() - at < (count == 7 ? 2u : 1u)) return std::nullopt;
    if (count == 7) count += take();
    count += 2;
    const std::size_t back = ((control & 31) << 8) + take() + 1;
    if (back > text.size() || size - text.size() < count) return std::nullopt;
    for (std::size_t i = 0; i < count; ++i) text.push_back(text[text.size() - back]);
  }
  if (text.size() != size) return std::nullopt;
  return text;
}

}  // namespace oca::geometry::internal
