// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/temporary_folder.h"

namespace oca::tools {

/// What running the `simulator` program gave.
struct Ran {
  int status;
  std::string out;
  std::string err;
};

/// Runs shell lines in which `$S` stands for the program; the working directory is the source tree.
class Program {
 public:
  Ran operator()(const std::string& line, const std::string& input = "") const {
    folder_.Write("in", input);
    const std::string place = folder_.path().string();
    const std::string script = std::string("cd " OCA_SOURCE_DIR " && S=" SIMULATOR " && ") + line;
    folder_.Write("script", script);
    const int raw = std::system(
        ("sh " + place + "/script < " + place + "/in > " + place + "/out 2> " + place + "/err")
            .c_str());
    return {WIFEXITED(raw) ? WEXITSTATUS(raw) : -WTERMSIG(raw), Read("out"), Read("err")};
  }
  const test::TemporaryFolder& folder() const { return folder_; }
  std::string Read(const std::string& name) const {
    std::ifstream stream(folder_.path() / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

 private:
  test::TemporaryFolder folder_;
};

}  // namespace oca::tools
