// SPDX-License-Identifier: BSD-3-Clause
#include "oca/version.h"

namespace oca {

const char* Version() { return OCA_VERSION; }

}  // namespace oca
