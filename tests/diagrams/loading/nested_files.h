// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/error.h"
#include "tests/temporary_folder.h"

namespace oca::loading::nested_files {

using Overrides = std::vector<files::Override>;

/// A gain of 3 with a lag behind it; lines 4 and 5 are the systems.
inline const char* const kStage =
    "name: stage\n"
    "parameters: {factor: 3, constant: 0.1}\n"
    "systems:\n"
    "  gain: {type: Gain, gain: \"${factor}\"}\n"
    "  lag: {type: FirstOrderLag, time_constant: \"${constant}\"}\n"
    "connections:\n"
    "  - inputs.in -> gain.in\n"
    "  - gain.out -> lag.in\n"
    "  - lag.out -> outputs.slow\n";

/// Two stages in a row; line 4 is the source, 5 and 6 are the stages.
inline std::string TwoStages(const std::string& first = "", const std::string& second = "",
                             const std::string& more = "") {
  return "name: row\n"
         "simulator: {duration: 1}\n"
         "systems:\n"
         "  source: {type: Constant, value: [1, 2], unit: rad}\n"
         "  first: {type: Diagram, file: stage.yaml" +
         first +
         "}\n"
         "  second: {type: Diagram, file: stage.yaml" +
         second +
         "}\n"
         "connections:\n"
         "  - source.value -> first.in\n"
         "  - first.slow -> second.in\n" +
         more;
}

class NestedFiles : public testing::Test {
 protected:
  NestedFiles() { folder.Write("stage.yaml", kStage); }

  LoadedDiagram Load(const std::string& text, const Overrides& overrides = {}) {
    return LoadDiagram(folder.Write("d.yaml", text), overrides);
  }
  /// The error text, without the folder; empty if the text loads.
  std::string Refusal(const std::string& text, const Overrides& overrides = {}) {
    try {
      Load(text, overrides);
      return "";
    } catch (const ConfigError& error) {
      return WithoutFolder(error.what());
    }
  }
  std::string WithoutFolder(std::string text) const {
    const std::string place = folder.path().string() + "/";
    for (auto at = text.find(place); at != std::string::npos; at = text.find(place)) {
      text.erase(at, place.size());
    }
    return text;
  }
  static double At(const LoadedDiagram& loaded, const std::string& output) {
    const Context context = loaded.diagram->MakeContext();
    return loaded.diagram->GetOutput<Vector>(output).Eval(context)[0];
  }
  test::TemporaryFolder folder;
};

}  // namespace oca::loading::nested_files
