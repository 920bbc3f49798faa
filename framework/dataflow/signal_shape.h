// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/signal.h"

namespace oca {

/// What the JSON of a signal type looks like, learned from a value made by default: all that is
/// known of a type that somebody else defined is the text that it writes.
struct SignalShape {
  enum class Kind { kAny, kNumber, kText, kFlag, kList, kObject };
  Kind kind{Kind::kAny};                                       ///< kAny: null, or an item unknown
  std::vector<std::pair<std::string, SignalShape>> members{};  ///< of an object, in its order
  std::vector<SignalShape> item{};  ///< of a list that is not empty, its first
};

/// Of a type that is no Vector. throws ConfigError if its WriteJson writes no JSON.
SignalShape ShapeOf(const SignalType& type);

/// The number that a value of such a type has as a member; none if it has none of that name.
/// `value` as the type knows it.
std::optional<double> MemberNumber(const SignalType& type, const void* value,
                                   std::string_view member);

}  // namespace oca
