// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/check_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "oca/framework/dataflow/error.h"

namespace oca::internal {

void CheckName(const std::string& name, const char* what) {
  const auto good = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  if (name.empty() || !std::all_of(name.begin(), name.end(), good)) {
    throw WiringError(
        fmt::format("{} name: got '{}'; expected letters, digits and underscores", what, name));
  }
}

void CheckPath(const std::string& path, const char* what) {
  for (std::size_t from = 0; from <= path.size();) {
    const std::size_t dot = std::min(path.find('.', from), path.size());
    CheckName(path.substr(from, dot - from), what);
    from = dot + 1;
  }
}

}  // namespace oca::internal
