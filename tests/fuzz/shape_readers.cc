// SPDX-License-Identifier: BSD-3-Clause
// Meshes, clouds, maps and tables of numbers.
#include "oca/models/csv_table.h"
#include "oca/models/geometry/decomposition_cache.h"
#include "oca/models/geometry/mesh.h"
#include "oca/models/geometry/octree.h"
#include "oca/models/geometry/point_cloud.h"
#include "oca/models/motion/key_points.h"
#include "oca/models/motion/waypoints.h"
#include "tests/fuzz/foreign_bytes.h"

namespace oca::test {
namespace {

bool ReadCsv(std::string_view bytes) {
  const std::string file = FileOf("fuzz.csv", bytes).string();
  const bool table = Accepts([&] {
    models::CsvTable rows(file);
    while (rows.NextRow()) {
      for (std::size_t column = 0; column < rows.width(); ++column) rows.AnyNumber(column);
    }
  });
  Accepts([&] { motion::ReadWaypoints(file); });
  Accepts([&] { motion::ReadKeyPoints(file, {"a1", "a2"}); });
  return table;
}

template <const char* kName>
bool ReadCloud(std::string_view bytes) {
  return Accepts([&] { geometry::LoadPointCloud(FileOf(kName, bytes)); });
}

template <const char* kName>
bool ReadMap(std::string_view bytes) {
  return Accepts([&] { geometry::LoadHeightmap(FileOf(kName, bytes), 0.05, 1.0); });
}

template <const char* kName>
bool ReadMesh(std::string_view bytes) {
  return Accepts([&] { geometry::LoadMesh(FileOf(kName, bytes)); });
}

bool ReadParts(std::string_view bytes) {
  return !geometry::internal::PartsOf(bytes, "fuzz").empty();
}

template <const char* kName>
bool ReadTree(std::string_view bytes) {
  return Accepts([&] { geometry::LoadOctree(FileOf(kName, bytes)); });
}

constexpr char kPcd[] = "fuzz.pcd", kPly[] = "fuzz.ply", kPgm[] = "fuzz.pgm", kStl[] = "fuzz.stl",
               kObj[] = "fuzz.obj", kDae[] = "fuzz.dae", kBt[] = "fuzz.bt", kOt[] = "fuzz.ot",
               kCsv[] = "fuzz_map.csv";

}  // namespace

std::vector<Reader> ShapeReaders() {
  using enum Reader::Kind;
  return {{"csv", kText, ReadCsv},
          {"dae", kText, ReadMesh<kDae>},
          {"heightmap", kText, ReadMap<kCsv>},
          {"obj", kText, ReadMesh<kObj>},
          {"octree_bt", kBinary, ReadTree<kBt>},
          {"octree_ot", kBinary, ReadTree<kOt>},
          {"parts", kBinary, ReadParts},
          {"pcd", kBinary, ReadCloud<kPcd>},
          {"pgm", kBinary, ReadMap<kPgm>},
          {"ply", kBinary, ReadCloud<kPly>},
          {"ply_mesh", kBinary, ReadMesh<kPly>},
          {"stl", kBinary, ReadMesh<kStl>}};
}

}  // namespace oca::test
