// SPDX-License-Identifier: BSD-3-Clause
#include "framework/integrator_options.h"

namespace oca {

std::span<const char* const> EnumNames(IntegratorKind) {
  static constexpr const char* kNames[] = {"erk_dp5",   "erk_bs3",   "cvode_adams",
                                           "cvode_bdf", "fixed_dp5", "fixed_rk4"};
  return kNames;
}

}  // namespace oca
