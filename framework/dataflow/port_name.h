// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/framework/dataflow/port.h"

namespace oca::internal {

/// What to call a port or a state whose place in a diagram is not known: `output 'value'`; of a
/// handle that was made by default `an empty handle`.
std::string NameOf(const InputHandle& input);
std::string NameOf(const OutputHandle& output);
std::string NameOf(const CachedHandle& cached);
std::string NameOf(const StateHandle& state);

/// That a port or a state is none of `diagram`, `the diagram that was asked`; an empty handle is
/// told as such.
template <class H>
std::string ForeignText(const H& handle, const std::string& diagram) {
  return NameOf(handle) +
         (handle.system == nullptr ? ": got a handle that was made by default; expected one of "
                                   : ": its system is not part of ") +
         diagram;
}

}  // namespace oca::internal
