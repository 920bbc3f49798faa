// SPDX-License-Identifier: BSD-3-Clause
#include "tests/verification/work_precision_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace oca::verification {
namespace {

using Panel = WorkPrecisionFigure::Panel;
using Point = WorkPrecisionFigure::Point;

// All in pixels.
constexpr int kColumns = 3;
constexpr double kWidth = 300, kHeight = 230;
constexpr double kLeft = 52, kRight = 12, kTop = 30, kBottom = 38;
constexpr double kLegend = 34;
constexpr double kSmallestError = 1e-16;

/// Whole decades that hold all values.
struct Axis {
  int low{100}, high{-100};
  void Include(double value) {
    low = std::min(low, static_cast<int>(std::floor(std::log10(value))));
    high = std::max(high, static_cast<int>(std::ceil(std::log10(value))));
  }
  double Fraction(double value) const { return (std::log10(value) - low) / (high - low); }
  /// Decades between two labels, so that there are at most six.
  int stride() const { return std::max(1, (high - low + 5) / 6); }
};

class Drawing {
 public:
  explicit Drawing(std::size_t panels) {
    const double rows = std::ceil(static_cast<double>(panels) / kColumns);
    Add(R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" viewBox="0 0 {0} {1}")"
        R"( font-family="sans-serif" font-size="11">)",
        kColumns * kWidth, rows * kHeight + kLegend);
    Add(R"(<rect width="100%" height="100%" fill="white"/>)");
  }

  void Legend(const std::vector<Panel>& panels) {
    std::vector<std::string> seen;
    double x = kLeft;
    for (const Panel& panel : panels) {
      for (const auto& curve : panel.curves) {
        if (std::find(seen.begin(), seen.end(), curve.name) != seen.end()) continue;
        seen.push_back(curve.name);
        Add(R"(<line x1="{}" y1="17" x2="{}" y2="17" stroke="{}" stroke-width="2"/>)", x, x + 18,
            curve.colour);
        Text(x + 23, 21, "start", curve.name);
        x += 110;
      }
    }
    Add(R"(<circle cx="{}" cy="17" r="4" fill="none" stroke="#555"/>)", x + 9);
    Text(x + 23, 21, "start", "SUNDIALS itself");
  }

  void Draw(const Panel& panel, int index) {
    left_ = kWidth * (index % kColumns) + kLeft;
    top_ = kHeight * (index / kColumns) + kLegend + kTop;
    x_ = y_ = Axis();
    for (const auto& curve : panel.curves) {
      for (const auto* const points : {&curve.points, &curve.marks}) {
        for (const Point& point : *points) {
          x_.Include(point.calls);
          y_.Include(std::max(point.error, kSmallestError));
        }
      }
    }
    Frame(panel.title);
    for (const auto& curve : panel.curves) Draw(curve);
  }

  std::string Finish() { return svg_ + "</svg>\n"; }

 private:
  static constexpr double kInnerWidth = kWidth - kLeft - kRight;
  static constexpr double kInnerHeight = kHeight - kTop - kBottom;

  template <class... Arguments>
  void Add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(svg_), format, std::forward<Arguments>(arguments)...);
    svg_ += '\n';
  }
  void Text(double x, double y, const char* anchor, const std::string& text) {
    Add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}" fill="#222">{}</text>)", x, y, anchor,
        text);
  }
  static std::string Power(int exponent) {
    return fmt::format(R"(10<tspan dy="-4" font-size="8">{}</tspan>)", exponent);
  }

  void Frame(const std::string& title) {
    Text(left_ + kInnerWidth / 2, top_ - 10, "middle", title);
    for (int decade = x_.low; decade <= x_.high; decade += x_.stride()) {
      const double x = X(std::pow(10.0, decade));
      Add(R"(<line x1="{0:.1f}" y1="{1:.1f}" x2="{0:.1f}" y2="{2:.1f}" stroke="#ddd"/>)", x, top_,
          top_ + kInnerHeight);
      Text(x, top_ + kInnerHeight + 14, "middle", Power(decade));
    }
    for (int decade = y_.low; decade <= y_.high; decade += y_.stride()) {
      const double y = Y(std::pow(10.0, decade));
      Add(R"(<line x1="{1:.1f}" y1="{0:.1f}" x2="{2:.1f}" y2="{0:.1f}" stroke="#ddd"/>)", y, left_,
          left_ + kInnerWidth);
      Text(left_ - 5, y + 4, "end", Power(decade));
    }
    Add(R"(<rect x="{:.1f}" y="{:.1f}" width="{}" height="{}" fill="none" stroke="#888"/>)", left_,
        top_, kInnerWidth, kInnerHeight);
    Text(left_ + kInnerWidth / 2, top_ + kInnerHeight + 29, "middle", "right-hand-side calls");
    Add(R"svg(<text transform="translate({:.1f},{:.1f}) rotate(-90)" text-anchor="middle")svg"
        R"svg( fill="#222">error</text>)svg",
        left_ - 38, top_ + kInnerHeight / 2);
  }

  void Draw(const WorkPrecisionFigure::Curve& curve) {
    std::string path;
    for (const Point& point : curve.points) {
      path += fmt::format("{:.1f},{:.1f} ", X(point.calls), Y(point.error));
      Add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="2" fill="{}"/>)", X(point.calls), Y(point.error),
          curve.colour);
    }
    Add(R"(<polyline points="{}" fill="none" stroke="{}" stroke-width="1.5"/>)", path,
        curve.colour);
    for (const Point& mark : curve.marks) {
      Add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="4" fill="none" stroke="{}"/>)", X(mark.calls),
          Y(mark.error), curve.colour);
    }
  }

  double X(double calls) const { return left_ + kInnerWidth * x_.Fraction(calls); }
  double Y(double error) const {
    return top_ + kInnerHeight * (1.0 - y_.Fraction(std::max(error, kSmallestError)));
  }

  std::string svg_;
  double left_{0.0}, top_{0.0};
  Axis x_, y_;
};

}  // namespace

std::string WorkPrecisionFigure::Svg() const {
  Drawing drawing(panels_.size());
  drawing.Legend(panels_);
  for (std::size_t i = 0; i < panels_.size(); ++i) drawing.Draw(panels_[i], static_cast<int>(i));
  return drawing.Finish();
}

}  // namespace oca::verification
