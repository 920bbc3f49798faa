// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "tools/bench/engine_blocks.h"

namespace oca::bench {

// What a row cannot be faster than: its arithmetic on std::array through virtual calls in planned
// order, with no ports, no caching, no checks and no clock.

template <std::size_t N>
using Values = std::array<double, N>;
using Array7 = Values<kWidth>;

class FloorBlock {
 public:
  virtual ~FloorBlock() = default;
  virtual void Calc(double t, const Array7& u, Array7& y) const = 0;
};

class FloorTrivial final : public FloorBlock {
 public:
  void Calc(double /*t*/, const Array7& u, Array7& y) const override {
    for (int i = 0; i < kWidth; ++i) y[i] = 0.999 * u[i] + 0.001;
  }
};

class FloorRamp final : public FloorBlock {
 public:
  void Calc(double t, const Array7& /*u*/, Array7& y) const override {
    for (int i = 0; i < kWidth; ++i) y[i] = (i + 1) * 0.01 * t;
  }
};

class FloorLimiter final : public FloorBlock {
 public:
  void Calc(double /*t*/, const Array7& u, Array7& y) const override {
    for (int i = 0; i < kWidth; ++i) {
      y[i] = std::clamp(y[i] + std::clamp(u[i] - y[i], -1e-3, 1e-3), -2.9, 2.9);
    }
  }
};

template <std::size_t N>
class FloorPlant {
 public:
  virtual ~FloorPlant() = default;
  virtual void Derivative(const Array7& u, const Values<N>& x, Values<N>& xdot) const = 0;
};

class FloorIntegrator final : public FloorPlant<kWidth> {
 public:
  void Derivative(const Array7& u, const Array7& /*x*/, Array7& xdot) const override { xdot = u; }
};

class FloorServo final : public FloorPlant<2 * kWidth> {
 public:
  void Derivative(const Array7& u, const Values<2 * kWidth>& x,
                  Values<2 * kWidth>& xdot) const override {
    for (int i = 0; i < kWidth; ++i) {
      xdot[i] = x[kWidth + i];
      xdot[kWidth + i] = 400.0 * (u[i] - x[i]) - 40.0 * x[kWidth + i];
    }
  }
};

/// One step of Dormand and Prince's method of order 5, six derivatives, no error estimate.
template <std::size_t N>
void FloorStep(const FloorPlant<N>& plant, const Array7& u, double h, Values<N>& x) {
  static constexpr std::array<std::array<double, 6>, 6> kWeights{
      {{1. / 5},
       {3. / 40, 9. / 40},
       {44. / 45, -56. / 15, 32. / 9},
       {19372. / 6561, -25360. / 2187, 64448. / 6561, -212. / 729},
       {9017. / 3168, -355. / 33, 46732. / 5247, 49. / 176, -5103. / 18656},
       {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84}}};
  std::array<Values<N>, 6> slope;
  Values<N> at = x;
  for (std::size_t stage = 0; stage < 6; ++stage) {
    plant.Derivative(u, at, slope[stage]);
    at = x;
    for (std::size_t j = 0; j <= stage; ++j) {
      if (kWeights[stage][j] == 0.0) continue;
      const double weight = h * kWeights[stage][j];
      for (std::size_t i = 0; i < N; ++i) at[i] += weight * slope[j][i];
    }
  }
  x = at;
}

}  // namespace oca::bench
