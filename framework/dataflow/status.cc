// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/status.h"

#include <exception>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/explain.h"
#include "oca/framework/dataflow/fixed_text.h"

namespace oca {
Status Status::Failure(std::string_view system, std::string_view port, double time,
                       std::string_view message) noexcept {
  Status status;
  status.ok_ = false;
  status.time_ = time;
  CopyText(system, status.system_);
  CopyText(port, status.port_);
  CopyText(message, status.message_);
  return status;
}

Status Status::OfCurrentException(double time) noexcept {
  try {
    throw;
  } catch (const SimulationError& error) {
    return Failure(error.system, error.port, error.time, error.what());
  } catch (const std::exception& error) {
    return Failure("", "", time, internal::Explain(error));
  } catch (...) {
    return Failure("", "", time, "an exception of an unknown type");
  }
}

}  // namespace oca
