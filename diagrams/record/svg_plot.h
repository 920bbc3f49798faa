// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace oca::record {

/// A curve; one of a further run (`run` from 0) is dashed.
struct PlotCurve {
  std::string label{};
  std::vector<double> x, y;
  int colour{0};
  int run{0};
};

/// One diagram: axes with labels, curves, a legend beside it. NaN breaks a curve; what lies outside
/// given bounds is cut off.
struct PlotPanel {
  std::string title{};
  std::string x_label{};
  std::string y_label{};
  std::vector<PlotCurve> curves{};
  std::optional<double> limit{};  ///< drawn across
  std::optional<double> y_min{}, y_max{};
  std::optional<double> x_min{}, x_max{};
};

/// Panels below each other as a stand-alone SVG, for paper and screen: white ground, colours that
/// the colour-blind tell apart, dashes besides.
/// throws ConfigError if there is no panel or a panel without a finite point.
std::string SvgPlot(const std::vector<PlotPanel>& panels);

/// Steps of 1, 2 or 5 times a power of ten that fall into [low, high], at most `most`.
std::vector<double> Ticks(double low, double high, int most);

}  // namespace oca::record
