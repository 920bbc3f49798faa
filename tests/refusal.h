// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace oca::test {

/// What the exception says that a call throws; any that is no E goes on.
template <class E, class Call>
std::string Refusal(const Call& call) {
  try {
    call();
  } catch (const E& error) {
    return error.what();
  }
  return "nothing was refused";
}

}  // namespace oca::test
