// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "oca/diagrams/sampling/task_geometry.h"
#include "oca/framework/dataflow/params.h"

namespace oca::sampling {

/// Bounds, both included.
struct BoundParams {
  std::optional<double> at_least{};
  std::optional<double> at_most{};
  static void Describe(Fields<BoundParams>& fields);
};

struct ClearPathParams {
  double margin{0.01};
  int most_nodes{5000};
  static void Describe(Fields<ClearPathParams>& fields);
};

/// Section `sampling.accept`: what a scenario must be like.
struct AcceptParams {
  std::string model{"arm"};
  std::string request{"spline"};
  std::string obstacles{"obstacles"};
  std::optional<BoundParams> lowest_link_origin{};
  std::optional<BoundParams> home_distance{};
  std::optional<BoundParams> goal_distance{};
  std::optional<BoundParams> foot_distance{};
  std::optional<BoundParams> requested_distance{};
  std::optional<ClearPathParams> clear_path{};
  static void Describe(Fields<AcceptParams>& fields);
};

/// Decides on scenarios and keeps count.
class Acceptance {
 public:
  /// Problems at `value`, section `sampling.accept`, which may be null.
  Acceptance(const Value& value, Problems& problems);

  TaskNames names() const { return {params_.model, params_.request, params_.obstacles}; }
  /// Whether all conditions hold; the cheapest are looked at first. `seed` is the planner's.
  bool Accepts(TaskGeometry& task, std::uint64_t seed);
  /// `home_distance refused 12, clear_path 3`.
  std::string Refusals() const;

 private:
  bool Holds(const char* condition, const std::optional<BoundParams>& bound, double value);
  bool Count(const char* condition, bool holds);

  AcceptParams params_;
  struct Refusal {
    std::string condition;
    int count;
  };
  std::vector<Refusal> refusals_;
};

}  // namespace oca::sampling
