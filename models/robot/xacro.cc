// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xacro.h"

#include <fmt/format.h>

#include <charconv>

#include "oca/models/error.h"
#include "oca/models/robot/xacro/expander.h"
#include "oca/models/robot/xacro/session.h"

namespace oca::robot {

std::string ExpandedXacro::WithPlaces(const std::string& message, const std::string& file) const {
  const std::string start = file + ":";
  std::string result;
  std::size_t from = 0;
  for (std::size_t at = message.find(start); at != std::string::npos;
       at = message.find(start, from)) {
    std::size_t line = 0;
    const char* const first = message.data() + at + start.size();
    const auto [end, error] = std::from_chars(first, message.data() + message.size(), line);
    const bool known = error == std::errc() && line >= 1 && line <= places.size();
    result.append(message, from, at - from);
    result += known ? places[line - 1] : start;
    from = known ? static_cast<std::size_t>(end - message.data()) : at + start.size();
  }
  return result.append(message, from, std::string::npos);
}

bool IsXacro(const std::filesystem::path& file) { return file.extension() == ".xacro"; }

ExpandedXacro ExpandXacro(const std::filesystem::path& file, const XacroOptions& options) {
  xacro::Session session(options);
  try {
    const xacro::Node robot = xacro::Expander(session).Expand(session.Read(file));
    xacro::WrittenNodes written = xacro::WriteNodes(robot);
    return {std::move(written.text), std::move(written.places)};
  } catch (const xacro::Mistake& mistake) {
    throw models::ModelError(fmt::format("{}: {}", file.string(), mistake.what()));
  }
}

}  // namespace oca::robot
