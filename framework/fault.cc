// SPDX-License-Identifier: BSD-3-Clause
#include "framework/fault.h"

#include "framework/fixed_text.h"

namespace oca {

Fault::Fault(std::string_view text) noexcept { CopyText(text, text_); }

}  // namespace oca
