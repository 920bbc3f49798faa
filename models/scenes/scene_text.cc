// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/scenes/scene_text.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "oca/models/file_bytes.h"
#include "oca/models/foreign_text.h"
#include "oca/models/geometry/rotation.h"
#include "oca/models/scenes/foreign_tree.h"
#include "oca/models/scenes/scene_bodies.h"
#include "oca/models/table_text.h"

namespace oca::scenes::internal {
namespace {

using models::internal::RefuseText;

constexpr std::uint64_t kMostInText = 1'000'000;  // of each kind of thing

class TextReader {
 public:
  explicit TextReader(const std::filesystem::path& file)
      : file_(file), text_(models::ReadFile(file, kLargestScene)), rest_(text_) {
    if (models::internal::Utf8Prefix(text_) != text_.size()) {
      RefuseText(file_, 0, "text", "bytes that are none", "UTF-8");
    }
  }

  PlanningScene Read() {
    scene_.name = std::string(models::internal::Trimmed(Line()));
    while (true) {
      const std::string_view marker = Word("'*' before an object or '.' at the end");
      if (marker == ".") break;
      if (marker != "*") Refuse("marker", marker, "'*' before an object or '.' at the end");
      ReadObject();
    }
    return std::move(scene_);
  }

 private:
  void ReadObject() {
    SceneObject object;
    object.where = Where();
    object.id = std::string(models::internal::Trimmed(Line()));
    if (object.id.empty()) Refuse("object", "no id", "one behind the '*'");
    if (!ids_.insert(object.id).second) Refuse("object", object.id + " twice", "ids that differ");
    if (scene_.objects.empty()) posed_ = NextLineHasBlanks();
    if (posed_) object.X_FO = Pose();
    const std::uint64_t shapes = Count("number of shapes");
    if (shapes == 0) Refuse("number of shapes", "0", "one at least");
    for (std::uint64_t i = 0; i < shapes; ++i) {
      SceneBody body{.where = Where()};
      body.shape = ReadShape();
      body.X_OB = Pose();
      for (int colour = 0; colour < 4; ++colour) Number("colour");
      object.bodies.push_back(std::move(body));
    }
    if (posed_) ReadSubframes(object);
    scene_.objects.push_back(std::move(object));
  }

  void ReadSubframes(SceneObject& object) {
    const std::uint64_t count = Count("number of subframes");
    for (std::uint64_t i = 0; i < count; ++i) {
      SceneFrame frame{std::string(Word("a subframe")), "", {}, Where()};
      frame.X_PF = Pose();
      object.subframes.push_back(std::move(frame));
    }
  }

  decltype(SceneBody::shape) ReadShape() {
    const std::string type(Word("a type of shape"));
    const std::string where = Where();
    if (type == "mesh") return ReadMesh(where);
    if (type == "plane") return PlaneOf(Sizes(4), where);
    if (type == "cylinder" || type == "cone") {
      const std::vector<double> sizes = Sizes(2);  // here the radius comes first
      return PrimitiveOf(type, std::vector<double>{sizes[1], sizes[0]}, where);
    }
    return PrimitiveOf(type, Sizes(type == "box" ? 3 : type == "sphere" ? 1 : 0), where);
  }

  geometry::TriangleMesh ReadMesh(const std::string& where) {
    geometry::TriangleMesh mesh;
    const std::uint64_t vertices = Count("number of vertices");
    const std::uint64_t triangles = Count("number of triangles");
    for (std::uint64_t i = 0; i < vertices; ++i) {
      const auto xyz = Sizes(3);
      mesh.vertices.emplace_back(xyz[0], xyz[1], xyz[2]);
    }
    for (std::uint64_t i = 0; i < triangles; ++i) {
      std::array<int, 3> corners{};
      for (int& corner : corners) corner = static_cast<int>(Count("index of a vertex"));
      mesh.triangles.push_back(corners);
    }
    CheckTriangles(mesh, where);
    return mesh;
  }

  Eigen::Isometry3d Pose() {
    const auto xyz = Sizes(3);
    const auto q = Sizes(4);
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() << xyz[0], xyz[1], xyz[2];
    X.linear() = geometry::FromQuaternion({q[0], q[1], q[2], q[3]}, Where() + ": quaternion")
                     .toRotationMatrix();
    return X;
  }

  std::vector<double> Sizes(int count) {
    std::vector<double> numbers;
    for (int i = 0; i < count; ++i) numbers.push_back(Number("a number"));
    return numbers;
  }

  double Number(std::string_view what) {
    const std::string_view word = Word(what);
    const auto number = models::internal::ToNumber(word);
    if (!number || !std::isfinite(*number)) Refuse(what, word, "a finite number");
    return *number;
  }

  std::uint64_t Count(std::string_view what) {
    const std::string_view word = Word(what);
    const auto count = models::internal::ToCount(word, kMostInText);
    if (!count) Refuse(what, word, fmt::format("a whole number up to {}", kMostInText));
    return *count;
  }

  /// The next word, whatever line it is in.
  std::string_view Word(std::string_view what) {
    constexpr std::string_view kGaps = " \t\r\n";
    while (!rest_.empty() && kGaps.find(rest_.front()) != std::string_view::npos) {
      line_ += rest_.front() == '\n' ? 1 : 0;
      rest_.remove_prefix(1);
    }
    if (rest_.empty()) Refuse(what, "the end of the file", "more");
    const std::string_view word = rest_.substr(0, rest_.find_first_of(kGaps));
    rest_.remove_prefix(word.size());
    return word;
  }

  /// What is left of the line, up to its end.
  std::string_view Line() {
    std::string_view line = rest_.substr(0, rest_.find('\n'));
    rest_.remove_prefix(line.size());
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  bool NextLineHasBlanks() const {
    std::string_view rest = rest_;
    models::internal::TakeLine(rest);
    return models::internal::Trimmed(models::internal::TakeLine(rest)).find_first_of(" \t") !=
           std::string_view::npos;
  }

  std::string Where() const { return fmt::format("{}:{}", file_.string(), line_); }

  [[noreturn]] void Refuse(std::string_view what, std::string_view got,
                           std::string_view expected) const {
    RefuseText(file_, line_, what, models::internal::Shown(got), expected);
  }

  const std::filesystem::path& file_;
  const std::string text_;
  std::string_view rest_;
  int line_{1};
  bool posed_{false};
  std::set<std::string> ids_;
  PlanningScene scene_;
};

}  // namespace

PlanningScene ReadSceneText(const std::filesystem::path& file) { return TextReader(file).Read(); }

}  // namespace oca::scenes::internal
