// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/live_commands.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "oca/diagrams/live/access.h"
#include "oca/diagrams/live/live_run.h"
#include "oca/diagrams/live/live_server.h"
#include "oca/diagrams/live/page.h"
#include "oca/diagrams/record/csv_export.h"
#include "oca/diagrams/record/mcap_reader.h"
#include "oca/diagrams/record/record_sink.h"
#include "oca/framework/dataflow/error.h"
#include "oca/version.h"
#include "tools/simulator/terminal.h"

namespace oca::tools {
namespace {

constexpr char kNoPage[] = "<!doctype html><title>OCA</title><p>The viewer page was not built.";

/// Says where a server is found, and what whoever finds it can do.
void SayWhere(const std::string& what, const live::LiveServer& server, const std::string& address,
              const std::string& can) {
  if (!live::IsLoopback(address)) {
    const bool any = address == "0.0.0.0" || address == "::";
    Tell(
        "warning: {} can be reached from elsewhere{}: whoever has the address below, with its "
        "token, can {}; nothing is encrypted\n",
        address, any ? ", by the address of this machine in its place" : "", can);
  }
  Print("{}: {}\n", what, server.url());
  std::fflush(stdout);
}

void SayForbidden(const std::string& why) { Tell("warning: a request was refused: {}\n", why); }

std::string ReadRecord(const std::string& file) {
  constexpr std::string_view kMagic("\x89MCAP", 5);
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (!stream || !bytes.starts_with(kMagic)) {
    throw ConfigError(fmt::format("view: file; got {}; expected a record (.mcap)", file));
  }
  return bytes;
}

/// What is kept of a live run: a record in memory or in its file, and what is made of it at the
/// end.
class LiveFiles {
 public:
  /// throws ConfigError if a file cannot be written.
  explicit LiveFiles(const RunArguments& arguments) : arguments_(arguments) {
    if (!arguments.report.empty()) page_ = live::LoadPage();
    for (const std::string& file : {arguments.record, arguments.report}) {
      if (!file.empty() && !std::ofstream(file, std::ios::binary | std::ios::app)) {
        throw ConfigError(fmt::format("{}: cannot be written", file));
      }
    }
    if (!arguments.record.empty()) {
      stream_.open(arguments.record,
                   std::ios::in | std::ios::out | std::ios::binary | std::ios::trunc);
      sink_.emplace(stream_, record::ParseCompression(arguments.record_compression));
    } else if (!arguments.report.empty() || !arguments.csv_folder.empty()) {
      sink_.emplace(memory_, record::Compression::kZstd);
    }
  }

  std::vector<record::RecordSink*> sinks() {
    return sink_ ? std::vector<record::RecordSink*>{&*sink_} : std::vector<record::RecordSink*>{};
  }

  /// After the run. throws ConfigError if a file could not be written to the end.
  void Finish() {
    if (!sink_) return;
    sink_->End();
    std::string bytes;
    if (arguments_.record.empty()) {
      bytes = memory_.str();
    } else {
      stream_.close();
      bytes = ReadRecord(arguments_.record);
    }
    if (!arguments_.csv_folder.empty()) {
      record::ExportCsv(record::McapFile::Parse(bytes, "live"), arguments_.csv_folder);
    }
    if (arguments_.report.empty()) return;
    std::ofstream report(arguments_.report, std::ios::binary | std::ios::trunc);
    report << live::PageWithRecord(page_, bytes);
    report.close();
    if (!report) {
      throw ConfigError(
          fmt::format("{}: could not be written to the end (disk full?)", arguments_.report));
    }
  }

 private:
  const RunArguments& arguments_;
  std::string page_;
  std::fstream stream_;
  std::ostringstream memory_;
  std::optional<record::McapSink> sink_;
};

std::atomic<bool> ended{false};
void End(int) { ended = true; }

}  // namespace

int RunLiveCommand(const RunArguments& arguments, const std::vector<files::Override>& overrides,
                   const files::Catalogue& catalogue, Log* log,
                   const std::function<bool()>& interrupted) {
  live::LiveOptions server_options;
  server_options.address = arguments.live_address;
  server_options.port = arguments.live.value_or(server_options.port);
  try {
    server_options.page = live::PageWithSource(live::LoadPage(), "live");
  } catch (const ConfigError& error) {  // Foxglove and Lichtblick need no page of ours
    Tell("warning: {}\n", error.what());
    server_options.page = kNoPage;
  }
  server_options.origins = arguments.live_origins;
  server_options.forbidden = SayForbidden;
  if (!(arguments.record + arguments.report + arguments.csv_folder).empty()) {
    CheckRunOutputs(arguments, loading::LoadDiagram(arguments.file, overrides, catalogue));
  }
  live::LiveServer server(server_options);
  LiveFiles files(arguments);
  live::LiveRunOptions options;
  options.file = arguments.file;
  options.catalogue = catalogue;
  options.overrides = overrides;
  options.duration = arguments.duration;
  options.realtime_factor = arguments.realtime.value_or(1.0);
  options.version = Version();
  options.log = log;
  options.sinks = files.sinks();
  options.interrupted = interrupted;
  options.refused = [](const std::string& why) { Tell("warning: change refused: {}\n", why); };
  options.warned = [](const std::string& warning) { Tell("{}\n", warning); };
  SayWhere("live, in a browser, Foxglove or Lichtblick; Ctrl-C ends it", server,
           arguments.live_address, "change the run");
  const live::LiveRunResult result = live::RunLive(options, server);
  files.Finish();
  const live::LiveStatistics statistics = server.statistics();
  Print("{:.2f} s simulated, {} changes of parameters, {} messages sent\n", result.duration,
        result.changes, statistics.sent);
  if (statistics.dropped > 0) {
    Tell("warning: {} messages left out for clients that were too slow\n", statistics.dropped);
  }
  if (result.failure.empty()) return kFine;
  Tell("error: {}\n", result.failure);
  return kRunFailed;
}

int ViewCommand(const ViewArguments& arguments) {
  live::LiveOptions options;
  options.address = arguments.address;
  options.port = arguments.port;
  options.record = ReadRecord(arguments.file);
  options.page = live::PageWithSource(live::LoadPage(), "record.mcap");
  options.forbidden = SayForbidden;
  const live::LiveServer server(options);
  std::signal(SIGINT, End);
  std::signal(SIGTERM, End);
  SayWhere(arguments.file + ", in a browser; Ctrl-C ends it", server, arguments.address,
           "read the record");
  while (!ended) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  return kFine;
}

}  // namespace oca::tools
