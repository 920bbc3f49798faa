// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/file_name.h"

#include <string>

namespace oca::tools {

CLI::Validator FileName() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        return text.empty() ? "got an empty name; expected that of a file or folder" : "";
      },
      "");
}

}  // namespace oca::tools
