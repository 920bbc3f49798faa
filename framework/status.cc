// SPDX-License-Identifier: BSD-3-Clause
#include "framework/status.h"

#include <algorithm>
#include <cstring>
#include <exception>

#include "framework/error.h"

namespace oca {
namespace {

template <std::size_t N>
void Copy(std::string_view text, std::array<char, N>& to) {
  constexpr std::string_view kCut = "...";
  const std::size_t length = std::min(text.size(), N - 1);
  std::copy_n(text.data(), length, to.data());
  to[length] = '\0';
  if (length < text.size()) std::copy(kCut.begin(), kCut.end(), to.end() - 1 - kCut.size());
}

}  // namespace

Status Status::Failure(std::string_view system, std::string_view port, double time,
                       std::string_view message) noexcept {
  Status status;
  status.ok_ = false;
  status.time_ = time;
  Copy(system, status.system_);
  Copy(port, status.port_);
  Copy(message, status.message_);
  return status;
}

Status Status::OfCurrentException(double time) noexcept {
  try {
    throw;
  } catch (const SimulationError& error) {
    return Failure(error.system, error.port, error.time, error.what());
  } catch (const std::exception& error) {
    return Failure("", "", time, error.what());
  } catch (...) {
    return Failure("", "", time, "an exception of an unknown type");
  }
}

}  // namespace oca
