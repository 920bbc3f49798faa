// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/decomposition_cache.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "oca/models/error.h"
#include "oca/models/file_bytes.h"
#include "oca/models/geometry/decomposition.h"
#include "oca/models/whole_file.h"

namespace oca::geometry {
namespace {

namespace fs = std::filesystem;

// Changes with the way parts are made or written.
constexpr std::string_view kMagic = "OCA decomposition 2\n";
constexpr std::size_t kPointSize = 3 * sizeof(double);

// FNV-1a of 64 bits from a given start.
std::uint64_t Hash(std::string_view bytes, std::uint64_t hash) {
  for (const char byte : bytes) {
    hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3ull;
  }
  return hash;
}

template <class T>
std::string_view BytesOf(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof(T)};
}

template <class T>
bool Take(std::string_view& rest, T* value) {
  if (rest.size() < sizeof(T)) return false;
  std::memcpy(value, rest.data(), sizeof(T));
  rest.remove_prefix(sizeof(T));
  return true;
}

}  // namespace

fs::path DecompositionCache() {
  // An empty or relative value counts as none. source XDG Base Directory Specification
  const auto folder = [](const char* variable) -> fs::path {
    const char* const value = std::getenv(variable);
    return value != nullptr && fs::path(value).is_absolute() ? fs::path(value) : fs::path();
  };
  if (const fs::path cache = folder("XDG_CACHE_HOME"); !cache.empty()) return cache / "oca";
  if (const fs::path home = folder("HOME"); !home.empty()) return home / ".cache" / "oca";
  return {};
}

namespace internal {

DecompositionEntry::DecompositionEntry(const fs::path& cache, const fs::path& mesh,
                                       const Eigen::Vector3d& scale, double concavity) {
  if (cache.empty()) return;
  std::string content = models::ReadFile(mesh);
  content += mesh.extension().string();
  for (const double number : {scale.x(), scale.y(), scale.z(), concavity}) {
    content += BytesOf(number);
  }
  file_ = cache / fmt::format("{:016x}{:016x}.parts", Hash(content, 0xcbf29ce484222325ull),
                              Hash(content, 0x9ae16a3b2f90404full));
}

std::vector<std::shared_ptr<const ConvexHull>> PartsOf(std::string_view body,
                                                       const std::string& name) {
  std::vector<std::shared_ptr<const ConvexHull>> parts;
  std::uint64_t count = 0;
  if (!Take(body, &count)) return {};
  while (parts.size() < count) {
    std::uint64_t points = 0;
    if (!Take(body, &points) || points > body.size() / kPointSize) return {};
    std::vector<Eigen::Vector3d> vertices(points);
    for (Eigen::Vector3d& p : vertices) {
      for (int axis = 0; axis < 3; ++axis) Take(body, &p[axis]);
    }
    try {
      parts.push_back(MakeConvexHull(vertices, fmt::format("{} part {}", name, parts.size())));
    } catch (const models::ModelError&) {
      return {};
    }
  }
  return parts;
}

std::vector<std::shared_ptr<const ConvexHull>> DecompositionEntry::Read(
    const std::string& name) const {
  std::error_code error;
  if (file_.empty() || !fs::is_regular_file(file_, error)) return {};
  try {
    const std::string text = models::ReadUnnoted(file_);
    std::string_view rest = text;
    std::uint64_t sum = 0;
    if (!rest.starts_with(kMagic)) return {};
    rest.remove_prefix(kMagic.size());
    if (!Take(rest, &sum) || sum != Hash(rest, 0)) return {};
    return PartsOf(rest, name);
  } catch (const models::ModelError&) {  // damaged: it is made anew
    return {};
  }
}

void DecompositionEntry::Write(const std::vector<std::shared_ptr<const ConvexHull>>& parts) const {
  if (file_.empty()) return;
  std::string body(BytesOf(static_cast<std::uint64_t>(parts.size())));
  for (const auto& hull : parts) {
    body += BytesOf(static_cast<std::uint64_t>(hull->vertices.size()));
    for (const Eigen::Vector3d& p : hull->vertices) {
      for (int axis = 0; axis < 3; ++axis) body += BytesOf(p[axis]);
    }
  }
  std::error_code error;
  fs::create_directories(file_.parent_path(), error);
  try {
    models::WholeFile file(file_);
    file.stream() << kMagic << BytesOf(Hash(body, 0)) << body;
    file.Commit();
  } catch (const models::ModelError&) {  // it is made anew another time
  }
}

}  // namespace internal
}  // namespace oca::geometry
