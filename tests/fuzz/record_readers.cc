// SPDX-License-Identifier: BSD-3-Clause
// Records and results of campaigns.
#include "oca/diagrams/record/comparison.h"
#include "oca/diagrams/record/csv_export.h"
#include "oca/diagrams/record/extracted_record.h"
#include "oca/diagrams/record/mcap_reader.h"
#include "oca/diagrams/record/run_metadata.h"
#include "oca/diagrams/record/series.h"
#include "oca/diagrams/sweep/result_file.h"
#include "oca/diagrams/sweep/summary.h"
#include "oca/diagrams/sweep/variation.h"
#include "tests/fuzz/foreign_bytes.h"

namespace oca::test {
namespace {

/// All that commands read of one but its diagram, which another reader does.
bool ReadRecord(std::string_view bytes) {
  return Accepts([&] {
    const auto record = record::McapFile::Parse(std::string(bytes), "fuzz.mcap");
    Accepts([&] { record::ReadSeries(record, "*"); });
    Accepts([&] { record::Compare(record, record); });
    Accepts([&] { record::ExportedFiles(record, "."); });
    record::WarningsOf(record);
    const record::ExtractedRecord extracted(record);
  });
}

bool ReadResults(std::string_view bytes) {
  return Accepts([&] {
    const sweep::Results results = sweep::ReadResults(FileOf("results.jsonl", bytes));
    for (const sweep::SampleRow& row : results.rows) {
      if (row.combination < 0 || row.combination >= std::ssize(results.campaign.Combinations())) {
        return;
      }
    }
    sweep::Summarize(results);
  });
}

bool ReadVariation(std::string_view bytes) {
  return Accepts([&] {
    const auto variation = sweep::Variation::Parse(std::string(bytes));
    if (!variation.listed()) variation.Draw(1);
  });
}

}  // namespace

std::vector<Reader> RecordReaders() {
  using enum Reader::Kind;
  return {{"record", kBinary, ReadRecord},
          {"results", kText, ReadResults},
          {"variation", kText, ReadVariation}};
}

}  // namespace oca::test
