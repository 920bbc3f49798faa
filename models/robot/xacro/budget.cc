// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xacro/budget.h"

#include <fmt/format.h>

#include "oca/models/robot/xacro/python_value.h"

namespace oca::robot::xacro {

void Budget::CountElement() {
  if (++elements_ > kMostElements) {
    throw Mistake("size of the robot", fmt::format("more than {} elements", kMostElements),
                  "fewer (does a macro call itself without end?)");
  }
}

void Budget::CountFile() {
  if (++files_ > kMostFiles) {
    throw Mistake("files read", fmt::format("more than {}", kMostFiles),
                  "fewer (does a file include itself?)");
  }
}

void Budget::Spend(std::size_t bytes) {
  work_ += bytes;
  if (work_ > kMostWork) {
    throw Mistake("work of the expressions", fmt::format("more than {} MB", kMostWork / 1'000'000),
                  "less");
  }
}

Budget::Level::Level(Budget& budget) : budget_(budget) {
  if (++budget_.depth_ > kDeepest) {
    --budget_.depth_;
    throw Mistake("nesting", fmt::format("more than {} levels", kDeepest),
                  "fewer (does a macro, file or property use itself?)");
  }
}

}  // namespace oca::robot::xacro
