// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/beast/http.hpp>
#include <string>
#include <utility>
#include <vector>

#include "oca/diagrams/live/access.h"

namespace oca::live::internal {

/// What a request says of itself, which came in by the address `reached` of this machine.
template <class Body>
Claims ClaimsOf(const boost::beast::http::request<Body>& request, std::string reached) {
  using boost::beast::http::field;
  const auto all = [&request](field name) {
    std::vector<std::string> values;
    const auto [begin, end] = request.equal_range(name);
    for (auto at = begin; at != end; ++at) values.emplace_back(at->value());
    return values;
  };
  return {all(field::host), all(field::origin), std::string(request.target()), std::move(reached)};
}

}  // namespace oca::live::internal
