// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace oca {

enum class LogLevel { kDebug, kInfo, kWarning };

/// Where events, publish events and updates, write what a person reads. The base class drops
/// everything.
class Log {
 public:
  virtual ~Log() = default;
  /// Whether a text of `level` goes anywhere; ask before formatting one.
  virtual bool enabled(LogLevel /*level*/) const { return false; }
  virtual void Write(LogLevel /*level*/, double /*time*/, std::string_view /*text*/) {}
};

/// The one that drops everything.
inline Log& SilentLog() {
  static Log log;
  return log;
}

}  // namespace oca
