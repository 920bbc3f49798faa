// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/csv_table.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include "oca/models/csv_names.h"
#include "oca/models/error.h"
#include "tests/temporary_folder.h"

namespace oca::models {
namespace csv_table_test {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

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
    } catch (const ModelError& error) {
      return error.what();
    }
    return "accepted";
  }
  std::string Refusal(std::string_view text) const { return RefusalOf(Write(text)); }
  /// The numbers of columns x and y, or of the first two, of all rows.
  std::vector<double> Numbers(std::string_view text) const {
    CsvTable table(Write(text));
    std::vector<std::size_t> columns = table.Columns({"x", "y"});
    if (columns.empty()) columns = {0, 1};
    std::vector<double> numbers;
    while (table.NextRow()) {
      for (const std::size_t column : columns) numbers.push_back(table.Number(column));
    }
    return numbers;
  }
  /// What looking for the columns x and y refuses.
  std::string NameRefusal(std::string_view text) const {
    try {
      Numbers(text);
    } catch (const ModelError& error) {
      return error.what();
    }
    return "accepted";
  }

  const test::TemporaryFolder folder_;
  const std::string file_ = (folder_.path() / "table.csv").string();
};

TEST_F(CsvTableTest, SkipsBlankLinesAndCommentsAndCountsThem) {
  CsvTable table(Write("# caf\xc3\xa9, 1\n\n \t\r\na, b ,,\r\n  # c\n+1,-2.5e1,,\r\r3,4,5,6"));
  EXPECT_THAT(table.names(), ElementsAre("a", "b", "", ""));
  EXPECT_THAT(table.where(), EndsWith(".csv:4"));
  ASSERT_TRUE(table.NextRow());
  EXPECT_THAT(table.where(), EndsWith(".csv:6"));
  EXPECT_EQ(table.Number(0), 1.0);
  EXPECT_EQ(table.Number(1), -25.0);
  ASSERT_TRUE(table.NextRow());
  EXPECT_THAT(table.where(), EndsWith(".csv:8"));
  EXPECT_FALSE(table.NextRow());
  EXPECT_FALSE(table.NextRow());
}

TEST_F(CsvTableTest, HasNoRowsInAnEmptyFile) {
  CsvTable table(Write(""));
  EXPECT_FALSE(table.NextRow());
}

TEST_F(CsvTableTest, SkipsTheMarkOfUtf8AndRefusesOtherEncodingsByName) {
  EXPECT_THAT(Numbers("\xEF\xBB\xBF"
                      "2,0\n"),
              ElementsAre(2.0, 0.0));
  EXPECT_THAT(Numbers("\xEF\xBB\xBFy,x\n2,0\n"), ElementsAre(0.0, 2.0));
  EXPECT_THAT(Numbers("\xEF\xBB\xBF# mark\n2,0\n"), ElementsAre(2.0, 0.0));
  EXPECT_THAT(Refusal(std::string_view("\xFF\xFE"
                                       "1\0,\0",
                                       6)),
              HasSubstr(":1: encoding; got UTF-16"));
  EXPECT_THAT(Refusal(std::string_view("\xFE\xFF\0"
                                       "1",
                                       4)),
              HasSubstr("got UTF-16"));
  EXPECT_THAT(Refusal(std::string_view("\xFF\xFE\0\0"
                                       "1\0\0\0",
                                       8)),
              HasSubstr("got UTF-32"));
}

TEST_F(CsvTableTest, TakesTheSeparatorOfTheFirstRow) {
  for (const char* text : {"1,2\n3,4\n", "1;2\n3;4\n", "1\t2\n3\t4\n", " 1  2\n3 \t 4 \n",
                           "1,\t2\n3\t,4\n", "1\t2 \r\n 3\t4"}) {
    EXPECT_THAT(Numbers(text), ElementsAre(1.0, 2.0, 3.0, 4.0)) << text;
  }
  EXPECT_THAT(Refusal("1\t\t2\n"), HasSubstr(":1: column 2: not a number; got ''"));
  EXPECT_THAT(Refusal("1,2\n3;4\n"), HasSubstr(":2: wrong length; got 1 values; expected 2"));
}

TEST_F(CsvTableTest, RefusesDecimalCommas) {
  for (const char* text : {"2,5;0,1\n", "2,5\t0,1\n", "x;y\n2,5;0,1\n"}) {
    EXPECT_THAT(Refusal(text), HasSubstr("got '2,5'; expected a finite number, with a decimal "
                                         "point"))
        << text;
  }
  EXPECT_THAT(Refusal("2,5 0,1\n"), HasSubstr("column 2: not a number; got '5 0'"));
  EXPECT_THAT(Refusal("2\n2,5\n"), HasSubstr("got '2,5'"));
}

TEST_F(CsvTableTest, FindsColumnsByTheirNamesInAnyOrder) {
  EXPECT_THAT(Numbers("id,y,x\n7,2,1\n"), ElementsAre(1.0, 2.0));
  EXPECT_THAT(Numbers("Y;X\n2;1\n"), ElementsAre(1.0, 2.0));
  EXPECT_THAT(Numbers("//X Y\n1 2\n"), ElementsAre(1.0, 2.0));
  EXPECT_THAT(Numbers("\"y\",\"x\",\"3\"\n2,1,0\n"), ElementsAre(1.0, 2.0));
  EXPECT_THAT(Numbers("\"2\",\"1\"\n"), ElementsAre(2.0, 1.0)) << "numbers in quotes, no names";
  EXPECT_THAT(NameRefusal("x,z\n1,2\n"), HasSubstr(":1: names of columns: no 'y'; got x, z"));
  EXPECT_THAT(NameRefusal("x,y,x\n1,2,3\n"), HasSubstr("more than one 'x'"));
  EXPECT_THAT(NameRefusal("X,Y,Y\n1,2,3\n"), HasSubstr("more than one 'y'"));
}

TEST_F(CsvTableTest, LetsACommentBeforeTheFirstRowNameTheColumns) {
  EXPECT_THAT(Numbers("# y,x\n2,1\n"), ElementsAre(1.0, 2.0));
  EXPECT_THAT(Numbers("# made by hand\n#id y x\n7 2 1\n"), ElementsAre(1.0, 2.0));
  EXPECT_THAT(Numbers("# two numbers\n2 1\n"), ElementsAre(2.0, 1.0));
}

TEST_F(CsvTableTest, ACommentMayNameColumnsInItsOwnWayButNotInPart) {
  EXPECT_THAT(Numbers("# y x\n0,2\n"), ElementsAre(2.0, 0.0));
  EXPECT_THAT(Numbers("# y;x\n0,2\n"), ElementsAre(2.0, 0.0));
  EXPECT_THAT(Numbers("# columns: y[m] x[m]\n0,2\n"), ElementsAre(2.0, 0.0));
  EXPECT_THAT([&] { Numbers("# y x intensity\n0,2\n"); },
              testing::ThrowsMessage<ModelError>(HasSubstr("comment that names columns")));
  EXPECT_THAT(Numbers("# a few points\n0,2\n"), ElementsAre(0.0, 2.0));
}

TEST_F(CsvTableTest, ARowBehindSlashesIsNamesOrAComment) {
  EXPECT_THAT(Numbers("// y x\n0 2\n"), ElementsAre(2.0, 0.0));
  EXPECT_THAT(Numbers("//y x\n0 2\n"), ElementsAre(2.0, 0.0));
  EXPECT_THAT(Numbers("//7 7\n0 2\n"), ElementsAre(0.0, 2.0));
}

TEST_F(CsvTableTest, TakesNoDamagedNumberForAName) {
  EXPECT_THAT(Refusal("2,0,x\n"), HasSubstr(":1: column 3: not a number; got 'x'"));
  EXPECT_THAT(NameRefusal("2,0o\n1,2\n"), HasSubstr(":1: column 2: not a number; got '0o'"));
  EXPECT_THAT(NameRefusal("2a,0o\n1,2\n"), HasSubstr("names of columns: no 'x'"));
}

TEST_F(CsvTableTest, ReadsQuotesAsRfc4180HasThem) {
  CsvTable table(Write("\"a,b\", \"say \"\"c\"\"\" ,\"two\r\nlines\"\n1,\"2\",3\n"));
  EXPECT_THAT(table.names(), ElementsAre("a,b", "say \"c\"", "two\r\nlines"));
  ASSERT_TRUE(table.NextRow());
  EXPECT_THAT(table.where(), EndsWith(":3"));
  EXPECT_EQ(table.Number(1), 2.0);
  EXPECT_THAT(Refusal("1,\"2\n3,4\n"), HasSubstr(":1: quote; got none that closes"));
  EXPECT_THAT(Refusal("1,\"2\"3\n"), HasSubstr("text behind a closing quote; got '3'"));
  EXPECT_THAT(Refusal("1,2\"3\"\n"), HasSubstr("quote inside a cell; got '2\"3\"'"));
}

TEST_F(CsvTableTest, RefusesRowsOfAnotherLength) {
  EXPECT_THAT(Refusal("1,2\n3\n"), HasSubstr(":2: wrong length; got 1 values; expected 2"));
  EXPECT_THAT(Refusal("x,y\n1,2,3\n"), HasSubstr(":2: wrong length; got 3 values; expected 2"));
  EXPECT_THAT(Refusal("1,2\n1,2,\n"), HasSubstr("got 3 values"));
}

TEST_F(CsvTableTest, RefusesWhatIsNoFiniteNumber) {
  for (const char* cell : {"nan", "inf", "1e999", "0x1", "1 2", "+-1", "++1", "+", "1m", ""}) {
    EXPECT_THAT(Refusal(std::string("0,") + cell),
                HasSubstr(std::string(":1: column 2: not a number; got '") + cell + "'"));
  }
  EXPECT_THAT(Refusal("a,b\n1,x\n"), HasSubstr(":2: column 2 ('b'): not a number; got 'x'"));
}

TEST_F(CsvTableTest, RefusesControlCharactersWithoutRepeatingThem) {
  for (const char c : {'\0', '\x01', '\x1b', '\x1f', '\x7f'}) {
    const std::string refusal = Refusal("1\n2" + std::string(1, c) + "\n");
    EXPECT_THAT(refusal, HasSubstr(":2: control character; got byte 0x")) << int{c};
    EXPECT_EQ(refusal.find(c), std::string::npos) << int{c};
  }
  EXPECT_THAT(Refusal("# \x1b[2J\n1\n"), HasSubstr(":1: control character"));
}

TEST_F(CsvTableTest, ShowsBytesThatAreNotAsciiAndLongCellsOnlyInPart) {
  EXPECT_THAT(Refusal("1\n\x9b\xc2\x85z"), HasSubstr("got '???z'"));
  EXPECT_THAT(Refusal("1\n" + std::string(41, 'x')),
              HasSubstr("got '" + std::string(40, 'x') + "'"));
}

TEST_F(CsvTableTest, RefusesWhatIsNoFileWithoutOpeningIt) {
  ASSERT_EQ(mkfifo(file_.c_str(), 0600), 0);
  EXPECT_THAT(RefusalOf(file_), EndsWith(".csv: not a regular file; got a folder, pipe or device; "
                                         "expected a file"));
  EXPECT_THAT(RefusalOf("/dev/zero"), HasSubstr("not a regular file"));
  EXPECT_THAT(RefusalOf(::testing::TempDir()), HasSubstr("not a regular file"));
  EXPECT_EQ(RefusalOf("no/such/file.csv"),
            "no/such/file.csv: cannot be read; got no such file; expected a file");
}

TEST_F(CsvTableTest, RefusesByItsSizeWhatWouldFillTheMemory) {
  Write("");
  std::filesystem::resize_file(file_, std::uintmax_t{1} << 40);  // a hole, which takes no room
  EXPECT_THAT(RefusalOf(file_),
              EndsWith(".csv: too large; got 1099511627776 bytes; expected at most 100000000"));
}

TEST_F(CsvTableTest, RefusesARowOfMoreThanAMillionValues) {
  std::string row = "1";
  for (int i = 1; i < 1'000'000; ++i) row += ",1";
  EXPECT_EQ(CsvTable(Write(row)).width(), 1'000'000u);
  EXPECT_THAT(RefusalOf(Write(row + ",1")),
              EndsWith(".csv:1: row; got more than 1000000 values; expected no more"));
}

TEST_F(CsvTableTest, NamesEachColumnOnce) {
  EXPECT_THAT(UniqueColumns({"a", "time", "a", "a_2"}), ElementsAre("a", "time_2", "a_3", "a_2"));
  EXPECT_THAT(UniqueColumns({}), IsEmpty());
}

/// What is written is read back bit for bit: random names, of all that a quote must protect, and
/// random doubles.
TEST_F(CsvTableTest, ReadsBackWhatIsWritten) {
  std::mt19937_64 random(11);
  const std::string letters = "ab,;\"'\t\r\n #/0123.-+e\xc3\xa9";
  for (int run = 0; run < 2000; ++run) {
    std::vector<std::string> names(1 + random() % 5);
    for (std::string& name : names) {
      for (auto length = random() % 6; length > 0; --length) {
        name += letters[random() % letters.size()];
      }
    }
    names = UniqueColumns(std::move(names));
    std::vector<double> numbers;
    std::string text = "time";
    for (const std::string& name : names) {
      text += ',';
      AppendCsvName(text, name);
    }
    text += '\n';
    for (int row = 0; row < 2; ++row) {
      for (std::size_t i = 0; i <= names.size(); ++i) {
        double number = 0.0;
        do {
          const std::uint64_t bits = random();
          std::memcpy(&number, &bits, sizeof number);
        } while (!std::isfinite(number));
        numbers.push_back(number);
        text += fmt::format("{}{}", i == 0 ? "" : ",", number);
      }
      text += '\n';
    }
    CsvTable table(Write(text));
    ASSERT_EQ(std::vector<std::string>(table.names().begin() + 1, table.names().end()), names)
        << text;
    std::size_t at = 0;
    while (table.NextRow()) {
      for (std::size_t i = 0; i <= names.size(); ++i) {
        const double number = table.Number(i);
        ASSERT_EQ(std::memcmp(&number, &numbers[at++], sizeof number), 0) << text;
      }
    }
    ASSERT_EQ(at, numbers.size());
  }
}

}  // namespace csv_table_test
}  // namespace oca::models
