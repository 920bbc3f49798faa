// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/framework/dataflow/error_base.h"

namespace oca::models {

/// A robot description, a mesh or a shape is wrong. The text reads
/// `where: what; got X; expected Y` and `where` names the file and the element.
struct ModelError : Error {
  using Error::Error;
};

}  // namespace oca::models
