// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/fault.h"

#include "oca/framework/dataflow/fixed_text.h"

namespace oca {

Fault::Fault(std::string_view text) noexcept { CopyText(text, text_); }

}  // namespace oca
