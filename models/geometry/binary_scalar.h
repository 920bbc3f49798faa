// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace oca::geometry::internal {

/// A number as files of points keep it.
struct Scalar {
  std::size_t size{0};  ///< bytes: 1, 2, 4 or 8
  char kind{'F'};       ///< F float, I integer, U unsigned
};

/// Its value at `at`, where as many bytes must be.
double Decode(const Scalar& scalar, const char* at, bool big_endian);

}  // namespace oca::geometry::internal
