// SPDX-License-Identifier: BSD-3-Clause
#include "systems/csv_table.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "framework/error.h"
#include "systems/key_points.h"
#include "systems/obstacle_motion.h"
#include "tests/temporary_folder.h"

namespace oca::systems {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

class CsvTableTest : public ::testing::Test {
 protected:
  const std::string& Write(std::string_view text) const {
    std::ofstream(file_, std::ios::binary) << text;
    return file_;
  }
  /// Of a table whose cells are all numbers, or should be.
  static std::string RefusalOf(const std::string& file) {
    try {
      CsvTable table(file);
      while (table.NextRow()) {
        for (std::size_t i = 0; i < table.cells().size(); ++i) table.Number(i);
      }
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  }

  const test::TemporaryFolder folder_;
  const std::string file_ = (folder_.path() / "table.csv").string();
};

/// What both readers of tables say of a file; of different words, both.
std::string RefusalOfReaders(const std::string& file) {
  std::string points, waypoints;
  try {
    ReadKeyPoints(file);
  } catch (const ConfigError& error) {
    points = error.what();
  }
  try {
    ReadWaypoints(file);
  } catch (const ConfigError& error) {
    waypoints = error.what();
  }
  return points == waypoints ? points : points + " | " + waypoints;
}

TEST_F(CsvTableTest, SkipsBlankLinesAndCommentsAndCountsThem) {
  CsvTable table(Write("# caf\xc3\xa9, 1\n\n \t\r\na, b ,,\r\n  # c\n+1,-2.5e1"));
  ASSERT_TRUE(table.NextRow());
  EXPECT_THAT(table.cells(), ElementsAre("a", "b", "", ""));
  EXPECT_THAT(table.where(), EndsWith(".csv:4"));
  ASSERT_TRUE(table.NextRow());
  EXPECT_THAT(table.where(), EndsWith(".csv:6"));
  EXPECT_EQ(table.Number(0), 1.0);
  EXPECT_EQ(table.Number(1), -25.0);
  EXPECT_FALSE(table.NextRow());
  EXPECT_FALSE(table.NextRow());
}

TEST_F(CsvTableTest, HasNoRowsInAnEmptyFile) {
  CsvTable table(Write(""));
  EXPECT_FALSE(table.NextRow());
}

TEST_F(CsvTableTest, RefusesWhatIsNoFiniteNumber) {
  for (const char* cell : {"nan", "inf", "1e999", "0x1", "1 2", "+-1", "++1", "+", "1;"}) {
    EXPECT_THAT(RefusalOf(Write(std::string("0,") + cell)),
                HasSubstr(std::string(":1: not a number; got '") + cell + "'"));
  }
  EXPECT_THAT(RefusalOf(Write("1,,2")), HasSubstr("not a number; got ''"));
}

TEST_F(CsvTableTest, RefusesControlCharactersWithoutRepeatingThem) {
  for (const char c : {'\0', '\x01', '\x1b', '\x1f', '\x7f'}) {
    const std::string refusal = RefusalOf(Write("1\n2" + std::string(1, c) + "\n"));
    EXPECT_THAT(refusal, HasSubstr(":2: control character; got byte 0x")) << int{c};
    EXPECT_EQ(refusal.find(c), std::string::npos) << int{c};
  }
  EXPECT_THAT(RefusalOf(Write("# \x1b[2J\n1\n")), HasSubstr(":1: control character"));
  EXPECT_EQ(RefusalOf(Write("1,\t2 \r\n")), "accepted");
}

TEST_F(CsvTableTest, ShowsBytesThatAreNotAsciiAndLongCellsOnlyInPart) {
  EXPECT_THAT(RefusalOf(Write("\x9b\xc2\x85z")), HasSubstr("got '???z'"));
  EXPECT_THAT(RefusalOf(Write("a\rb")), HasSubstr("got 'a?b'"));
  EXPECT_THAT(RefusalOf(Write(std::string(41, 'x'))),
              HasSubstr("got '" + std::string(40, 'x') + "'"));
}

TEST_F(CsvTableTest, RefusesAPipeInsteadOfWaitingForItsWriter) {
  ASSERT_EQ(mkfifo(file_.c_str(), 0600), 0);
  EXPECT_THAT(RefusalOfReaders(file_), EndsWith(".csv: not a regular file; got a folder, pipe or "
                                                "device; expected a CSV file"));
}

TEST_F(CsvTableTest, RefusesADeviceThatNeverEnds) {
  EXPECT_EQ(RefusalOfReaders("/dev/zero"),
            "/dev/zero: not a regular file; got a folder, pipe or device; expected a CSV file");
}

TEST_F(CsvTableTest, RefusesFoldersAndMissingFiles) {
  EXPECT_THAT(RefusalOfReaders(::testing::TempDir()), HasSubstr("not a regular file"));
  EXPECT_EQ(RefusalOfReaders("no/such/file.csv"),
            "no/such/file.csv: cannot be read; expected a CSV file");
}

TEST_F(CsvTableTest, RefusesByItsSizeWhatWouldFillTheMemory) {
  Write("");
  std::filesystem::resize_file(file_, std::uintmax_t{1} << 40);  // a hole, which takes no room
  EXPECT_THAT(RefusalOfReaders(file_),
              EndsWith(".csv: too large; got 1099511627776 bytes; expected at most 67108864"));
}

TEST_F(CsvTableTest, ReadsUpToTheLargestSize) {
  Write("");
  std::filesystem::resize_file(file_, CsvTable::kLargestFile + 1);
  EXPECT_THAT(RefusalOf(file_), HasSubstr("too large; got 67108865 bytes"));
  std::filesystem::resize_file(file_, CsvTable::kLargestFile);
  EXPECT_THAT(RefusalOf(file_), HasSubstr(":1: control character; got byte 0x00"));
}

TEST_F(CsvTableTest, LetsWaypointsHaveCommentsAsKeyPointsDo) {
  const auto points = ReadWaypoints(Write("# by hand\n\ntime,x,y,z\n# first\n+0,1,2,3\n"));
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].xyz, Eigen::Vector3d(1.0, 2.0, 3.0));
}

}  // namespace
}  // namespace oca::systems
