// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/signals/signals.h"

namespace oca::test {

template <class T>
std::string WriteText(const T& value) {
  std::string text;
  Signal<T>::WriteJson(value, text);
  return text;
}

/// The message of the refusal; fails the test if there is none.
template <class T>
std::string Refusal(const std::string& text) {
  try {
    Signal<T>::ReadJson(text);
  } catch (const ConfigError& error) {
    return error.what();
  }
  ADD_FAILURE() << "was accepted: " << text;
  return "";
}

/// A set of one box that moves, as WriteText writes it.
inline constexpr const char* kObstacle =
    R"([{"id":"box","shape":{"type":"box","size":[0.2,0.3,0.4]},)"
    R"("pose":{"xyz":[1.0,2.0,3.0],"quaternion":[0.0,0.0,0.0,1.0]},)"
    R"("twist":{"linear":[0.1,0.0,0.0],"angular":[0.0,0.0,0.5]}}])";

}  // namespace oca::test
