// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace oca::robot::xacro {

/// What one expansion may take, whatever its files say: they may come from anybody.
class Budget {
 public:
  static constexpr int kDeepest = 500;                   ///< calls, elements, expressions
  static constexpr std::size_t kMostElements = 200'000;  ///< written
  static constexpr std::size_t kMostFiles = 1000;        ///< read
  static constexpr std::size_t kMostWork = 400'000'000;  ///< bytes of values and texts

  /// throws Mistake beyond the bound
  void CountElement();
  void CountFile();
  void Spend(std::size_t bytes);

  /// One level deeper while it lives. throws Mistake beyond kDeepest
  class Level {
   public:
    explicit Level(Budget& budget);
    ~Level() { --budget_.depth_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;

   private:
    Budget& budget_;
  };

 private:
  int depth_{0};
  std::size_t elements_{0};
  std::size_t files_{0};
  std::size_t work_{0};
};

}  // namespace oca::robot::xacro
