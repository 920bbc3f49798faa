// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "oca/framework/simulation/integration_method.h"

namespace oca {

inline constexpr IntegratorKind kAllIntegrators[] = {
    IntegratorKind::kErkDp5,   IntegratorKind::kErkBs3,   IntegratorKind::kCvodeAdams,
    IntegratorKind::kCvodeBdf, IntegratorKind::kFixedDp5, IntegratorKind::kFixedRk4};

/// Those with error control, which choose their steps.
inline constexpr IntegratorKind kAdaptiveIntegrators[] = {
    IntegratorKind::kErkDp5, IntegratorKind::kErkBs3, IntegratorKind::kCvodeAdams,
    IntegratorKind::kCvodeBdf};

inline std::string NameOfKind(const testing::TestParamInfo<IntegratorKind>& info) {
  return EnumNames(info.param)[static_cast<std::size_t>(info.param)];
}

}  // namespace oca
