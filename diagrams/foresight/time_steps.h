// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace oca::foresight {

// The grid of times on which motions and obstacles are searched for what moves.

inline double TimeOfStep(long step) { return static_cast<double>(step) * 1e-3; }  ///< s
inline long StepsOf(double duration) { return static_cast<long>(duration / 1e-3) + 1; }

}  // namespace oca::foresight
