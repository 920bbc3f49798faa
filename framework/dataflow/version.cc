// SPDX-License-Identifier: BSD-3-Clause
// The version that the library was built as.
#include "oca/version.h"

namespace oca {

const char* Version() { return OCA_VERSION; }

}  // namespace oca
