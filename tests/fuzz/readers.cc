// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/readers.h"

#include <iterator>
#include <vector>

#include "tests/fuzz/foreign_bytes.h"

namespace oca::test {

std::span<const Reader> Readers() {
  static const std::vector<Reader> all = [] {
    std::vector<Reader> readers;
    for (const auto& some :
         {ShapeReaders(), RobotReaders(), DiagramReaders(), RecordReaders(), NetworkReaders()}) {
      readers.insert(readers.end(), some.begin(), some.end());
    }
    return readers;
  }();
  return all;
}

}  // namespace oca::test
