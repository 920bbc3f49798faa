// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "oca/framework/dataflow/error.h"

namespace oca::record {
namespace {

// Okabe and Ito's palette, without its yellow, which is too pale for lines.
constexpr std::array kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                              "#56b4e9", "#e69f00", "#222222"};
constexpr std::array kDashes{"", "7 3", "2 2", "9 3 2 3"};

constexpr double kPlotWidth = 510.0, kPanelHeight = 250.0;
constexpr double kLeft = 74.0, kTop = 34.0, kBottom = 50.0;
constexpr std::size_t kLegendRows = 13;  // of 16 px, that a panel has room for

std::string Escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '&') {
      out += "&amp;";
    } else {
      out += c;
    }
  }
  return out;
}

struct Range {
  double low{std::numeric_limits<double>::infinity()};
  double high{-std::numeric_limits<double>::infinity()};
  void Add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void Pad(double share) {
    const double pad = high > low ? share * (high - low) : std::max(0.5 * std::fabs(high), 1e-9);
    low -= pad;
    high += pad;
  }
};

/// Draws one panel with its upper edge at `top`.
class PanelWriter {
 public:
  PanelWriter(const PlotPanel& panel, double top, double column_width, std::string& out)
      : panel_(panel), top_(top + kTop), column_width_(column_width), out_(out) {
    FindRanges();
  }

  void Write(int number) {
    Text(kLeft, top_ - 12.0, "start", panel_.title, "font-weight=\"600\" font-size=\"14\"");
    fmt::format_to(std::back_inserter(out_),
                   "<clipPath id=\"panel{}\"><rect x=\"{}\" y=\"{:.2f}\" width=\"{}\" "
                   "height=\"{}\"/></clipPath>\n",
                   number, kLeft, top_, Width(), Height());
    WriteAxes();
    fmt::format_to(std::back_inserter(out_), "<g clip-path=\"url(#panel{})\">\n", number);
    if (panel_.limit) {
      Line(kLeft, Y(*panel_.limit), kLeft + Width(), Y(*panel_.limit),
           "stroke=\"#b00020\" stroke-dasharray=\"4 3\"");
    }
    for (const PlotCurve& curve : panel_.curves) WriteCurve(curve);
    out_ += "</g>\n";
    WriteLegend();
  }

 private:
  static double Width() { return kPlotWidth; }
  static double Height() { return kPanelHeight - kTop - kBottom; }
  double X(double x) const { return kLeft + Width() * (x - x_.low) / (x_.high - x_.low); }
  double Y(double y) const { return top_ + Height() * (y_.high - y) / (y_.high - y_.low); }

  void FindRanges() {
    for (const PlotCurve& curve : panel_.curves) {
      for (const double x : curve.x) x_.Add(x);
      for (const double y : curve.y) y_.Add(y);
    }
    if (panel_.limit) y_.Add(*panel_.limit);
    if (!(x_.low <= x_.high) || !(y_.low <= y_.high)) {
      throw ConfigError(fmt::format("plot '{}': got no finite point; expected some", panel_.title));
    }
    if (x_.low == x_.high) x_.Pad(0.0);
    y_.Pad(0.06);
    x_.low = panel_.x_min.value_or(x_.low);
    x_.high = panel_.x_max.value_or(x_.high);
    y_.low = panel_.y_min.value_or(y_.low);
    y_.high = panel_.y_max.value_or(y_.high);
  }

  void Line(double x1, double y1, double x2, double y2, const char* style) {
    fmt::format_to(std::back_inserter(out_),
                   "<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" {}/>\n", x1, y1,
                   x2, y2, style);
  }

  void Text(double x, double y, const char* anchor, const std::string& text,
            const char* style = "") {
    fmt::format_to(std::back_inserter(out_),
                   "<text x=\"{:.2f}\" y=\"{:.2f}\" text-anchor=\"{}\" {}>{}</text>\n", x, y,
                   anchor, style, Escaped(text));
  }

  void WriteAxes() {
    const double bottom = top_ + Height();
    for (const double tick : Ticks(x_.low, x_.high, 9)) {
      Line(X(tick), top_, X(tick), bottom, "stroke=\"#e4e4e4\"");
      Text(X(tick), bottom + 16.0, "middle", fmt::format("{:g}", tick));
    }
    for (const double tick : Ticks(y_.low, y_.high, 6)) {
      Line(kLeft, Y(tick), kLeft + Width(), Y(tick), "stroke=\"#e4e4e4\"");
      Text(kLeft - 7.0, Y(tick) + 4.0, "end", fmt::format("{:g}", tick));
    }
    fmt::format_to(std::back_inserter(out_),
                   "<rect x=\"{}\" y=\"{:.2f}\" width=\"{}\" height=\"{}\" fill=\"none\" "
                   "stroke=\"#444444\"/>\n",
                   kLeft, top_, Width(), Height());
    Text(kLeft + 0.5 * Width(), bottom + 34.0, "middle", panel_.x_label);
    const double middle = top_ + 0.5 * Height();
    const std::string turn = fmt::format("transform=\"rotate(-90 16 {:.2f})\"", middle);
    Text(16.0, middle, "middle", panel_.y_label, turn.c_str());
  }

  static std::string Stroke(const PlotCurve& curve) {
    const auto colour = static_cast<std::size_t>(curve.colour);
    // Beyond the palette colours come again with another dash.
    const std::size_t dash = static_cast<std::size_t>(curve.run) + colour / kColours.size();
    std::string stroke =
        fmt::format("stroke=\"{}\" stroke-width=\"1.5\"", kColours[colour % kColours.size()]);
    const std::string pattern = kDashes[dash % kDashes.size()];
    return pattern.empty() ? stroke : stroke + " stroke-dasharray=\"" + pattern + "\"";
  }

  /// Far outside, pixels would lose their meaning.
  double Row(double y) const { return std::clamp(Y(y), top_ - 1e4, top_ + 1e4); }

  /// Points too near the last one to be seen apart, or within a level stretch, add nothing.
  void WriteCurve(const PlotCurve& curve) {
    constexpr double kSeen = 0.5;  // px
    fmt::format_to(std::back_inserter(out_),
                   "<path fill=\"none\" stroke-linejoin=\"round\" {} d=\"", Stroke(curve));
    bool pen_up = true;
    double last_x = 0.0, last_y = 0.0;
    const std::size_t size = std::min(curve.x.size(), curve.y.size());
    for (std::size_t i = 0; i < size; ++i) {
      if (!std::isfinite(curve.x[i]) || !std::isfinite(curve.y[i])) {
        pen_up = true;
        continue;
      }
      const double x = X(curve.x[i]);
      const double y = Row(curve.y[i]);
      if (!pen_up && i + 1 < size && std::fabs(y - last_y) < kSeen) {
        const bool level =
            std::fabs(y - last_y) < 0.05 && std::fabs(Row(curve.y[i + 1]) - y) < 0.05;
        if (level || x - last_x < kSeen) continue;
      }
      fmt::format_to(std::back_inserter(out_), "{}{:.1f} {:.1f}", pen_up ? "M" : "L", x, y);
      pen_up = false;
      last_x = x;
      last_y = y;
    }
    out_ += "\"/>\n";
  }

  void WriteLegend() {
    for (std::size_t i = 0; i < panel_.curves.size(); ++i) {
      WriteName(i, Stroke(panel_.curves[i]), panel_.curves[i].label);
    }
    if (!panel_.limit) return;
    WriteName(panel_.curves.size(), "stroke=\"#b00020\" stroke-dasharray=\"4 3\"",
              fmt::format("limit {:g}", *panel_.limit));
  }

  void WriteName(std::size_t entry, const std::string& stroke, const std::string& name) {
    const std::size_t column = entry / kLegendRows;
    const double x = kLeft + Width() + 12.0 + column_width_ * static_cast<double>(column);
    const double y = top_ + 8.0 + 16.0 * static_cast<double>(entry % kLegendRows);
    Line(x, y, x + 24.0, y, stroke.c_str());
    Text(x + 30.0, y + 4.0, "start", name);
  }

  const PlotPanel& panel_;
  const double top_;
  const double column_width_;
  std::string& out_;
  Range x_, y_;
};

/// What the longest name in a legend takes.
double ColumnWidth(const std::vector<PlotPanel>& panels) {
  constexpr double kLetter = 7.2;
  std::size_t longest = 10;
  for (const PlotPanel& panel : panels) {
    for (const PlotCurve& curve : panel.curves) longest = std::max(longest, curve.label.size());
  }
  return 48.0 + kLetter * static_cast<double>(longest);
}

/// Columns that the longest legend takes.
double LegendColumns(const std::vector<PlotPanel>& panels) {
  std::size_t entries = 1;
  for (const PlotPanel& panel : panels) {
    entries = std::max(entries, panel.curves.size() + (panel.limit ? 1 : 0));
  }
  const std::size_t columns = (entries + kLegendRows - 1) / kLegendRows;
  return static_cast<double>(columns);
}

}  // namespace

std::vector<double> Ticks(double low, double high, int most) {
  const double least = (high - low) / most;
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= least) step = factor * power;
  }
  std::vector<double> ticks;
  const double first = std::ceil(low / step - 1e-9);
  for (double i = first; i * step <= high + 1e-9 * step; ++i) {
    ticks.push_back(i == 0.0 ? 0.0 : i * step);
  }
  return ticks;
}

std::string SvgPlot(const std::vector<PlotPanel>& panels) {
  if (panels.empty()) throw ConfigError("plot: got nothing to draw; expected a signal");
  const double height = kPanelHeight * static_cast<double>(panels.size());
  const double column = ColumnWidth(panels);
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" font-family=\"DejaVu Sans, Helvetica, sans-serif\" font-size=\"11.5\" "
      "fill=\"#222222\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
      kLeft + kPlotWidth + column * LegendColumns(panels), height);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    PanelWriter(panels[i], kPanelHeight * static_cast<double>(i), column, out)
        .Write(static_cast<int>(i));
  }
  return out + "</svg>\n";
}

}  // namespace oca::record
