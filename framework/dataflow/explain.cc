// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/explain.h"

#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

namespace oca::internal {

std::string Explain(const std::exception& error) {
  const auto is = [&error](auto* kind) { return dynamic_cast<decltype(kind)>(&error) != nullptr; };
  if (is(static_cast<const std::bad_alloc*>(nullptr)) ||
      is(static_cast<const std::length_error*>(nullptr))) {
    return "memory; got a demand for more than there is; expected smaller inputs";
  }
  if (const auto* const file = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
    const std::string path = file->path1().string();
    return (path.empty() ? "files" : path) + ": " + file->code().message();
  }
  std::string what = error.what();
  if (is(static_cast<const nlohmann::json::exception*>(nullptr))) {
    const std::size_t own = what.find("] ");
    return "JSON: " + (own == std::string::npos ? what : what.substr(own + 2));
  }
  if (is(static_cast<const std::out_of_range*>(nullptr))) {
    return "a fault in the program itself (" + what + ")";
  }
  return what;
}

}  // namespace oca::internal
