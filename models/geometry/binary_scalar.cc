// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/binary_scalar.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

namespace oca::geometry::internal {
namespace {

template <class T>
double As(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return static_cast<double>(value);
}

}  // namespace

double Decode(const Scalar& scalar, const char* at, bool big_endian) {
  std::array<char, 8> turned;
  if (big_endian != (std::endian::native == std::endian::big)) {
    std::reverse_copy(at, at + scalar.size, turned.begin());
    at = turned.data();
  }
  if (scalar.kind == 'F') return scalar.size == 4 ? As<float>(at) : As<double>(at);
  const bool with_sign = scalar.kind == 'I';
  switch (scalar.size) {
    case 1:
      return with_sign ? As<std::int8_t>(at) : As<std::uint8_t>(at);
    case 2:
      return with_sign ? As<std::int16_t>(at) : As<std::uint16_t>(at);
    case 4:
      return with_sign ? As<std::int32_t>(at) : As<std::uint32_t>(at);
    default:
      return with_sign ? As<std::int64_t>(at) : As<std::uint64_t>(at);
  }
}

}  // namespace oca::geometry::internal
