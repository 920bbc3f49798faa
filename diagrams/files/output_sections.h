// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "oca/diagrams/files/run_params.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/period.h"
#include "oca/framework/dataflow/value.h"

namespace oca::files {

/// A signal to record. `name` is `system.output`.
struct RecordedSignal {
  std::string name;
  OutputHandle output;
  Period period;
};

/// Outputs by name.
using NamedOutputs = std::vector<std::pair<std::string, OutputHandle>>;

/// A bound from section `expect`. What it looks at is an element of a Vector output (`index`), or a
/// member of another output's JSON object (`member`).
struct Expectation {
  std::string name;
  OutputHandle output;
  int index{-1};
  std::string member;
  NamedOutputs judges{};  ///< of a metric: what judges the arms that count together
  ExpectParams bound;
};

/// Section `record`; names may be patterns with `*`, `outputs` is what there is. Names, but no
/// patterns, are looked up in `others` too.
std::vector<RecordedSignal> ReadRecord(const Value& root, const NamedOutputs& outputs,
                                       const NamedOutputs& others, Problems& problems);

/// Key `scene` of section `record`: how often the scene is recorded; `otherwise` if it is left out.
Period ReadSceneRate(const Value& root, const Period& otherwise, Problems& problems);

/// Section `expect`. A lone word is a metric; with several `metrics` the worst of them counts, and
/// behind the path of a used file that of the arms there.
/// `diagram` is nullptr if it could not be built; lengths are then not checked.
std::vector<Expectation> ReadExpectations(const Value& root, const NamedOutputs& outputs,
                                          const NamedOutputs& metrics, const Diagram* diagram,
                                          double duration, Problems& problems);

}  // namespace oca::files
