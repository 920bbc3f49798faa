// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/live_commands.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "oca/diagrams/live/access.h"
#include "oca/diagrams/live/live_run.h"
#include "oca/diagrams/live/live_server.h"
#include "oca/diagrams/record/extracted_record.h"
#include "oca/diagrams/record/page.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/counted.h"
#include "oca/models/file_bytes.h"
#include "tools/simulator/interrupt.h"
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

void SayCrowded(const std::string& what) { Tell("warning: {}\n", what); }

std::string RecordBytes(const std::string& file) {
  if (!record::IsRecord(file)) {
    throw ConfigError(fmt::format("view: file; got {}; expected a record (.mcap)", file));
  }
  return models::ReadUnnoted(file, std::uintmax_t{4} << 30);
}

live::LiveOptions ServerOptions(const RunArguments& arguments) {
  live::LiveOptions options;
  options.address = arguments.live_address;
  options.port = arguments.live.value_or(options.port);
  try {
    options.page = record::PageWithSource(record::LoadPage(), "live");
  } catch (const ConfigError& error) {  // Foxglove and Lichtblick need no page of ours
    Tell("warning: {}\n", error.what());
    options.page = kNoPage;
  }
  options.origins = arguments.live_origins;
  options.forbidden = SayForbidden;
  options.crowded = SayCrowded;
  return options;
}

}  // namespace

int RunLiveCommand(const RunArguments& arguments, const std::vector<files::Override>& overrides,
                   const files::Catalogue& catalogue, Log* log) {
  if (record::IsRecord(arguments.file)) {
    throw ConfigError(
        fmt::format("--live: file; got the record {}; expected a diagram file, or "
                    "`simulator view` to look at a record",
                    arguments.file));
  }
  CatchInterrupts();
  live::LiveServer server(ServerOptions(arguments));
  RunFiles files(arguments.files, overrides);
  live::LiveRunOptions options;
  options.file = arguments.file;
  options.catalogue = catalogue;
  options.overrides = overrides;
  options.duration = arguments.duration;
  options.realtime_factor = arguments.realtime.value_or(1.0);
  options.log = log;
  options.outputs = files.outputs();
  options.interrupted = Interrupted;
  options.refused = [](const std::string& why) { Tell("warning: change refused: {}\n", why); };
  options.warned = [](const std::string& warning) { Tell("{}\n", warning); };
  SayWhere("live, in a browser, Foxglove or Lichtblick; Ctrl-C ends it", server,
           arguments.live_address, "change the run");
  const live::LiveRunResult result = live::RunLive(options, server);
  files.TellDropped();
  const live::LiveStatistics statistics = server.statistics();
  Print("{:.2f} s simulated, {} changes of parameters, {} messages sent\n", result.run.duration,
        result.changes, statistics.sent);
  if (statistics.dropped > 0) {
    Tell("warning: {} messages left out for clients that were too slow\n", statistics.dropped);
  }
  if (statistics.gave_way + statistics.refused > 0) {
    Tell("warning: {} gave way to new ones, {} refused\n",
         models::Counted(statistics.gave_way, "silent connection"),
         models::Counted(statistics.refused, "connection"));
  }
  if (!result.run.failure) return result.run.interrupted ? kInterrupted : kFine;
  Tell("error: {}\n", result.run.failure->message);
  return kRunFailed;
}

void AddServerOptions(CLI::App& command, ViewArguments& arguments) {
  command.add_option("--port", arguments.port, "to serve it on; 0: any that is free")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command.add_option("--address", arguments.address, "to serve it on")->capture_default_str();
}

int ServeRecord(const std::string& what, std::string record, const ViewArguments& arguments) {
  live::LiveOptions options;
  options.address = arguments.address;
  options.port = arguments.port;
  options.record = std::move(record);
  options.page = record::PageWithSource(record::LoadPage(), "record.mcap");
  options.forbidden = SayForbidden;
  options.crowded = SayCrowded;
  const live::LiveServer server(options);
  CatchInterrupts();
  SayWhere(what + ", in a browser; Ctrl-C ends it", server, arguments.address, "read the record");
  while (!Interrupted()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  return kInterrupted;
}

int ViewCommand(const ViewArguments& arguments) {
  return ServeRecord(arguments.file, RecordBytes(arguments.file), arguments);
}

}  // namespace oca::tools
