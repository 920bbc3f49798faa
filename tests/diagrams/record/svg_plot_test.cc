// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/svg_plot.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <string>

#include "oca/framework/dataflow/error.h"

namespace oca::record {
namespace svg_plot_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(SvgPlotTest, TicksAreRoundNumbersWithinTheRange) {
  EXPECT_THAT(Ticks(0.0, 10.0, 5), ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(Ticks(0.0, 10.0, 4), ElementsAre(0, 5, 10));
  EXPECT_THAT(Ticks(-0.11, 0.11, 5), ElementsAre(-0.1, -0.05, 0, 0.05, 0.1));
}

/// The plot area is 510 wide from 74, 166 high from 34; y is padded by 6 %.
TEST(SvgPlotTest, PutsPointsWhereTheyBelong) {
  PlotPanel panel{"title", "x", "y", {{"curve", {0, 1, 2}, {0, 1, 0}}}};
  panel.y_min = 0;
  panel.y_max = 1;
  EXPECT_THAT(SvgPlot({panel}), HasSubstr("d=\"M74.0 200.0L329.0 34.0L584.0 200.0\""));
}

TEST(SvgPlotTest, LiftsThePenOverWhatIsNotFinite) {
  PlotPanel panel{"", "", "", {{"", {0, 1, 2, 3, 4}, {0, 1, std::nan(""), 1, 0}}}};
  const std::string svg = SvgPlot({panel});
  const std::string path = svg.substr(svg.find("<path"));
  EXPECT_EQ(std::count(path.begin(), path.begin() + path.find("/>"), 'M'), 2);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(SvgPlotTest, NamesEveryCurveWithinThePictureHoweverManyThereAre) {
  PlotPanel panel{"", "", "", {}};
  for (int i = 0; i < 30; ++i)
    panel.curves.push_back({fmt::format("joint_{}.", i), {0, 1}, {0, 1}});
  panel.limit = 0.5;
  const std::string svg = SvgPlot({panel});
  for (int i = 0; i < 30; ++i) EXPECT_THAT(svg, HasSubstr(fmt::format(">joint_{}.<", i)));
  EXPECT_THAT(svg, HasSubstr(">limit 0.5<"));
  const double width = std::stod(svg.substr(svg.find("width=\"") + 7));
  double right = 0.0, low = 0.0;
  const std::regex kName("<text x=\"([0-9.]+)\" y=\"([0-9.]+)\" text-anchor=\"start\"");
  for (std::sregex_iterator name(svg.begin(), svg.end(), kName), end; name != end; ++name) {
    right = std::max(right, std::stod((*name)[1]));
    low = std::max(low, std::stod((*name)[2]));
  }
  EXPECT_LT(right + 7.2 * 9, width);
  EXPECT_LT(low, 250.0);
}

TEST(SvgPlotTest, DrawsALevelStretchByItsEndsAndKeepsASpike) {
  PlotPanel panel{"", "", "", {{"", {}, {}}}};
  for (int i = 0; i <= 1000; ++i) {
    panel.curves[0].x.push_back(i);
    panel.curves[0].y.push_back(i == 500 ? 1.0 : 0.0);
  }
  const std::string svg = SvgPlot({panel});
  const std::string path = svg.substr(svg.find("<path"));
  EXPECT_EQ(std::count(path.begin(), path.begin() + path.find("/>"), 'L'), 4);
}

TEST(SvgPlotTest, FurtherRunsAreDashed) {
  PlotPanel panel{"", "", "", {{"one", {0, 1}, {0, 1}, 0, 0}}};
  EXPECT_THAT(SvgPlot({panel}), Not(HasSubstr("stroke-dasharray")));
  panel.curves.push_back({"two", {0, 1}, {1, 0}, 0, 1});
  EXPECT_THAT(SvgPlot({panel}), HasSubstr("stroke-dasharray"));
}

TEST(SvgPlotTest, EscapesNames) {
  const PlotPanel panel{"a < b & c", "", "", {{"", {0, 1}, {0, 1}}}};
  EXPECT_THAT(SvgPlot({panel}), HasSubstr("a &lt; b &amp; c"));
}

TEST(SvgPlotTest, RefusesToDrawNothing) {
  EXPECT_THROW(SvgPlot({}), ConfigError);
  EXPECT_THROW(SvgPlot({PlotPanel{"empty", "", ""}}), ConfigError);
  EXPECT_THROW(SvgPlot({PlotPanel{"", "", "", {{"", {0}, {std::nan("")}}}}}), ConfigError);
}

}  // namespace svg_plot_test
}  // namespace oca::record
