// SPDX-License-Identifier: BSD-3-Clause
// Whoever needs to know what a system is asks for its roles: its type name is a string in the
// catalogue alone, and nobody casts to it.
#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "oca/diagrams/files/catalogue.h"

namespace oca::runs {
namespace type_names_test {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

/// What stands in double quotes in C++ or TypeScript, without comments; raw strings included.
std::vector<std::string> LiteralsOf(const std::string& text) {
  std::vector<std::string> literals;
  // The end of what is quoted by `quote` and begins at `at`.
  const auto end_of_quote = [&](std::size_t at, char quote) {
    while (at < text.size() && text[at] != quote) at += text[at] == '\\' ? 2 : 1;
    return std::min(at, text.size());
  };
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text.compare(at, 2, "//") == 0) {
      at = std::min(text.find('\n', at), text.size());
    } else if (text.compare(at, 2, "/*") == 0) {
      at = std::min(text.find("*/", at), text.size() - 1) + 1;
    } else if (text.compare(at, 2, "R\"") == 0) {
      const std::size_t open = text.find('(', at);
      const std::string close = ")" + text.substr(at + 2, open - at - 2) + "\"";
      at = std::min(text.find(close, open), text.size());
      literals.push_back(text.substr(open + 1, at - open - 1));
      at += close.size() - 1;
    } else if (text[at] == '\'' && (at == 0 || std::isalnum(static_cast<unsigned char>(
                                                   text[at - 1])) == 0)) {  // no 1'000
      at = end_of_quote(at + 1, '\'');
    } else if (text[at] == '"') {
      const std::size_t end = end_of_quote(at + 1, '"');
      literals.push_back(text.substr(at + 1, end - at - 1));
      at = end;
    }
  }
  return literals;
}

std::set<std::string> WordsOf(const std::string& text) {
  std::set<std::string> words;
  std::string word;
  for (const char c : text + " ") {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') {
      word += c;
    } else if (!word.empty()) {
      words.insert(std::exchange(word, {}));
    }
  }
  return words;
}

/// Type names in the literals of a source, and dynamic_casts, a phrase each.
std::vector<std::string> Offences(const std::string& source) {
  static const auto standard = files::Catalogue::Standard();
  std::vector<std::string> found;
  for (const std::string& literal : LiteralsOf(source)) {
    for (const std::string& word : WordsOf(literal)) {
      for (const files::Catalogue::Row& row : standard.rows()) {
        if (row->type == word) found.push_back("'" + word + "' in \"" + literal + "\"");
      }
    }
  }
  if (source.find("dynamic_cast<") != std::string::npos) found.emplace_back("a dynamic_cast");
  return found;
}

std::string ContentOf(const fs::path& file) {
  const std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

TEST(TypeNamesTest, FindsThemInStringsButNotInComments) {
  EXPECT_THAT(Offences(R"(if (type == "Saturation") // "Gain")"),
              ElementsAre("'Saturation' in \"Saturation\""));
  EXPECT_THAT(Offences("/* \"Gain\" */ x = 'a'; f(\"a Gain\\\" here\")"),
              ElementsAre("'Gain' in \"a Gain\\\" here\""));
  EXPECT_THAT(Offences("R\"(one\nServoScaling)\""), ElementsAre("'ServoScaling' in \"one\n"
                                                                "ServoScaling\""));
  EXPECT_THAT(Offences("use(\"Gains\", \"systems/gain.h\", '\"', Gain{}); \"x\""), IsEmpty());
  EXPECT_THAT(Offences("auto* x = dynamic_cast<const Gain*>(y);"), ElementsAre("a dynamic_cast"));
}

TEST(TypeNamesTest, StandNowhereButInTheCatalogue) {
  int files = 0;
  for (const char* folder : {"diagrams", "framework", "models", "tools"}) {
    for (auto it = fs::recursive_directory_iterator(fs::path(OCA_SOURCE_DIR) / folder);
         it != fs::recursive_directory_iterator(); ++it) {
      if (it->path().filename() == "node_modules") it.disable_recursion_pending();
      const std::string extension = it->path().extension().string();
      if (extension != ".cc" && extension != ".h" && extension != ".ts") continue;
      if (it->path().filename() == "standard_catalogue.cc") continue;
      ++files;
      for (const std::string& offence : Offences(ContentOf(it->path()))) {
        // A diagram among systems is the framework's own affair.
        if (std::string(folder) == "framework" && offence == "a dynamic_cast") continue;
        ADD_FAILURE() << it->path().string() << ": " << offence;
      }
    }
  }
  EXPECT_GT(files, 200);
}

}  // namespace type_names_test
}  // namespace oca::runs
