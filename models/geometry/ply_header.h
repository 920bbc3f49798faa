// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "oca/models/geometry/binary_scalar.h"

namespace oca::geometry::internal {

struct PlyProperty {
  std::string_view name;
  Scalar scalar;
  std::optional<Scalar> count;  ///< of a list: of how long it is
};

struct PlyElement {
  std::string_view name;
  std::uint64_t count{0};
  std::vector<PlyProperty> properties;  ///< each name once
};

/// What a PLY file announces; names are views of its text.
struct PlyHeader {
  static constexpr std::uint64_t kMostElements = 10'000'000;  ///< of a kind
  bool text{true}, big_endian{false};
  std::vector<PlyElement> elements;
  int lines{0};  ///< that the header takes
};

/// Takes the header off `rest`. throws ModelError `file:line: ...`
PlyHeader ReadPlyHeader(const std::filesystem::path& file, std::string_view& rest);

}  // namespace oca::geometry::internal
