// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <functional>
#include <memory>

#include "oca/systems/judging/motion_metrics.h"
#include "tests/systems/system_bench.h"

namespace oca::systems::motion_bench {

using Eigen::Vector2d;
using VectorScript = std::function<Vector2d(double)>;
using DistanceScript = std::function<double(double)>;

/// A vector by script.
class Script final : public System {
 public:
  explicit Script(VectorScript script)
      : script_(std::move(script)),
        value(DeclareOutput<Vector, &Script::Calc>("value", {2, "rad"}, kTime)) {}

 private:
  const VectorScript script_;
  void Calc(double time, MutableVectorView out) const { out = script_(time); }

 public:
  const Output<Vector> value;
};

/// One proximity by script; none where the script says infinity, nothing to compare where NaN.
class DistanceSource final : public System {
 public:
  explicit DistanceSource(DistanceScript script)
      : script_(std::move(script)),
        proximities(DeclareOutput<ProximitySet, &DistanceSource::Calc>("proximities", {}, kTime)) {}

 private:
  const DistanceScript script_;
  void Calc(double time, ProximitySet& set) const {
    set.proximities.clear();
    set.compared = !std::isnan(script_(time));
    if (!std::isfinite(script_(time))) return;
    Proximity proximity;
    proximity.link = models::Name("hand");
    proximity.obstacle = models::Name("box");
    proximity.distance = script_(time);
    set.proximities.push_back(proximity);
  }

 public:
  const Output<ProximitySet> proximities;
};

struct Scripts {
  VectorScript position{}, request{}, goal{}, delta{};
  DistanceScript distance{};
};

/// Metrics at 10 Hz over scripted signals.
class Bench {
 public:
  explicit Bench(const Scripts& scripts, int looks = 1) {
    DiagramBuilder builder;
    metrics_ = &builder.Add<MotionMetrics>(
        "metrics", MotionMetrics::Params{.period = Period(1, 10), .looks = looks});
    const auto connect = [&](const char* name, const VectorScript& script,
                             const OptionalInput<Vector>& input) {
      if (script) builder.Connect(builder.Add<Script>(name, script).value, input);
    };
    connect("position", scripts.position, metrics_->position);
    connect("request", scripts.request, metrics_->request);
    connect("goal", scripts.goal, metrics_->goal);
    connect("delta", scripts.delta, metrics_->delta);
    if (scripts.distance) {
      builder.Connect(builder.Add<DistanceSource>("distance", scripts.distance).proximities,
                      metrics_->proximities);
    }
    diagram_ = builder.Build();
    simulator_ = std::make_unique<Simulator>(*diagram_);
  }
  const MotionMetricsValue& At(double time) {
    simulator_->AdvanceTo(time);
    return metrics_->metrics.Eval(simulator_->context());
  }

 private:
  const MotionMetrics* metrics_;
  std::unique_ptr<Diagram> diagram_;
  std::unique_ptr<Simulator> simulator_;
};

inline int Tick(double time) { return static_cast<int>(std::lround(10.0 * time)); }

}  // namespace oca::systems::motion_bench
