// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string_view>

namespace oca {

/// How a tick went: fine, or which system failed at which port, when and why.
///
/// What a control loop gets in place of an exception: a value of fixed size that takes no memory.
/// Texts that are longer than there is room for end in "...".
class [[nodiscard]] Status {
 public:
  /// Fine.
  Status() noexcept { system_[0] = port_[0] = message_[0] = '\0'; }
  /// `message` is the whole sentence, `system.port at t = 0.1 s: what` where there is such a place.
  static Status Failure(std::string_view system, std::string_view port, double time,
                        std::string_view message) noexcept;
  /// Of the exception that is being handled; call it in a catch block. `time` counts if the
  /// exception has none of its own.
  static Status OfCurrentException(double time) noexcept;

  bool ok() const noexcept { return ok_; }
  const char* system() const noexcept { return system_.data(); }  ///< path; empty: none to blame
  const char* port() const noexcept { return port_.data(); }
  double time() const noexcept { return time_; }  ///< s
  const char* message() const noexcept { return message_.data(); }

 private:
  bool ok_{true};
  double time_{0.0};
  std::array<char, 64> system_;
  std::array<char, 32> port_;
  std::array<char, 256> message_;
};

}  // namespace oca
