// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace oca::scenes::internal {

inline constexpr std::uintmax_t kLargestScene = 32'000'000;  ///< bytes of a file
inline constexpr std::size_t kMostNodes = 2'000'000;         ///< values of a file
inline constexpr std::size_t kMostKeys = 2'000;              ///< of a map, which is searched

/// A value of a YAML file that others' programs wrote: less strict than a diagram file, in which a
/// key must have a value and numbers be written one way.
struct ForeignValue {
  enum class Kind { kNull, kScalar, kList, kMap };
  Kind kind{Kind::kNull};
  bool quoted{false};
  int line{1};
  std::string text{};                 ///< of a scalar
  std::vector<std::string> keys{};    ///< of a map, one an item
  std::vector<ForeignValue> items{};  ///< of a list or map
};

/// A value with the way to it, which messages begin with: `file:line: world.collision_objects[2]`.
/// Valid as long as the tree.
class Foreign {
 public:
  Foreign(std::shared_ptr<const std::string> file, const ForeignValue& value, std::string path)
      : file_(std::move(file)), value_(&value), path_(std::move(path)) {}

  int line() const { return value_->line; }
  const std::string& path() const { return path_; }
  /// `file:line`
  std::string where() const;
  bool is_null() const { return value_->kind == ForeignValue::Kind::kNull; }
  bool is_scalar() const { return value_->kind == ForeignValue::Kind::kScalar; }
  bool is_list() const { return value_->kind == ForeignValue::Kind::kList; }
  bool is_map() const { return value_->kind == ForeignValue::Kind::kMap; }
  /// How many items a list or map has.
  std::size_t size() const { return value_->items.size(); }

  /// Of a map; none if there is no such key, or one without a value.
  std::optional<Foreign> Find(std::string_view key) const;
  /// throws ModelError if there is none
  Foreign Get(std::string_view key) const;
  /// Items of a list; of `key` of a map, none if that is not there.
  std::vector<Foreign> Items() const;
  std::vector<Foreign> Items(std::string_view key) const;
  /// The keys that are not among `known`, each with its place: `file:line: path.key`.
  std::vector<std::string> Unknown(std::initializer_list<std::string_view> known) const;

  /// throws ModelError unless it is a finite number, or so many of them
  double Number() const;
  std::vector<double> Numbers() const;
  std::vector<double> Numbers(std::string_view key) const;
  /// A whole number up to `most`.
  std::size_t Count(std::size_t most) const;
  bool Bool() const;
  /// Any scalar; the key's, or an empty one if it is not there.
  std::string Text() const;
  std::string Text(std::string_view key) const;
  std::vector<std::string> Texts(std::string_view key) const;
  /// Three numbers: a list, or a map of x, y and z.
  Eigen::Vector3d Vector() const;
  /// `position` and `orientation`, or `translation` and `rotation`, each as a list or a map; what
  /// is not there is zero.
  Eigen::Isometry3d Pose() const;
  /// [x, y, z, w] as a list or a map. throws ModelError unless of length 1 to three digits
  Eigen::Quaterniond Rotation() const;

  /// throws ModelError `file:line: path; got X; expected Y`
  [[noreturn]] void Refuse(std::string_view got, std::string_view expected) const;
  [[noreturn]] void Refuse(std::string_view expected) const { Refuse(Shown(), expected); }
  /// What it is, for a message.
  std::string Shown() const;

 private:
  Foreign Child(std::size_t i, const std::string& path) const {
    return {file_, value_->items[i], path};
  }
  std::vector<double> Components(std::initializer_list<std::string_view> names) const;
  void CheckMap() const;

  std::shared_ptr<const std::string> file_;
  const ForeignValue* value_;
  std::string path_;
};

/// Reads a YAML file whole. throws ModelError `file:line: ...` for what cannot be read, is too
/// large, no YAML, nests too deep, has an alias, or a key twice
ForeignValue ReadForeignYaml(const std::filesystem::path& file);

}  // namespace oca::scenes::internal
