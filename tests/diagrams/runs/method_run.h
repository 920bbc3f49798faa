// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/framework/simulation/simulator.h"
#include "oca/systems/signals/signals.h"

namespace oca::runs {

/// The METHOD of every parts/avoidance_METHOD.yaml: a new one inherits the tests of all.
inline std::vector<std::string> Methods() {
  const std::string prefix = "avoidance_";
  std::vector<std::string> methods;
  for (const auto& entry : std::filesystem::directory_iterator(OCA_SOURCE_DIR "/diagrams/parts")) {
    const std::string name = entry.path().stem().string();
    if (name.starts_with(prefix)) methods.push_back(name.substr(prefix.size()));
  }
  std::sort(methods.begin(), methods.end());
  return methods;
}

/// A run of a diagram file with a method, tick by tick.
class MethodRun {
 public:
  MethodRun(const std::string& file, const std::string& method,
            std::vector<files::Override> overrides)
      : loaded_(Load(file, method, std::move(overrides))),
        simulator_(*loaded_.diagram, loaded_.simulator.integration) {}

  void Initialize() { simulator_.Initialize(); }
  void AdvanceTo(double time) { simulator_.AdvanceTo(time); }
  OutputHandle Find(const std::string& system, const std::string& output) const {
    return loaded_.diagram->FindSystem(system)->FindOutput(output);
  }
  Eigen::VectorXd Vector(const std::string& system, const std::string& output) const {
    const auto numbers = EvalVector(Find(system, output), simulator_.context());
    return Eigen::Map<const Eigen::VectorXd>(numbers.data(), std::ssize(numbers));
  }
  template <class T>
  const T& Eval(const std::string& system, const std::string& output) const {
    return Typed<T>(Find(system, output)).Eval(simulator_.context());
  }
  /// throws std::out_of_range if there is nothing near
  systems::Proximity Nearest() const {
    const auto& all = Eval<systems::ProximitySet>("distance", "proximities").proximities;
    if (all.empty()) throw std::out_of_range("distance.proximities: got none");
    return *std::min_element(all.begin(), all.end(),
                             [](const auto& a, const auto& b) { return a.distance < b.distance; });
  }
  const loading::LoadedDiagram& loaded() const { return loaded_; }

 private:
  static loading::LoadedDiagram Load(const std::string& file, const std::string& method,
                                     std::vector<files::Override> overrides) {
    overrides.push_back({"parameters.avoidance", method});
    return loading::LoadDiagram(OCA_SOURCE_DIR "/diagrams/" + file + ".yaml", overrides);
  }
  loading::LoadedDiagram loaded_;
  Simulator simulator_;
};

}  // namespace oca::runs
