// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/nearest_name.h"

#include "oca/framework/dataflow/edit_distance.h"

namespace oca::models {
namespace {

constexpr std::size_t kMostEdits = 2;

}  // namespace

std::string NearestName(std::string_view name, std::span<const std::string> candidates) {
  const auto nearest = oca::internal::NearestOf(name, candidates);
  return nearest.candidate == nullptr ? "" : *nearest.candidate;
}

std::string MisspeltName(std::string_view name, std::span<const std::string> candidates) {
  const auto nearest = oca::internal::NearestOf(name, candidates);
  const bool near =
      nearest.candidate != nullptr && nearest.distance > 0 && nearest.distance <= kMostEdits;
  return near ? *nearest.candidate : "";
}

}  // namespace oca::models
