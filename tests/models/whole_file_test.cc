// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/whole_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <iterator>
#include <string>
#include <vector>

#include "oca/models/error.h"
#include "tests/temporary_folder.h"

namespace oca::models {
namespace whole_file_test {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;

class WholeFileTest : public testing::Test {
 protected:
  static std::string Read(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }
  test::TemporaryFolder folder_;
};

TEST_F(WholeFileTest, WhatWasThereStaysUntilTheNewOneIsWhole) {
  const fs::path file = folder_.Write("a.txt", "old");
  {
    WholeFile whole(file);
    whole.stream() << "new";
    whole.stream().flush();
    EXPECT_EQ(Read(file), "old");
    EXPECT_EQ(Read(whole.part()), "new");
    whole.Commit();
    EXPECT_EQ(Read(file), "new");
  }
  EXPECT_EQ(Read(file), "new");
  EXPECT_THAT(Names(), ElementsAre("a.txt"));
}

TEST_F(WholeFileTest, WithoutTheEndNothingChanges) {
  const fs::path file = folder_.Write("a.txt", "old");
  {
    WholeFile whole(file);
    whole.stream() << "half";
  }
  EXPECT_EQ(Read(file), "old");
  EXPECT_THAT(Names(), ElementsAre("a.txt"));
}

TEST_F(WholeFileTest, KeepsThePermissionsOfWhatItReplacesAndElseTheMaskCounts) {
  const fs::path file = folder_.Write("a.txt", "old");
  fs::permissions(file, fs::perms{0640});
  const mode_t before = ::umask(027);
  WriteWhole(file, "new");
  WriteWhole(folder_.path() / "b.txt", "new");
  ::umask(before);
  EXPECT_EQ(fs::status(file).permissions(), fs::perms{0640});
  EXPECT_EQ(fs::status(folder_.path() / "b.txt").permissions(), fs::perms{0640});  // 0666 & ~027
  WriteWhole(folder_.path() / "c.txt", "new");
  EXPECT_EQ(fs::status(folder_.path() / "c.txt").permissions(),
            fs::perms{static_cast<unsigned>(0666 & ~before)});
}

TEST_F(WholeFileTest, FollowsALink) {
  const fs::path file = folder_.Write("deep/a.txt", "old");
  fs::create_symlink("deep/a.txt", folder_.path() / "link");
  WriteWhole(folder_.path() / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder_.path() / "link"));
  EXPECT_EQ(Read(file), "new");
}

TEST_F(WholeFileTest, ADeviceStaysOne) {
  WriteWhole("/dev/null", "anything");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(WholeFileTest, RefusesWithTheReason) {
  EXPECT_THAT([&] { WriteWhole(folder_.path() / "none" / "a.txt", ""); },
              ThrowsMessage<ModelError>(
                  HasSubstr("none/a.txt: cannot be written; got No such file or directory")));
  EXPECT_THAT([&] { WriteWhole(folder_.path(), ""); },
              ThrowsMessage<ModelError>(HasSubstr("got Is a directory")));
  EXPECT_THAT([] { WriteWhole("/dev/full", std::string(100'000, 'x')); },
              ThrowsMessage<ModelError>(StartsWith("/dev/full: cannot be written; got ")));
}

TEST_F(WholeFileTest, WhoeverEndsTheProgramRemovesWhatIsHalf) {
  WholeFile whole(folder_.Write("a.txt", "old"));
  whole.stream() << "half";
  EXPECT_EQ(Names().size(), 2u);
  RemoveUnfinished();
  EXPECT_THAT(Names(), ElementsAre("a.txt"));
  EXPECT_EQ(Read(folder_.path() / "a.txt"), "old");
}

TEST_F(WholeFileTest, AFileOfOurOwnGoesUnlessItHasAnotherName) {
  fs::path gone;
  {
    const UnfinishedFile file(folder_.path());
    gone = file.path();
    EXPECT_TRUE(fs::exists(gone));
  }
  EXPECT_FALSE(fs::exists(gone));
  {
    UnfinishedFile file(folder_.path());
    fs::rename(file.path(), folder_.path() / "kept");
    file.Forget();
  }
  EXPECT_THAT(Names(), ElementsAre("kept"));
  EXPECT_THAT([&] { UnfinishedFile(folder_.path() / "none"); },
              ThrowsMessage<ModelError>(HasSubstr("none: a file in it; got No such file")));
}

}  // namespace whole_file_test
}  // namespace oca::models
