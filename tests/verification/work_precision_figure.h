// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace oca::verification {

/// Small panels of error against cost, both on logarithmic axes, as one SVG.
class WorkPrecisionFigure {
 public:
  struct Point {
    double calls;
    double error;
  };
  struct Curve {
    std::string name;           ///< in the legend, once however many panels have it
    std::string colour;         ///< as SVG takes it
    std::vector<Point> points;  ///< joined, a dot each
    std::vector<Point> marks;   ///< circles, of the yardstick
  };
  struct Panel {
    std::string title;
    std::vector<Curve> curves;
  };

  void Add(Panel panel) { panels_.push_back(std::move(panel)); }
  std::string Svg() const;

 private:
  std::vector<Panel> panels_;
};

}  // namespace oca::verification
