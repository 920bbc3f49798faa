// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/opened_files.h"

#include <gmock/gmock.h>

#include "oca/models/csv_table.h"
#include "oca/models/error.h"
#include "tests/temporary_folder.h"

namespace oca::models {
namespace opened_files_test {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

TEST(OpenedFilesTest, NotesWhatIsReadWhileItLivesOnce) {
  const oca::test::TemporaryFolder folder;
  const fs::path one = folder.Write("one.csv", "1\n"), two = folder.Write("two.csv", "2\n");
  CsvTable before(one);
  OpenedFiles opened;
  CsvTable first(two), again(folder.path() / "." / "two.csv");
  EXPECT_THAT(opened.files(), ElementsAre(two));
  EXPECT_TRUE(opened.Contains(folder.path() / "a" / ".." / "two.csv"));
  EXPECT_FALSE(opened.Contains(one));
}

TEST(OpenedFilesTest, RefusesAnEmptyNameWhetherOrNotAnyoneNotes) {
  const auto refused =
      ThrowsMessage<ModelError>(HasSubstr("got an empty file name; expected a path"));
  EXPECT_THAT([] { NoteOpened(""); }, refused);
  EXPECT_THAT([] { CsvTable table(""); }, refused);
  const OpenedFiles opened;
  EXPECT_THAT([] { NoteOpened(""); }, refused);
  EXPECT_FALSE(opened.Contains(""));
  EXPECT_FALSE(LiesBelow("", "/"));
}

TEST(OpenedFilesTest, TellsItsElderUnlessThatIsToBeSpared) {
  const oca::test::TemporaryFolder folder;
  const fs::path one = folder.Write("one.csv", "1\n"), two = folder.Write("two.csv", "2\n");
  OpenedFiles outer;
  {
    OpenedFiles inner(OpenedFiles::Elder::kNotesNot);
    CsvTable table(one);
    EXPECT_THAT(inner.files(), ElementsAre(one));
  }
  EXPECT_THAT(outer.files(), IsEmpty());
  {
    OpenedFiles inner;
    CsvTable table(two);
    EXPECT_THAT(inner.files(), ElementsAre(two));
  }
  EXPECT_THAT(outer.files(), ElementsAre(two));
}

TEST(OpenedFilesTest, RefusesWhatLiesOutsideOfItsFolders) {
  const oca::test::TemporaryFolder folder, other;
  const fs::path inside = folder.Write("in/a.csv", "1\n");
  const fs::path outside = other.Write("secret.csv", "1\n");
  fs::create_directory_symlink(other.path(), folder.path() / "in" / "way");
  OpenedFiles restricted({folder.path() / "in"});
  OpenedFiles inner;  // which the elder one restricts
  CsvTable table(inside);
  for (const fs::path& name :
       {outside, folder.path() / "in" / ".." / ".." / other.path().filename() / "secret.csv",
        folder.path() / "in" / "way" / ".." / other.path().filename() / "secret.csv"}) {
    EXPECT_THAT([&] { CsvTable refused(name); },
                ThrowsMessage<ModelError>(HasSubstr("outside of the record")))
        << name;
  }
  // A link that is there was made by whoever owns the folder.
  CsvTable linked(folder.path() / "in" / "way" / "secret.csv");
}

TEST(OpenedFilesTest, ComparesNamesOfFoldersWhole) {
  EXPECT_TRUE(LiesBelow("/a/b/c", "/a/b"));
  EXPECT_TRUE(LiesBelow("/a/b/c", "/a/b/"));
  EXPECT_FALSE(LiesBelow("/a/bc/d", "/a/b"));
  EXPECT_FALSE(LiesBelow("/a/b", "/a/b"));
}

}  // namespace opened_files_test
}  // namespace oca::models
