// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>

#include <string>

#include "oca/models/error.h"
#include "oca/models/robot/xacro.h"
#include "tests/temporary_folder.h"

namespace oca::robot::test {

/// Xacro files in a folder of their own, and what becomes of them.
class XacroFixture : public testing::Test {
 protected:
  /// Writes a file of the folder whose root element holds `content`.
  std::string Put(const std::string& name, const std::string& content) {
    return folder
        .Write(name, "<robot name='r' xmlns:xacro='http://wiki.ros.org/xacro'>\n" + content +
                         "\n</robot>\n")
        .string();
  }
  /// What is in the root element of the expanded file, without line ends and indentation.
  std::string Expanded(const std::string& content) { return Inside(Put("main.xacro", content)); }
  std::string Inside(const std::string& file) {
    std::string text = ExpandXacro(file, options).urdf;
    const std::size_t from = text.find("<robot"), start = text.find('>', from) + 1;
    if (text[start - 2] == '/') return "";
    text = text.substr(start, text.rfind("</robot>") - start);
    std::string flat;
    bool begins = true;
    for (const char c : text) {
      if (c == '\n') begins = true;
      if (c != '\n' && !(begins && c == ' ')) flat += c, begins = false;
    }
    return flat;
  }
  void ExpectRefused(const std::string& content, const std::string& line, const std::string& why) {
    const std::string file = Put("main.xacro", content);
    EXPECT_THAT([&] { ExpandXacro(file, options); },
                testing::ThrowsMessage<models::ModelError>(testing::AllOf(
                    testing::HasSubstr("main.xacro:" + line), testing::HasSubstr(why))))
        << content;
  }

  const oca::test::TemporaryFolder folder;
  XacroOptions options;
};

}  // namespace oca::robot::test
