// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

namespace oca::models {

/// Random numbers that are the same on every machine, which the standard's distributions are not.
///
/// SplitMix64: the state goes up by a fixed odd number, the output is a hash of it, so that every
/// 64-bit seed gives a sequence of its own.
/// source Steele, Lea, Flood, Fast Splittable Pseudorandom Number Generators, OOPSLA 2014
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t Bits() { return Mix(state_ += 0x9E3779B97F4A7C15u); }
  /// Uniform in [0, 1), a multiple of 2^-53.
  double Unit() { return static_cast<double>(Bits() >> 11) * 0x1p-53; }
  double Uniform(double lower, double upper) { return lower + Unit() * (upper - lower); }
  /// Uniform among 0, ..., count - 1; 1 <= count < 2^32.
  std::uint64_t Below(std::uint64_t count) { return ((Bits() >> 32) * count) >> 32; }

  /// A seed made of a seed and a number, or a text, that says which of many it is.
  static std::uint64_t Seed(std::uint64_t seed, std::uint64_t which) {
    return Mix(Mix(seed + 0x9E3779B97F4A7C15u) ^ which);
  }
  static std::uint64_t Seed(std::uint64_t seed, std::string_view which) {
    std::uint64_t hash = 0xCBF29CE484222325u;  // FNV-1a
    for (const char letter : which) {
      hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001B3u;
    }
    return Seed(seed, hash);
  }

 private:
  static std::uint64_t Mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace oca::models
