// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/data_folders.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "oca/diagrams/files/package_paths.h"
#include "tests/temporary_folder.h"

namespace oca::files {
namespace data_folders_test {

TEST(DataFoldersTest, APackageOfAnInstallationIsFoundBeforeThatOfTheSources) {
  const test::TemporaryFolder folder;
  folder.Write("models/robots/planar2/planar2.urdf", "<robot/>");
  EXPECT_NE(ResolvePath("package://planar2/planar2.urdf", {}, {}),
            folder.path() / "models/robots/planar2/planar2.urdf");
  AddDataFolder(folder.path());
  EXPECT_EQ(ResolvePath("package://planar2/planar2.urdf", {}, {}),
            folder.path() / "models/robots/planar2/planar2.urdf");
  EXPECT_EQ(DataFolders().back(), OCA_SOURCE_DIR);
}

TEST(DataFoldersTest, OneThatIsToldOfTwiceCountsOnce) {
  AddDataFolder("/somewhere");
  AddDataFolder("/somewhere");
  const auto folders = DataFolders();
  EXPECT_EQ(std::count(folders.begin(), folders.end(), "/somewhere"), 1);
}

TEST(DataFoldersTest, APartOfAnInstallationIsOcas) {
  const test::TemporaryFolder folder;
  const auto part = folder.Write("diagrams/parts/avoidance.yaml", "parameters: {}\n");
  EXPECT_FALSE(IsPartOfOca(part)) << "another file of that name";
  AddDataFolder(folder.path());
  EXPECT_TRUE(IsPartOfOca(part));
}

}  // namespace data_folders_test
}  // namespace oca::files
