// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace oca::models {

/// A robot description, a mesh or a shape is wrong. The text reads
/// `where: what; got X; expected Y` and `where` names the file and the element.
struct ModelError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace oca::models
