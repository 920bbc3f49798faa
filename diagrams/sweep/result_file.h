// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <mutex>
#include <vector>

#include "oca/diagrams/sweep/campaign.h"
#include "oca/diagrams/sweep/sample_row.h"

namespace oca::sweep {

/// A campaign with what is known of its samples, in the order of sample and combination.
struct Results {
  Campaign campaign;
  std::vector<SampleRow> rows;
  std::vector<SampleTiming> timings;
};

/// Reads a results file and, if it is there, the timings file beside it. What follows the last
/// good line was cut off in the middle of a write and is left out; `end` tells where it begins.
/// A row that is there twice counts once.
/// throws ConfigError if it cannot be read, or a line before the last one is none or gives a sample
///        another result than the line before that has it.
Results ReadResults(const std::filesystem::path& file, std::size_t* end = nullptr);

/// Writes the campaign and its rows, a line each, under another name first.
/// throws ModelError if it cannot be written.
void WriteResults(const std::filesystem::path& file, const Campaign& campaign,
                  const std::vector<SampleRow>& rows);

/// The results of one shard while it runs: DIR/STEM.jsonl.part, in the order in which samples end,
/// which Finish() turns into DIR/STEM.jsonl, in order. Times go to DIR/STEM.timings.jsonl, so that
/// two runs of a campaign give the same results byte by byte. What a run left that was ended, by
/// whatever, is taken over.
class ResultFile {
 public:
  /// throws ConfigError if the folder holds another campaign's results, another process writes
  /// them, or they cannot be written.
  ResultFile(const std::filesystem::path& folder, const Campaign& campaign, const Shard& shard);
  ~ResultFile();
  ResultFile(const ResultFile&) = delete;
  ResultFile& operator=(const ResultFile&) = delete;

  /// Whether all samples were there already.
  bool complete() const { return part_ < 0; }
  const Results& results() const { return results_; }
  /// From any thread. throws ConfigError if the disk is full.
  void Add(const SampleRow& row, const SampleTiming& timing);
  /// All samples are there.
  void Finish();
  /// Of the file that rows are appended to, for one that cannot wait.
  int descriptor() const { return part_; }

 private:
  void TakeOver(const std::filesystem::path& file, const Campaign& campaign, const Shard& shard);
  void OpenPart(const Campaign& campaign, const Shard& shard);

  std::filesystem::path final_file_, part_file_, timings_file_;
  std::mutex mutex_;
  Results results_;
  int part_{-1};
  int timings_{-1};
};

}  // namespace oca::sweep
