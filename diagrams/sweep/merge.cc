// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/merge.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <tuple>
#include <utility>

#include "oca/framework/dataflow/error.h"

namespace oca::sweep {
namespace {

namespace fs = std::filesystem;

class Merger {
 public:
  explicit Merger(const fs::path& folder) : folder_(folder) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) Take(entry.path());
    if (error) {
      throw ConfigError(fmt::format("{}: {}; expected a folder with the results of a sweep",
                                    folder.string(), error.message()));
    }
  }

  Results Merge() {
    if (files_.empty() && parts_.empty() && whole_.empty()) {
      throw ConfigError(
          fmt::format("{}: got no results; expected shard-I-of-N.jsonl or "
                      "results.jsonl",
                      folder_.string()));
    }
    CheckShards();
    if (problems_.empty()) ReadShards();
    if (problems_.empty()) CheckRuns();
    if (!problems_.empty()) throw ConfigError(fmt::format("{}", fmt::join(problems_, "\n")));
    return std::move(merged_);
  }

 private:
  template <class... Values>
  void Problem(fmt::format_string<Values...> format, Values&&... values) {
    problems_.push_back(folder_.string() +
                        ": error: " + fmt::format(format, std::forward<Values>(values)...));
  }

  void Take(const fs::path& file) {
    static const std::regex kShard("shard-([0-9]{1,9})-of-([0-9]{1,9})\\.jsonl(\\.part)?");
    const std::string name = file.filename().string();
    std::smatch match;
    if (std::regex_match(name, match, kShard)) {
      const std::pair key{std::stoi(match[2]), std::stoi(match[1])};
      (match[3].matched ? parts_ : files_)[key] = file;
    } else if (name == "results.jsonl") {
      whole_ = file;
    }
  }

  void CheckShards() {
    if (files_.empty() && parts_.empty()) return;
    std::set<int> counts;
    for (const auto* const map : {&files_, &parts_}) {
      for (const auto& [key, file] : *map) counts.insert(key.first);
    }
    if (counts.size() > 1) {
      Problem("got shards of divisions by {}; expected one division", fmt::join(counts, ", "));
      return;
    }
    const int count = *counts.begin();
    for (int index = 0; index < count; ++index) {
      const std::pair key{count, index};
      if (files_.contains(key)) continue;
      if (parts_.contains(key)) {
        Problem("shard {} of {} is not finished; the same command goes on with it", index, count);
      } else {
        Problem("shard {} of {} is missing", index, count);
      }
    }
  }

  void ReadShards() {
    for (const auto& [key, file] : files_) {
      Results shard = ReadResults(file);
      if (&file == &files_.begin()->second) merged_.campaign = shard.campaign;
      const std::string difference = merged_.campaign.DifferenceTo(shard.campaign);
      if (!difference.empty()) {
        Problem("{} is of another campaign than {}: {}", file.filename().string(),
                files_.begin()->second.filename().string(), difference);
      }
      for (const SampleRow& row : shard.rows) {
        if (row.sample % key.first == key.second) continue;
        Problem("{} holds sample {}, which is not its own", file.filename().string(), row.sample);
      }
      Append(std::move(shard));
    }
    if (files_.empty()) ReadAll();
    const auto in_order = [](const auto& a, const auto& b) { return a.key() < b.key(); };
    std::sort(merged_.rows.begin(), merged_.rows.end(), in_order);
    std::sort(merged_.timings.begin(), merged_.timings.end(), in_order);
  }

  void ReadAll() {
    std::size_t end = 0;
    merged_ = ReadResults(whole_, &end);
    if (end == 0) Problem("{}: got no line of a campaign", whole_.filename().string());
  }

  void Append(Results&& shard) {
    std::move(shard.rows.begin(), shard.rows.end(), std::back_inserter(merged_.rows));
    std::move(shard.timings.begin(), shard.timings.end(), std::back_inserter(merged_.timings));
  }

  void CheckRuns() {
    const Campaign& campaign = merged_.campaign;
    const auto combinations = static_cast<int>(campaign.Combinations().size());
    std::vector<std::string> missing, foreign;
    std::set<std::tuple<std::int64_t, int>> there;
    for (const SampleRow& row : merged_.rows) {
      const bool known = row.sample >= 0 && row.sample < campaign.samples && row.combination >= 0 &&
                         row.combination < combinations;
      if (!known) foreign.push_back(NameOf(row.sample, row.combination));
      if (known) there.insert(row.key());
    }
    const std::int64_t count =
        campaign.samples * combinations - static_cast<std::int64_t>(there.size());
    for (std::int64_t sample = 0; std::ssize(missing) < std::min(count, kTold); ++sample) {
      for (int combination = 0; combination < combinations; ++combination) {
        if (there.contains({sample, combination})) continue;
        missing.push_back(NameOf(sample, combination));
      }
    }
    Tell("are missing", missing, count);
    Tell("are none of this campaign", foreign, std::ssize(foreign));
  }

  static std::string NameOf(std::int64_t sample, int combination) {
    return fmt::format("{}.{}", sample, combination);
  }

  /// The first of `count` runs.
  void Tell(const char* what, std::vector<std::string> runs, std::int64_t count) {
    if (runs.empty()) return;
    runs.resize(static_cast<std::size_t>(std::min(std::ssize(runs), kTold)));
    Problem("{} runs (sample.combination) {}: {}{}", count, what, fmt::join(runs, ", "),
            count > kTold ? ", ..." : "");
  }

  static constexpr std::ptrdiff_t kTold = 10;

  fs::path folder_;
  std::map<std::pair<int, int>, fs::path> files_, parts_;  ///< by count and index
  fs::path whole_;
  std::vector<std::string> problems_;
  Results merged_;
};

}  // namespace

Results MergeShards(const fs::path& folder) { return Merger(folder).Merge(); }

}  // namespace oca::sweep
