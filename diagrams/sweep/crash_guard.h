// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace oca::sweep {

/// While it lives, a crash of this thread (segmentation fault, abort, ...) first writes `line` to
/// the file behind `descriptor`, so that the next attempt knows which run to leave out.
class CrashGuard {
 public:
  CrashGuard(int descriptor, std::string line);
  ~CrashGuard();
  CrashGuard(const CrashGuard&) = delete;
  CrashGuard& operator=(const CrashGuard&) = delete;

 private:
  std::string line_;
};

}  // namespace oca::sweep
