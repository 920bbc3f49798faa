// SPDX-License-Identifier: BSD-3-Clause
#include "tools/live_commands.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string_view>
#include <thread>

#include "diagrams/live/live_run.h"
#include "diagrams/live/live_server.h"
#include "diagrams/live/page.h"
#include "framework/error.h"

namespace oca::tools {
namespace {

constexpr char kNoPage[] = "<!doctype html><title>OCA</title><p>The viewer page was not built.";

/// The address for a browser.
std::string Url(const std::string& address, int port) {
  const bool six = address.find(':') != std::string::npos;
  return six ? fmt::format("http://[{}]:{}/", address, port)
             : fmt::format("http://{}:{}/", address, port);
}

void SayWhere(const std::string& what, const std::string& address, int port) {
  fmt::print("{}: {}\n", what, Url(address, port));
  std::fflush(stdout);
}

std::atomic<bool> ended{false};
void End(int) { ended = true; }

std::string ReadRecord(const std::string& file) {
  constexpr std::string_view kMagic("\x89MCAP", 5);
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (!stream || !bytes.starts_with(kMagic)) {
    throw ConfigError(fmt::format("view: file; got {}; expected a record (.mcap)", file));
  }
  return bytes;
}

}  // namespace

int RunLiveCommand(const RunArguments& arguments, const std::vector<diagrams::Override>& overrides,
                   Log* log, const std::function<bool()>& interrupted) {
  live::LiveOptions server_options;
  server_options.address = arguments.live_address;
  server_options.port = arguments.live.value_or(server_options.port);
  try {
    server_options.page = live::PageWithSource(live::LoadPage(), "live");
  } catch (const ConfigError& error) {  // Foxglove and Lichtblick need no page of ours
    fmt::print(stderr, "warning: {}\n", error.what());
    server_options.page = kNoPage;
  }
  live::LiveServer server(server_options);
  live::LiveRunOptions options;
  options.file = arguments.file;
  options.overrides = overrides;
  options.duration = arguments.duration;
  options.realtime_factor = arguments.realtime.value_or(1.0);
  options.version = OCA_VERSION;
  options.log = log;
  options.interrupted = interrupted;
  options.refused = [](const std::string& why) {
    fmt::print(stderr, "warning: change refused: {}\n", why);
  };
  SayWhere("live, in a browser, Foxglove or Lichtblick; Ctrl-C ends it", arguments.live_address,
           server.port());
  const live::LiveRunResult result = live::RunLive(options, server);
  const live::LiveStatistics statistics = server.statistics();
  fmt::print("{:.2f} s simulated, {} changes of parameters, {} messages sent\n", result.duration,
             result.changes, statistics.sent);
  if (statistics.dropped > 0) {
    fmt::print(stderr, "warning: {} messages left out for clients that were too slow\n",
               statistics.dropped);
  }
  if (result.failure.empty()) return kFine;
  fmt::print(stderr, "error: {}\n", result.failure);
  return kRunFailed;
}

int ViewCommand(const ViewArguments& arguments) {
  live::LiveOptions options;
  options.address = arguments.address;
  options.port = arguments.port;
  options.record = ReadRecord(arguments.file);
  options.page = live::PageWithSource(live::LoadPage(), "record.mcap");
  const live::LiveServer server(options);
  std::signal(SIGINT, End);
  std::signal(SIGTERM, End);
  SayWhere(arguments.file + ", in a browser; Ctrl-C ends it", arguments.address, server.port());
  while (!ended) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  return kFine;
}

}  // namespace oca::tools
