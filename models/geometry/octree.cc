// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/octree.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

#include "oca/models/file_bytes.h"
#include "oca/models/file_cache.h"
#include "oca/models/table_text.h"

namespace oca::geometry {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using models::internal::RefuseText;

constexpr int kDepth = 16;
constexpr std::size_t kMostLeaves = 1'000'000;
constexpr std::uint64_t kMostNodes = 1'000'000'000;  // eight a 2-byte record of a file
constexpr double kLargestCell = 1e3;                 // m, of 2^16 along each edge

struct Head {
  bool binary{false};
  double resolution{0.0};  // m, edge of the smallest cell
  std::optional<std::uint64_t> nodes{};
};

/// Takes the head off `rest`, down to the line `data`.
Head ReadHead(const fs::path& file, bool binary, std::string_view& rest) {
  const std::string_view first = binary ? "# Octomap OcTree binary file" : "# Octomap OcTree file";
  const std::string_view line = models::internal::TakeLine(rest);
  if (line != first)
    models::internal::RefuseText(file, 1, "first line", "'" + std::string(line) + "'", first);
  Head head{.binary = binary};
  for (int number = 2; !rest.empty(); ++number) {
    const auto words = models::internal::Words(models::internal::TakeLine(rest));
    if (words.empty() || words[0].starts_with('#')) continue;
    if (words[0] == "data") {
      if (head.resolution > 0.0 && head.nodes) return head;
      models::internal::RefuseText(file, number, "head", "no size or res",
                                   "id, size and res before data");
    }
    if (words.size() < 2)
      models::internal::RefuseText(file, number, "head", words[0], "id, size, res or data");
    const double value = models::internal::ToNumber(words[1]).value_or(-1.0);
    const auto nodes = models::internal::ToCount(words[1], kMostNodes);
    if (words[0] == "res" && value > 0.0 && value <= kLargestCell) {
      head.resolution = value;
    } else if (words[0] == "size" && nodes) {
      head.nodes = nodes;
    } else if (words[0] != "id" || (!binary && words[1] != "OcTree")) {
      models::internal::RefuseText(
          file, number, words[0], words[1],
          fmt::format("id OcTree, a size up to {}, a res above 0 and up to {} m", kMostNodes,
                      kLargestCell));
    }
  }
  models::internal::RefuseText(file, 0, "ends too early", "no line 'data'",
                               "one after id, size and res");
}

/// Walks the nodes as they stand in the file, depth first.
class Reader {
 public:
  Reader(const fs::path& file, const Head& head, std::string_view data)
      : file_(file), head_(head), rest_(data) {}

  Compound Read() {
    if (*head_.nodes > 0) {
      ++nodes_;
      Node(0, {0, 0, 0});
    }
    if (nodes_ != *head_.nodes) {
      models::internal::RefuseText(file_, 0, "size",
                                   fmt::format("{} nodes announced", *head_.nodes),
                                   fmt::format("the {} that there are", nodes_));
    }
    if (map_.parts.empty())
      models::internal::RefuseText(file_, 0, "holds no occupied leaf", "none", "at least one");
    return std::move(map_);
  }

 private:
  using Corner = std::array<int, 3>;  // least one, in smallest cells from the root's

  void Node(int depth, const Corner& corner) {
    if (head_.binary) {
      const auto kinds = Take<std::uint16_t>();
      for (int i = 0; i < 8; ++i) {
        const int kind = kinds >> (2 * i) & 3;  // 0 unknown, 1 free, 2 occupied, 3 inner
        if (kind == 0) continue;
        const Corner child = Child(depth, corner, i);
        if (kind == 2) AddLeaf(depth + 1, child);
        if (kind == 3) Node(depth + 1, child);
      }
      return;
    }
    const auto log_odds = Take<float>();
    const auto children = Take<std::uint8_t>();
    if (std::isnan(log_odds))
      models::internal::RefuseText(file_, 0, "log-odds of a node", "NaN", "a number");
    if (children == 0 && log_odds >= 0.0F) AddLeaf(depth, corner);
    for (int i = 0; i < 8; ++i) {
      if ((children >> i & 1) != 0) Node(depth + 1, Child(depth, corner, i));
    }
  }

  Corner Child(int depth, const Corner& corner, int i) {
    if (depth >= kDepth) {
      models::internal::RefuseText(file_, 0, "tree", "more levels",
                                   fmt::format("at most {}", kDepth));
    }
    ++nodes_;
    const int size = 1 << (kDepth - depth - 1);
    return {corner[0] + size * (i & 1), corner[1] + size * (i >> 1 & 1),
            corner[2] + size * (i >> 2 & 1)};
  }

  void AddLeaf(int depth, const Corner& corner) {
    if (map_.parts.size() >= kMostLeaves) {
      models::internal::RefuseText(file_, 0, "occupied leaves", "more",
                                   fmt::format("at most {}", kMostLeaves));
    }
    const double size = std::ldexp(head_.resolution, kDepth - depth);
    const double middle = std::ldexp(1.0, kDepth - 1);
    CompoundPart& box = map_.parts.emplace_back();
    box.shape = Box{Vector3d::Constant(size)};
    for (int axis = 0; axis < 3; ++axis) {
      box.X_SP.translation()[axis] = (corner[axis] - middle) * head_.resolution + 0.5 * size;
    }
  }

  template <class T>
  T Take() {
    T value;
    if (rest_.size() < sizeof value) {
      models::internal::RefuseText(file_, 0, "ends too early", fmt::format("{} nodes", nodes_),
                                   fmt::format("{} and their children", *head_.nodes));
    }
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }

  const fs::path& file_;
  const Head head_;
  std::string_view rest_;
  std::uint64_t nodes_{0};
  Compound map_;
};

}  // namespace

Compound LoadOctree(const fs::path& file) {
  const std::string kind = models::internal::Lower(file.extension().string());
  if (kind != ".bt" && kind != ".ot") {
    models::internal::RefuseText(file, 0, "extension", "'" + kind + "'", ".bt or .ot");
  }
  return *models::ReadOnce<Compound>(file, "octree", [&] {
    const std::string text = models::ReadFile(file);
    std::string_view rest = text;
    const Head head = ReadHead(file, kind == ".bt", rest);
    return Reader(file, head, rest).Read();
  });
}

}  // namespace oca::geometry
