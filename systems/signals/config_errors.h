// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"

namespace oca::systems {

/// What `call` returns; a ModelError of it is thrown on as a ConfigError with the same text, for
/// what a block makes of its parameters by the mathematics of models/.
template <class Call>
decltype(auto) WithConfigErrors(Call&& call) {
  try {
    return std::forward<Call>(call)();
  } catch (const models::ModelError& error) {
    throw ConfigError(error.what());
  }
}

}  // namespace oca::systems
