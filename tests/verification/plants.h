// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "oca/framework/dataflow/diagram.h"

namespace oca::verification {

/// A diagram of product systems whose state at `end` is known to 15 digits.
struct Plant {
  std::unique_ptr<Diagram> diagram;
  double end;  ///< s
  struct Answer {
    Output<Vector> output;  ///< of length 1
    double value;
  };
  std::vector<Answer> answers;
};

/// A plant by name. The answers come from closed forms: sums of held samples, exponentials,
/// matrix exponentials of the sampled loops.
struct PlantCase {
  std::string name;
  Plant (*make)();
  bool polynomial;  ///< between events, so that one-step methods are exact
};

const std::vector<PlantCase>& PlantCases();
/// throws std::out_of_range if there is none of that name.
const PlantCase& PlantNamed(const std::string& name);

}  // namespace oca::verification
