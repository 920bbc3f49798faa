// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/result_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "oca/framework/dataflow/error.h"
#include "oca/models/file_bytes.h"
#include "oca/models/whole_file.h"
#include "oca/systems/signals/config_errors.h"

namespace oca::sweep {
namespace {

namespace fs = std::filesystem;

const char* const kTimings = ".timings.jsonl";
constexpr std::uintmax_t kMostBytes = std::uintmax_t{4} << 30;

ConfigError CannotWrite(const fs::path& file) {
  return ConfigError(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
}

std::string ReadText(const fs::path& file) {
  return systems::WithConfigErrors([&] { return models::ReadUnnoted(file, kMostBytes); });
}

/// One write, so that another thread's line cannot come between.
void WriteAll(int descriptor, std::string_view text, const fs::path& file) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw CannotWrite(file);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

template <class Row>
void SortRows(std::vector<Row>& rows) {
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.key() < b.key(); });
}

/// Calls take(line) for each whole line; returns where the first line begins that is cut off or, as
/// the last one, not what it should be.
template <class Take>
std::size_t ForEachLine(const std::string& text, const fs::path& file, const Take& take) {
  std::size_t begin = 0;
  for (int number = 1;; ++number) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) return begin;
    try {
      take(number, text.substr(begin, end - begin));
    } catch (const ConfigError& error) {
      if (end + 1 == text.size()) return begin;
      throw ConfigError(fmt::format("{}:{}: {}", file.string(), number, error.what()));
    }
    begin = end + 1;
  }
}

/// DIR/STEM.jsonl or DIR/STEM.jsonl.part -> DIR/STEM.timings.jsonl
fs::path TimingsOf(fs::path file) {
  if (file.extension() == ".part") file.replace_extension();
  return file.replace_extension().string() + kTimings;
}

std::vector<SampleTiming> ReadTimings(const fs::path& file) {
  std::vector<SampleTiming> timings;
  if (std::error_code error; !fs::exists(file, error)) return timings;
  const std::string text = ReadText(file);
  std::set<std::tuple<std::int64_t, int>> known;
  ForEachLine(text, file, [&](int, const std::string& line) {
    try {
      SampleTiming timing = SampleTiming::FromLine(line);
      if (known.insert(timing.key()).second) timings.push_back(std::move(timing));
    } catch (const ConfigError&) {  // no result depends on it
    }
  });
  return timings;
}

int OpenToAppend(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0) throw CannotWrite(file);
  return descriptor;
}

}  // namespace

Results ReadResults(const fs::path& file, std::size_t* end) {
  const std::string text = ReadText(file);
  Results results;
  std::map<std::tuple<std::int64_t, int>, std::string> known;
  const std::size_t stop = ForEachLine(text, file, [&](int number, const std::string& line) {
    if (number == 1) {
      results.campaign = Campaign::FromHeader(line);
      return;
    }
    SampleRow row = SampleRow::FromLine(line);
    const auto [first, fresh] = known.emplace(row.key(), line);
    if (fresh) {
      results.rows.push_back(std::move(row));
    } else if (first->second != line) {
      throw ConfigError(fmt::format("sample {}; got two results of it; expected one", row.sample));
    }
  });
  if (end != nullptr) *end = stop;
  results.timings = ReadTimings(TimingsOf(file));
  const std::int64_t combinations = std::ssize(results.campaign.Combinations());
  std::erase_if(results.timings, [&](const SampleTiming& timing) {  // as for those that are none
    return timing.combination < 0 || timing.combination >= combinations;
  });
  SortRows(results.rows);
  SortRows(results.timings);
  return results;
}

void WriteResults(const fs::path& file, const Campaign& campaign,
                  const std::vector<SampleRow>& rows) {
  models::WholeFile whole(file);
  whole.stream() << campaign.Header() << '\n';
  for (const SampleRow& row : rows) whole.stream() << row.Line() << '\n';
  whole.Commit();
}

ResultFile::ResultFile(const fs::path& folder, const Campaign& campaign, const Shard& shard)
    : final_file_(folder / (shard.Stem() + ".jsonl")),
      part_file_(final_file_.string() + ".part"),
      timings_file_(folder / (shard.Stem() + kTimings)) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw ConfigError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
  }
  if (fs::exists(final_file_, error)) {
    TakeOver(final_file_, campaign, shard);
    fs::remove(part_file_, error);
    return;
  }
  OpenPart(campaign, shard);
  timings_ = OpenToAppend(timings_file_);
}

ResultFile::~ResultFile() {
  if (part_ >= 0) ::close(part_);
  if (timings_ >= 0) ::close(timings_);
}

void ResultFile::OpenPart(const Campaign& campaign, const Shard& shard) {
  part_ = OpenToAppend(part_file_);
  if (::flock(part_, LOCK_EX | LOCK_NB) != 0) {
    ::close(part_);
    throw ConfigError(fmt::format("{}: another process writes it", part_file_.string()));
  }
  std::size_t end = 0;
  try {
    std::error_code error;
    if (fs::file_size(part_file_, error) > 0) {
      const Results left = ReadResults(part_file_, &end);
      if (end > 0) TakeOver(part_file_, campaign, shard);
    }
    if (::ftruncate(part_, static_cast<off_t>(end)) != 0) throw CannotWrite(part_file_);
    if (end == 0) WriteAll(part_, campaign.Header() + '\n', part_file_);
  } catch (const std::exception&) {
    ::close(part_);
    throw;
  }
  results_.campaign = campaign;
}

void ResultFile::TakeOver(const fs::path& file, const Campaign& campaign, const Shard& shard) {
  results_ = ReadResults(file);
  const std::string difference = campaign.DifferenceTo(results_.campaign);
  if (!difference.empty()) {
    throw ConfigError(
        fmt::format("{}: holds another campaign ({}); expected another folder, or that it is "
                    "removed",
                    file.string(), difference));
  }
  const std::int64_t combinations = std::ssize(campaign.Combinations());
  for (const SampleRow& row : results_.rows) {
    const bool known = row.sample >= 0 && row.sample < campaign.samples && row.combination >= 0 &&
                       row.combination < combinations;
    if (!known) {
      throw ConfigError(fmt::format("{}: got the run {}.{}; expected those of the campaign",
                                    file.string(), row.sample, row.combination));
    }
    if (row.sample % shard.count == shard.index) continue;
    throw ConfigError(fmt::format("{}: got sample {}; expected those of shard {} of {}",
                                  file.string(), row.sample, shard.index, shard.count));
  }
}

void ResultFile::Add(const SampleRow& row, const SampleTiming& timing) {
  const std::string line = row.Line() + '\n';
  const std::string times = timing.Line() + '\n';
  const std::lock_guard lock(mutex_);
  WriteAll(timings_, times, timings_file_);
  WriteAll(part_, line, part_file_);
  results_.rows.push_back(row);
  results_.timings.push_back(timing);
}

void ResultFile::Finish() {
  SortRows(results_.rows);
  SortRows(results_.timings);
  if (complete()) return;
  WriteResults(final_file_, results_.campaign, results_.rows);
  std::error_code ignored;
  fs::remove(part_file_, ignored);
  ::close(part_);
  part_ = -1;
}

}  // namespace oca::sweep
