// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/diagrams/files/catalogue.h"

namespace oca::tools {

/// Exit statuses of `simulator`.
enum ExitStatus {
  kFine = 0,
  kRunFailed = 1,
  kBadInput = 2,
  kExpectationNotMet = 3,
  kUsage = 64,
  kInterrupted = 130,
};

/// The program `simulator`, with all its commands, for diagram files whose systems have the types
/// of `catalogue`. Returns an ExitStatus; what goes wrong is told on standard error.
///
///     int main(int argc, char** argv) {
///       auto catalogue = oca::diagrams::Catalogue::Standard();
///       catalogue.Add<MyBlock>("MyBlock");
///       return oca::tools::SimulatorMain(argc, argv, catalogue);
///     }
int SimulatorMain(int argc, char** argv,
                  const files::Catalogue& catalogue = files::Catalogue::Standard());

}  // namespace oca::tools
