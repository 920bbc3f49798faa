// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <map>
#include <span>
#include <string>

namespace oca {

template <class P>
class Fields;

enum class IntegratorKind { kErkDp5, kErkBs3, kCvodeAdams, kCvodeBdf, kFixedDp5, kFixedRk4 };
std::span<const char* const> EnumNames(IntegratorKind);

/// Error per step that an adaptive integrator may make: absolute + relative |x|.
struct Tolerances {
  double relative{1e-6};
  double absolute{1e-9};  ///< in the unit of the state
  static void Describe(Fields<Tolerances>& fields);
};

/// How continuous states are integrated. Describe leaves `tolerances` out.
struct IntegratorOptions {
  IntegratorKind integrator{IntegratorKind::kErkDp5};
  double relative_tolerance{Tolerances().relative};
  double absolute_tolerance{Tolerances().absolute};
  std::map<std::string, Tolerances> tolerances{};            ///< of single systems, by path
  double max_step{std::numeric_limits<double>::infinity()};  ///< s
  double fixed_step{1e-3};                                   ///< s; of the fixed-step integrators
  int max_steps{100000};                                     ///< between two events
  static void Describe(Fields<IntegratorOptions>& fields);
};

}  // namespace oca
