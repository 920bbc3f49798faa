// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace oca {

/// What the calculations of one system took.
struct SystemTime {
  std::string system;  ///< path
  std::int64_t calls;
  double seconds;
};

/// Sums up the time that each system of a schedule takes.
class Profile {
 public:
  struct Entry {
    std::int64_t calls{0};
    std::chrono::steady_clock::duration time{};
  };

  explicit Profile(std::size_t systems) : entries_(systems) {}
  const std::vector<Entry>& entries() const { return entries_; }

  /// Calls `calculation` on account of a system.
  template <class Calculate>
  void Time(int system, const Calculate& calculate) {
    const auto start = std::chrono::steady_clock::now();
    calculate();
    Entry& entry = entries_[static_cast<std::size_t>(system)];
    entry.time += std::chrono::steady_clock::now() - start;
    ++entry.calls;
  }

 private:
  std::vector<Entry> entries_;
};

}  // namespace oca
