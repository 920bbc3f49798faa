// SPDX-License-Identifier: BSD-3-Clause
// The committed page and figure are what the command makes, but for the digits of their numbers.
#include "tests/verification/page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace oca::verification {
namespace page_test {

std::string Committed(const std::string& name) {
  std::ifstream stream(OCA_SOURCE_DIR "/tests/verification/" + name);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Lines, with every number as `#`; the numbers apart.
struct Masked {
  explicit Masked(const std::string& text) {
    static const std::regex number("-?[0-9]+(\\.[0-9]+)?(e[-+]?[0-9]+)?");
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
      lines.push_back(std::regex_replace(line, number, "#"));
      for (std::sregex_iterator at(line.begin(), line.end(), number), end; at != end; ++at) {
        numbers.push_back(std::stod(at->str()));
      }
    }
  }
  std::vector<std::string> lines;
  std::vector<double> numbers;
};

TEST(PageTest, TheCommittedPageIsWhatTheCommandMakes) {
  const Masked committed(Committed("README.md")), made(MakePage());
  ASSERT_EQ(committed.lines, made.lines)
      << "run build/release/tests/verification/verification_page tests/verification";
  ASSERT_EQ(committed.numbers.size(), made.numbers.size());
  // Another machine rounds otherwise; a page that is out of date is off by more, somewhere.
  int off = 0;
  for (std::size_t i = 0; i < made.numbers.size(); ++i) {
    const double a = committed.numbers[i], b = made.numbers[i];
    off += std::fabs(a - b) > 1e-12 + 0.2 * std::max(std::fabs(a), std::fabs(b));
  }
  EXPECT_LE(off, static_cast<int>(made.numbers.size()) / 50);
}

TEST(PageTest, TheCommittedFigureHasTheSamePanelsAndCurves) {
  const auto structure = [](const std::string& svg) {
    std::vector<std::string> texts;
    static const std::regex text("<text[^>]*>([^<]*)</text>|<polyline");
    for (std::sregex_iterator at(svg.begin(), svg.end(), text), end; at != end; ++at) {
      texts.push_back((*at)[1]);
    }
    return texts;
  };
  const auto committed = structure(Committed("work_precision.svg"));
  EXPECT_GT(committed.size(), 20U);
  EXPECT_EQ(committed, structure(MakeFigure()));
}

}  // namespace page_test
}  // namespace oca::verification
