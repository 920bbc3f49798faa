// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/file_cache.h"

#include <gmock/gmock.h>

#include <atomic>
#include <new>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "oca/models/error.h"
#include "oca/models/opened_files.h"

namespace oca::models {
namespace file_cache_test {

using testing::ElementsAre;

/// What counts how often it reads.
class FileCacheTest : public testing::Test {
 protected:
  int Read(const std::string& file, const std::string& form) {
    return *ReadOnce<int>(file, form, [&] {
      NoteOpened(file);
      return ++reads_;
    });
  }
  int Make(const std::string& file, const std::string& form) {
    return *MakeOnce<int>(file, form, [&] { return ++reads_; });
  }
  FileCache cache_;
  int reads_{0};
};

TEST_F(FileCacheTest, ReadsOnceWhileItIsInUseAndEachTimeWithoutOne) {
  EXPECT_EQ(Read("/a", ""), 1);
  EXPECT_EQ(Read("/a", ""), 2);
  {
    const FileCache::Use use(cache_);
    EXPECT_EQ(Read("/a", ""), 3);
    EXPECT_EQ(Read("/a", ""), 3);
  }
  EXPECT_EQ(Read("/a", ""), 4);
  const FileCache::Use again(cache_);
  EXPECT_EQ(Read("/a", ""), 3);
}

TEST_F(FileCacheTest, TellsFilesFormsTypesAndKindsApart) {
  const FileCache::Use use(cache_);
  EXPECT_EQ(Read("/a", "x"), 1);
  EXPECT_EQ(Read("/b", "x"), 2);
  EXPECT_EQ(Read("/a", "y"), 3);
  EXPECT_EQ(Make("/a", "x"), 4);
  EXPECT_EQ(*ReadOnce<double>("/a", "x", [] { return 0.5; }), 0.5);
  EXPECT_EQ(Read("/a", "x"), 1);
}

TEST_F(FileCacheTest, TheYoungerOfTwoCounts) {
  FileCache other;
  const FileCache::Use use(cache_);
  EXPECT_EQ(Read("/a", ""), 1);
  {
    const FileCache::Use inner(other);
    EXPECT_EQ(Read("/a", ""), 2);
  }
  EXPECT_EQ(Read("/a", ""), 1);
}

TEST_F(FileCacheTest, OpenedFilesHearsOfWhatIsFoundToo) {
  const FileCache::Use use(cache_);
  for (int time = 0; time < 2; ++time) {
    const OpenedFiles opened;
    // One that is made of another names both, and so does all that finds it.
    MakeOnce<int>("/made", "", [&] { return Read("/b", "") + Read("/a", ""); });
    EXPECT_THAT(opened.files(), ElementsAre("/b", "/a"));
  }
  EXPECT_EQ(reads_, 2);
}

TEST_F(FileCacheTest, KeepsWhatWasReadAndOfWhatWasMadeTheLast) {
  const FileCache::Use use(cache_);
  const int first_read = Read("/a", "0");
  const int first = Make("/a", "0");
  for (std::size_t i = 1; i < FileCache::kRecent; ++i) Make("/a", std::to_string(i));
  EXPECT_EQ(Make("/a", "0"), first) << "used again: no longer the oldest";
  Make("/a", "one more");
  EXPECT_EQ(Make("/a", "0"), first);
  const int before = reads_;
  EXPECT_EQ(Make("/a", "1"), before + 1) << "the oldest is gone";
  for (std::size_t i = 1; i < 3 * FileCache::kRecent; ++i) Read("/a", std::to_string(i));
  EXPECT_EQ(Read("/a", "0"), first_read);
}

TEST_F(FileCacheTest, DoesNotKeepWhatFails) {
  const FileCache::Use use(cache_);
  const auto fail = [&]() -> int { throw std::runtime_error(std::to_string(++reads_)); };
  EXPECT_THROW(ReadOnce<int>("/a", "", fail), std::runtime_error);
  EXPECT_THROW(ReadOnce<int>("/a", "", fail), std::runtime_error);
  EXPECT_EQ(Read("/a", ""), 3);
  EXPECT_EQ(Read("/a", ""), 3);
}

TEST_F(FileCacheTest, ThreadsReadOnceToo) {
  std::atomic<int> reads{0};
  std::vector<std::shared_ptr<const int>> found(8);
  {
    std::vector<std::jthread> threads;
    for (std::shared_ptr<const int>& one : found) {
      threads.emplace_back([&] {
        const FileCache::Use use(cache_);
        one = ReadOnce<int>("/a", "", [&] {
          std::this_thread::sleep_for(std::chrono::milliseconds(20));
          return ++reads;
        });
      });
    }
  }
  EXPECT_EQ(reads, 1);
  for (const auto& one : found) EXPECT_EQ(one, found.front());
}

TEST_F(FileCacheTest, NamesTheFileThatTheMemoryDoesNotHold) {
  const auto message = [] {
    try {
      ReadOnce<int>("/big", "", []() -> int { throw std::bad_alloc(); });
    } catch (const ModelError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(message(), testing::StartsWith("/big: too large; got no memory"));
  const FileCache::Use use(cache_);
  EXPECT_THAT(message(), testing::StartsWith("/big: too large; got no memory"));
}

}  // namespace file_cache_test
}  // namespace oca::models
