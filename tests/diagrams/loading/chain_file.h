// SPDX-License-Identifier: BSD-3-Clause
// A small file, whole and with one thing wrong.
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/error.h"
#include "tests/temporary_folder.h"

namespace oca::loading::chain_file {

/// Loads text as d.yaml of a folder of its own.
class ChainFile : public testing::Test {
 protected:
  LoadedDiagram Load(const std::string& text, const std::vector<files::Override>& overrides = {}) {
    return LoadDiagram(folder.Write("d.yaml", text), overrides);
  }
  /// The error text, without the folder; empty if the text loads.
  std::string Refusal(const std::string& text) {
    try {
      Load(text);
      return "";
    } catch (const ConfigError& error) {
      std::string what = error.what();
      const std::string place = folder.path().string() + "/";
      for (auto at = what.find(place); at != std::string::npos; at = what.find(place)) {
        what.erase(at, place.size());
      }
      return what;
    }
  }
  test::TemporaryFolder folder;
};

/// A source, a gain and a lag in a row: line 2 is the simulator, 4 to 6 the systems, 8 and 9 the
/// connections. What a test replaces keeps these lines.
inline std::string Chain(const std::string& from = "", const std::string& to = "") {
  std::string text =
      "name: chain\n"
      "simulator: {duration: 1}\n"
      "systems:\n"
      "  source: {type: Constant, value: [1, 2], unit: rad}\n"
      "  gain: {type: Gain, gain: 3}\n"
      "  lag: {type: FirstOrderLag, time_constant: 0.1}\n"
      "connections:\n"
      "  - source.value -> gain.in\n"
      "  - gain.out -> lag.in\n";
  if (!from.empty()) {
    const auto at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("nothing to replace: " + from);
    text.replace(at, from.size(), to);
  }
  return text;
}

inline const char* const kArm =
    "models: {arm: {urdf: package://lwr4/lwr4.urdf, srdf: package://lwr4/lwr4.srdf}}\n";

}  // namespace oca::loading::chain_file
