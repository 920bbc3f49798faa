// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace oca {

/// What the calculations of one system took.
struct SystemTime {
  std::string system;  ///< path
  std::int64_t calls;
  double seconds;
  double slowest{0.0};  ///< s; of one call
  /// Calls by what they took: the middle of a class, s, with their number, ascending; classes
  /// are 6 % wide at most.
  std::vector<std::pair<double, std::int64_t>> times{};
};

/// Sums up the time that each system of a schedule takes.
class Profile {
 public:
  struct Entry {
    /// Sixteen classes an octave, from a nanosecond to half a minute; the last one takes all
    /// beyond.
    static constexpr int kFine = 4;
    static constexpr std::size_t kClasses = 32U << kFine;

    std::int64_t calls{0};
    std::chrono::steady_clock::duration time{};
    std::chrono::steady_clock::duration slowest{};
    std::array<std::uint32_t, kClasses> classes{};

    void Add(std::chrono::steady_clock::duration took) {
      time += took;
      ++calls;
      if (took > slowest) slowest = took;
      ++classes[ClassOf(static_cast<std::uint64_t>(
          std::chrono::duration_cast<std::chrono::nanoseconds>(took).count()))];
    }
    static std::size_t ClassOf(std::uint64_t nanoseconds) {
      if (nanoseconds < (1U << kFine)) return nanoseconds;
      const int octave = std::bit_width(nanoseconds) - 1;
      const std::size_t within = (nanoseconds >> (octave - kFine)) & ((1U << kFine) - 1);
      const std::size_t place = (static_cast<std::size_t>(octave - kFine + 1) << kFine) + within;
      return place < kClasses ? place : kClasses - 1;
    }
    /// Its middle, s.
    static double TimeOf(std::size_t place) {
      if (place < (1U << kFine)) return 1e-9 * static_cast<double>(place);
      const int octave = static_cast<int>(place >> kFine) + kFine - 1;
      const std::size_t within = place & ((1U << kFine) - 1);
      const double width = static_cast<double>(std::uint64_t{1} << (octave - kFine));
      return 1e-9 * width * (static_cast<double>((1U << kFine) + within) + 0.5);
    }
  };

  explicit Profile(std::size_t systems) : entries_(systems) {}
  const std::vector<Entry>& entries() const { return entries_; }

  /// Calls `calculation` on account of a system.
  template <class Calculate>
  void Time(int system, const Calculate& calculate) {
    const auto start = std::chrono::steady_clock::now();
    calculate();
    entries_[static_cast<std::size_t>(system)].Add(std::chrono::steady_clock::now() - start);
  }

 private:
  std::vector<Entry> entries_;
};

}  // namespace oca
