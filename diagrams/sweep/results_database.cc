// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/results_database.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "oca/diagrams/sweep/campaign_tree.h"
#include "oca/diagrams/sweep/summary.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/json_text.h"
#include "oca/models/whole_file.h"

namespace oca::sweep {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

const char* const kTables = R"(
CREATE TABLE campaign(key TEXT PRIMARY KEY, value TEXT);
CREATE TABLE setting(combination INTEGER, path TEXT, value TEXT, PRIMARY KEY(combination, path));
CREATE TABLE sample(sample INTEGER, combination INTEGER, seed INTEGER, outcome TEXT, error TEXT,
  duration REAL, steps INTEGER, clear INTEGER, sampled_clear INTEGER, arrived INTEGER, met INTEGER,
  failure TEXT, command TEXT, PRIMARY KEY(sample, combination)) WITHOUT ROWID;
CREATE TABLE drawn(sample INTEGER, path TEXT, value TEXT, PRIMARY KEY(sample, path)) WITHOUT ROWID;
CREATE TABLE metric(sample INTEGER, combination INTEGER, name TEXT, value,
  PRIMARY KEY(sample, combination, name)) WITHOUT ROWID;
CREATE TABLE timing(sample INTEGER, combination INTEGER, load_seconds REAL, run_seconds REAL,
  step_p50 REAL, step_p99 REAL, step_max REAL, PRIMARY KEY(sample, combination)) WITHOUT ROWID;
)";

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
};

class Database {
 public:
  /// Makes it in `part`; errors name `file`.
  Database(const fs::path& part, const fs::path& file) : file_(file) {
    sqlite3* opened = nullptr;
    const int status = sqlite3_open(part.c_str(), &opened);
    database_.reset(opened);
    Check(status);
    Execute("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; BEGIN;");
  }
  void Execute(const char* text) {
    Check(sqlite3_exec(database_.get(), text, nullptr, nullptr, nullptr));
  }
  void Check(int status) const {
    if (status == SQLITE_OK || status == SQLITE_DONE || status == SQLITE_ROW) return;
    throw ConfigError(fmt::format("{}: cannot be written: {}", file_.string(),
                                  database_ ? sqlite3_errmsg(database_.get()) : "no memory"));
  }
  sqlite3* get() const { return database_.get(); }

 private:
  fs::path file_;
  std::unique_ptr<sqlite3, CloseDatabase> database_;
};

/// Adds rows to a table.
class Insertion {
 public:
  Insertion(const Database& database, const char* table, int columns) : database_(database) {
    std::string text = fmt::format("INSERT OR IGNORE INTO {} VALUES(?", table);
    for (int i = 1; i < columns; ++i) text += ", ?";
    database_.Check(
        sqlite3_prepare_v2(database_.get(), (text + ")").c_str(), -1, &statement_, nullptr));
  }
  ~Insertion() { sqlite3_finalize(statement_); }
  Insertion(const Insertion&) = delete;
  Insertion& operator=(const Insertion&) = delete;

  template <class... Values>
  void Add(const Values&... values) {
    column_ = 0;
    (Bind(values), ...);
    database_.Check(sqlite3_step(statement_));
    database_.Check(sqlite3_reset(statement_));
  }

 private:
  void Bind(std::int64_t value) {
    database_.Check(sqlite3_bind_int64(statement_, ++column_, value));
  }
  void Bind(int value) { Bind(std::int64_t{value}); }
  void Bind(double value) { database_.Check(sqlite3_bind_double(statement_, ++column_, value)); }
  void Bind(const std::string& value) {
    database_.Check(sqlite3_bind_text(statement_, ++column_, value.data(),
                                      static_cast<int>(value.size()), SQLITE_TRANSIENT));
  }
  void Bind(const std::optional<bool>& value) {
    if (value) return Bind(std::int64_t{*value});
    database_.Check(sqlite3_bind_null(statement_, ++column_));
  }
  /// A pair of names as a JSON list.
  void Bind(const std::array<models::Name, 2>& pair) {
    Bind(oca::internal::JsonText(ordered_json{pair[0].text(), pair[1].text()}));
  }

  const Database& database_;
  sqlite3_stmt* statement_{nullptr};
  int column_{0};
};

void AddCampaign(const Database& database, const Campaign& campaign) {
  Insertion properties(database, "campaign", 2);
  const ordered_json tree = CampaignTree(campaign);
  for (const auto& [key, value] : tree.items()) {
    properties.Add(key,
                   value.is_string() ? value.get<std::string>() : oca::internal::JsonText(value));
  }
  Insertion settings(database, "setting", 3);
  int combination = 0;
  for (const Settings& one : campaign.Combinations()) {
    for (const auto& [path, value] : one) settings.Add(combination, path, value);
    ++combination;
  }
}

void AddMetrics(Insertion& rows, const SampleRow& row) {
  for (const systems::Metric& metric : systems::MetricsIn(*row.metrics)) {
    const std::string name(metric.name);
    if (const auto number = metric.number()) rows.Add(row.sample, row.combination, name, *number);
    if (const auto* const pair = std::get_if<std::array<models::Name, 2>>(&metric.value)) {
      rows.Add(row.sample, row.combination, name, *pair);
    }
  }
}

void AddRows(const Database& database, const Results& results) {
  const Campaign& campaign = results.campaign;
  const auto combinations = campaign.Combinations();
  Insertion samples(database, "sample", 13);
  Insertion draws(database, "drawn", 3);
  Insertion metrics(database, "metric", 4);
  for (const SampleRow& row : results.rows) {
    const Verdict judged = Judge(row, campaign.arrival);
    const Settings& settings = combinations.at(static_cast<std::size_t>(row.combination));
    samples.Add(row.sample, row.combination, row.seed, std::string(NameOf(row.outcome)), row.error,
                row.duration, row.steps, judged.clear, judged.sampled_clear, judged.arrived,
                std::optional<bool>(judged.met), FailureOf(row, campaign.arrival),
                campaign.CommandOf(row.seed, settings));
    for (const auto& [path, value] : campaign.Drawn(row.seed)) draws.Add(row.sample, path, value);
    if (row.metrics) AddMetrics(metrics, row);
  }
}

void AddTimings(const Database& database, const std::vector<SampleTiming>& timings) {
  Insertion rows(database, "timing", 7);
  for (const SampleTiming& one : timings) {
    rows.Add(one.sample, one.combination, one.load_seconds, one.run_seconds,
             one.steps.Quantile(0.5), one.steps.Quantile(0.99), one.steps.max());
  }
}

}  // namespace

void WriteDatabase(const fs::path& file, const Results& results) {
  models::WholeFile whole(file);
  {
    Database database(whole.part(), file);
    database.Execute(kTables);
    AddCampaign(database, results.campaign);
    AddRows(database, results);
    AddTimings(database, results.timings);
    database.Execute("COMMIT;");
  }
  whole.Commit();
}

}  // namespace oca::sweep
