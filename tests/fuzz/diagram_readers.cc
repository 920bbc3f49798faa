// SPDX-License-Identifier: BSD-3-Clause
// Diagram files, what their texts hold, and what eval reads.
#include <algorithm>
#include <sstream>

#include "oca/diagrams/files/diagram_file.h"
#include "oca/diagrams/files/document.h"
#include "oca/diagrams/files/expression.h"
#include "oca/diagrams/files/json_reader.h"
#include "oca/diagrams/files/override.h"
#include "oca/diagrams/files/yaml_reader.h"
#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/evaluator.h"
#include "oca/framework/dataflow/signal.h"
#include "oca/models/robot/urdf.h"
#include "oca/systems/signals/signals.h"
#include "tests/fuzz/foreign_bytes.h"

namespace oca::test {
namespace {

bool ReadDocument(std::string_view bytes) {
  return Accepts([&] {
    Problems problems;
    files::LoadFiles(FileOf("fuzz.yaml", bytes), {}, problems);
    problems.Throw();
  });
}

/// A whole file, of which a diagram is made.
bool ReadDiagram(std::string_view bytes) {
  return Accepts([&] { loading::LoadDiagram(FileOf("fuzz.yaml", bytes)); });
}

/// `PATH=VALUE`, and VALUE as what stands between `${` and `}`.
bool ReadOverride(std::string_view bytes) {
  return Accepts([&] {
    const auto change = files::Override::Parse(std::string(bytes));
    Problems problems;
    Value root = files::ReadYaml(
        "parameters: {rate: 100.0, far: true, name: text, list: [1, 2]}\n"
        "systems: {source: {type: Constant, value: [1]}, left: {type: Diagram, file: a.yaml}}\n",
        "fuzz.yaml", problems);
    files::Expressions expressions(*root.Find("parameters"), problems);
    expressions.Resolve(Value("${" + change.value + "}", {}));
    std::vector<files::Override> overrides{change};
    files::TakeInner(overrides, root);
    files::ApplyOverrides(overrides, root, problems);
    problems.Throw();
  });
}

template <class T>
bool ReadSignal(std::string_view bytes) {
  return Accepts([&] { Signal<T>::ReadJson(bytes); });
}

/// Parameters, and inputs of every type that others make.
bool ReadJson(std::string_view bytes) {
  bool accepted = Accepts([&] { files::ReadJson(bytes, "fuzz"); });
  accepted |= Accepts([&] { ReadVectorJson(bytes); });
  accepted |= ReadSignal<systems::ObstacleSet>(bytes);
  accepted |= ReadSignal<systems::LinkPoses>(bytes);
  accepted |= ReadSignal<systems::ProximitySet>(bytes);
  accepted |= ReadSignal<systems::LinkForceSet>(bytes);
  accepted |= ReadSignal<systems::WrenchSet>(bytes);
  return accepted;
}

/// A line with the type of a system, one with its parameters, then those that it is fed. What waits
/// for a time may take long by right.
bool ReadEval(std::string_view bytes) {
  static const files::Catalogue catalogue = files::Catalogue::Standard();
  static const auto arm = std::make_shared<const robot::RobotModel>(
      robot::LoadUrdf(std::string(OCA_SOURCE_DIR) + "/models/robots/planar2/planar2.urdf"));
  if (bytes.find("time") != bytes.npos || bytes.find("\\u") != bytes.npos) return false;
  return Accepts([&] {
    std::istringstream lines{std::string(bytes)};
    std::string type, params, line;
    std::getline(lines, type);
    std::getline(lines, params);
    systems::ModelSet models;
    models.Add("arm", arm);
    if (type == files::kDiagramType) return;
    runs::Evaluator evaluator(*catalogue.Find(type), files::ReadJson(params, "--params"), models);
    while (std::getline(lines, line)) Accepts([&] { evaluator.Serve(line); });
  });
}

}  // namespace

std::vector<Reader> DiagramReaders() {
  using enum Reader::Kind;
  return {{"diagram", kText, ReadDiagram},
          {"document", kText, ReadDocument},
          {"eval", kText, ReadEval},
          {"json", kText, ReadJson},
          {"override", kText, ReadOverride}};
}

}  // namespace oca::test
