// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/readers.h"

#include <filesystem>
#include <string>

#include "oca/diagrams/files/document.h"
#include "oca/diagrams/files/json_reader.h"
#include "oca/diagrams/record/extracted_record.h"
#include "oca/diagrams/record/mcap_reader.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/signal.h"
#include "oca/models/csv_table.h"
#include "oca/models/error.h"
#include "oca/models/geometry/mesh.h"
#include "oca/models/geometry/octree.h"
#include "oca/models/geometry/point_cloud.h"
#include "oca/models/robot/joint_limits_file.h"
#include "oca/models/robot/srdf.h"
#include "oca/models/robot/urdf.h"
#include "oca/models/robot/xacro.h"
#include "oca/systems/signals/signals.h"
#include "tests/temporary_folder.h"

namespace oca::test {
namespace {

/// The file of that name, in a folder of this process, with these bytes.
std::filesystem::path FileOf(const char* name, std::string_view bytes) {
  static const TemporaryFolder folder;
  return folder.Write(name, bytes);
}

/// Calls `read` and returns whether it did not refuse.
template <class Read>
bool Accepts(Read read) {
  try {
    read();
    return true;
  } catch (const ConfigError&) {
    return false;
  } catch (const models::ModelError&) {
    return false;
  }
}

bool ReadDocument(std::string_view bytes) {
  return Accepts([&] {
    Problems problems;
    files::LoadDocument(FileOf("fuzz.yaml", bytes), {}, problems);
    problems.Throw();
  });
}

bool ReadUrdf(std::string_view bytes) {
  return Accepts([&] { robot::ParseUrdf(std::string(bytes), "fuzz.urdf"); });
}

bool ReadXacro(std::string_view bytes) {
  return Accepts([&] { robot::ExpandXacro(FileOf("fuzz.xacro", bytes)); });
}

/// What xacro.load_yaml reads.
bool ReadXacroYaml(std::string_view bytes) {
  return Accepts([&] {
    FileOf("fuzz_values.yaml", bytes);
    robot::ExpandXacro(
        FileOf("reader.xacro", "<robot name=\"${xacro.load_yaml('fuzz_values.yaml')}\"/>"));
  });
}

bool ReadSrdf(std::string_view bytes) {
  static const robot::SrdfRobot robot{
      "planar2",
      {"planar2_base_link", "planar2_link_1", "planar2_link_2", "planar2_tip"},
      {"planar2_joint_1", "planar2_joint_2", "planar2_tip_joint"}};
  return Accepts([&] { robot::LoadSrdf(FileOf("fuzz.srdf", bytes), robot); });
}

bool ReadJointLimits(std::string_view bytes) {
  return Accepts([&] { robot::JointLimitsFile limits(FileOf("fuzz_limits.yaml", bytes)); });
}

bool ReadCsv(std::string_view bytes) {
  return Accepts([&] {
    models::CsvTable table(FileOf("fuzz.csv", bytes));
    while (table.NextRow()) {
      for (std::size_t column = 0; column < table.width(); ++column) table.AnyNumber(column);
    }
  });
}

bool ReadPcd(std::string_view bytes) {
  return Accepts([&] { geometry::LoadPointCloud(FileOf("fuzz.pcd", bytes)); });
}

bool ReadPly(std::string_view bytes) {
  return Accepts([&] { geometry::LoadPointCloud(FileOf("fuzz.ply", bytes)); });
}

bool ReadPlyMesh(std::string_view bytes) {
  return Accepts([&] { geometry::LoadMesh(FileOf("fuzz_mesh.ply", bytes)); });
}

bool ReadStl(std::string_view bytes) {
  return Accepts([&] { geometry::LoadMesh(FileOf("fuzz.stl", bytes)); });
}

bool ReadPgm(std::string_view bytes) {
  return Accepts([&] { geometry::LoadHeightmap(FileOf("fuzz.pgm", bytes), 0.05, 1.0); });
}

bool ReadBinaryTree(std::string_view bytes) {
  return Accepts([&] { geometry::LoadOctree(FileOf("fuzz.bt", bytes)); });
}

bool ReadFullTree(std::string_view bytes) {
  return Accepts([&] { geometry::LoadOctree(FileOf("fuzz.ot", bytes)); });
}

template <class T>
bool ReadSignal(std::string_view bytes) {
  return Accepts([&] { Signal<T>::ReadJson(bytes); });
}

/// What `eval` reads: parameters, and inputs of every type that others make.
bool ReadJson(std::string_view bytes) {
  bool accepted = Accepts([&] { files::ReadJson(bytes, "fuzz"); });
  accepted |= Accepts([&] { ReadVectorJson(bytes); });
  accepted |= ReadSignal<systems::ObstacleSet>(bytes);
  accepted |= ReadSignal<systems::LinkPoses>(bytes);
  accepted |= ReadSignal<systems::ProximitySet>(bytes);
  accepted |= ReadSignal<systems::LinkForceSet>(bytes);
  accepted |= ReadSignal<systems::WrenchSet>(bytes);
  return accepted;
}

bool ReadRecord(std::string_view bytes) {
  return Accepts([&] {
    const auto record = record::McapFile::Parse(std::string(bytes), "fuzz.mcap");
    const record::ExtractedRecord extracted(record);
  });
}

constexpr Reader kReaders[] = {
    {"csv", ReadCsv},
    {"document", ReadDocument},
    {"joint_limits", ReadJointLimits},
    {"json", ReadJson},
    {"octree_bt", ReadBinaryTree},
    {"octree_ot", ReadFullTree},
    {"pcd", ReadPcd},
    {"pgm", ReadPgm},
    {"ply", ReadPly},
    {"ply_mesh", ReadPlyMesh},
    {"record", ReadRecord},
    {"srdf", ReadSrdf},
    {"stl", ReadStl},
    {"urdf", ReadUrdf},
    {"xacro", ReadXacro},
    {"xacro_yaml", ReadXacroYaml},
};

}  // namespace

std::span<const Reader> Readers() { return kReaders; }

}  // namespace oca::test
