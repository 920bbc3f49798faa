// SPDX-License-Identifier: BSD-3-Clause
// Octrees written by OctoMap itself are the truth; damaged ones must be refused in words.
#include "oca/models/geometry/octree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <random>
#include <sstream>
#include <vector>

#include "oca/models/error.h"
#include "tests/temporary_folder.h"

namespace oca::geometry {
namespace octree_test {

using ::testing::HasSubstr;

// Edge length, then the centre; m.
using Leaf = std::array<double, 4>;

std::vector<Leaf> LeavesOf(const Compound& compound) {
  std::vector<Leaf> leaves;
  for (const CompoundPart& part : compound.parts) {
    const Eigen::Vector3d p = part.X_SP.translation();
    leaves.push_back({std::get<Box>(part.shape).size.x(), p.x(), p.y(), p.z()});
  }
  std::sort(leaves.begin(), leaves.end());
  return leaves;
}

std::vector<Leaf> OccupiedLeavesOf(const octomap::OcTree& tree) {
  std::vector<Leaf> leaves;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    leaves.push_back({leaf.getSize(), leaf.getX(), leaf.getY(), leaf.getZ()});
  }
  std::sort(leaves.begin(), leaves.end());
  return leaves;
}

/// Two scans of a sphere and a solid block, so that leaves of several sizes occur.
octomap::OcTree ScannedTree() {
  octomap::OcTree tree(0.05);
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  octomap::Pointcloud scan;
  for (int i = 0; i < 500; ++i) {
    octomap::point3d direction(normal(random), normal(random), normal(random));
    scan.push_back(direction.normalized() * 1.3F);
  }
  tree.insertPointCloud(scan, octomap::point3d(0.1F, 0.0F, -0.2F));
  for (int i = 0; i < 16 * 16 * 16; ++i) {
    const octomap::point3d cell(0.025F + 0.05F * static_cast<float>(i % 16),
                                0.025F + 0.05F * static_cast<float>(i / 16 % 16),
                                -0.025F - 0.05F * static_cast<float>(i / 256));
    for (int hits = 0; hits < 10; ++hits) tree.updateNode(cell, true);
  }
  tree.prune();
  return tree;
}

class OctreeTest : public ::testing::Test {
 protected:
  std::string Refusal(const std::string& name, const std::string& content) {
    try {
      LoadOctree(folder_.Write(name, content));
    } catch (const models::ModelError& error) {
      return error.what();
    }
    return "accepted";
  }
  test::TemporaryFolder folder_;
};

TEST_F(OctreeTest, TheLeavesAreThoseThatOctoMapWrote) {
  octomap::OcTree tree = ScannedTree();
  const auto full = folder_.path() / "map.ot", binary = folder_.path() / "map.bt";
  ASSERT_TRUE(tree.write(full.string()));
  const std::vector<Leaf> expected = OccupiedLeavesOf(tree);
  ASSERT_GT(expected.size(), 100u);
  EXPECT_GT(expected.back()[0], 0.3);  // the block: leaves of 8 cells
  const auto near = [](const std::vector<Leaf>& found, const std::vector<Leaf>& wanted) {
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      for (std::size_t k = 0; k < 4; ++k) ASSERT_NEAR(found[i][k], wanted[i][k], 1e-9) << i;
    }
  };
  const auto grid = [](std::vector<Leaf> leaves) {  // sums of doubles order differently
    for (Leaf& leaf : leaves) {
      for (double& x : leaf) x = std::round(x * 1e6) * 1e-6;
    }
    std::sort(leaves.begin(), leaves.end());
    return leaves;
  };
  near(grid(LeavesOf(LoadOctree(full))), grid(expected));
  ASSERT_TRUE(tree.writeBinary(binary.string()));
  near(grid(LeavesOf(LoadOctree(binary))), grid(OccupiedLeavesOf(tree)));
}

std::string Binary(const std::string& size, const std::string& data) {
  return "# Octomap OcTree binary file\n# made by hand\nid OcTree\nsize " + size +
         "\nres 0.1\ndata\n" + data;
}

TEST_F(OctreeTest, AChildOfTheRootIsAnEighthOfAllSpace) {
  // Root: child 0 free, child 7 occupied.
  const Compound map = LoadOctree(folder_.Write("a.bt", Binary("3", {'\x01', '\x80'})));
  ASSERT_EQ(map.parts.size(), 1u);
  EXPECT_NEAR(std::get<Box>(map.parts[0].shape).size.x(), 3276.8, 1e-9);
  EXPECT_NEAR(map.parts[0].X_SP.translation().y(), 1638.4, 1e-9);
}

TEST_F(OctreeTest, RefusesWhatIsNoOctree) {
  EXPECT_THAT(Refusal("a.oct", ""), HasSubstr("extension; got '.oct'; expected .bt or .ot"));
  EXPECT_THAT(Refusal("a.bt", "# Octomap OcTree file\n"), HasSubstr("a.bt:1: first line"));
  EXPECT_THAT(Refusal("b.bt", "# Octomap OcTree binary file\nres 0\n"), HasSubstr("b.bt:2: res"));
  EXPECT_THAT(Refusal("c.bt", "# Octomap OcTree binary file\nsize 1\ndata\n"),
              HasSubstr("c.bt:3: head; got no size or res"));
  EXPECT_THAT(Refusal("d.bt", "# Octomap OcTree binary file\nsize 1\n"),
              HasSubstr("no line 'data'"));
  EXPECT_THAT(Refusal("e.ot", "# Octomap OcTree file\nid ColorOcTree\n"),
              HasSubstr("e.ot:2: id; got ColorOcTree"));
  EXPECT_THAT(Refusal("f.bt", Binary("0", "")), HasSubstr("holds no occupied leaf"));
  EXPECT_THAT(Refusal("g.bt", Binary("4", {'\x01', '\x80'})), HasSubstr("got 4 nodes announced"));
  EXPECT_THAT(Refusal("h.bt", Binary("1e300", {'\x02', '\x00'})), HasSubstr("size; got 1e300"));
}

TEST_F(OctreeTest, RefusesMoreThanSixteenLevels) {
  std::string deep;  // each node's first child is an inner one
  for (int level = 0; level < 1'000'000; ++level) deep += std::string("\x03\x00", 2);
  EXPECT_THAT(Refusal("deep.bt", Binary("1000000", deep)), HasSubstr("at most 16"));
}

/// All there is below a node of this level, down to occupied leaves on level 7: 8^7 of them.
void AppendFull(int level, std::string& data) {
  data += level < 6 ? "\xff\xff" : "\xaa\xaa";
  for (int child = 0; level < 6 && child < 8; ++child) AppendFull(level + 1, data);
}

TEST_F(OctreeTest, RefusesMoreLeavesThanAMillion) {
  std::string wide;
  AppendFull(0, wide);
  EXPECT_THAT(Refusal("wide.bt", Binary("2396745", wide)), HasSubstr("at most 1000000"));
}

TEST_F(OctreeTest, RefusesEveryCutOfAFile) {
  octomap::OcTree tree(0.1);
  for (float x = -0.55F; x < 0.6F; x += 0.1F) tree.updateNode(octomap::point3d(x, x, 0.05F), true);
  for (const bool binary : {true, false}) {
    std::stringstream stream;
    ASSERT_TRUE(binary ? tree.writeBinary(stream) : tree.write(stream));
    const std::string whole = stream.str();
    const std::string name = binary ? "cut.bt" : "cut.ot";
    EXPECT_EQ(Refusal(name, whole), "accepted");
    for (std::size_t size = 0; size < whole.size(); ++size) {
      ASSERT_NE(Refusal(name, whole.substr(0, size)), "accepted") << name << " " << size;
    }
  }
}

TEST_F(OctreeTest, NeverCrashesOnRandomBytes) {
  std::mt19937 random(6);
  for (int round = 0; round < 300; ++round) {
    std::string noise(random() % 400, '\0');
    for (char& byte : noise) byte = static_cast<char>(random());
    EXPECT_NE(Refusal("noise.bt", Binary("100", noise)), "") << round;
    EXPECT_NE(
        Refusal("noise.ot", "# Octomap OcTree file\nid OcTree\nsize 100\nres 0.1\ndata\n" + noise),
        "")
        << round;
  }
}

}  // namespace octree_test
}  // namespace oca::geometry
