// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/urdfdom.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <mutex>
#include <string>
#include <string_view>

#include "oca/models/error.h"

namespace oca::robot {
namespace {

// Keeps what urdfdom says instead of letting it print, while this object lives. The handler of
// console_bridge is global, so one thread at a time.
class CapturedLog : public console_bridge::OutputHandler {
 public:
  CapturedLog() : lock_(Mutex()) { console_bridge::useOutputHandler(this); }
  ~CapturedLog() override { console_bridge::restorePreviousOutputHandler(); }
  CapturedLog(const CapturedLog&) = delete;
  CapturedLog& operator=(const CapturedLog&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    errors_ += (errors_.empty() ? "" : "; ") + text;
  }
  const std::string& errors() const { return errors_; }

 private:
  static std::mutex& Mutex() {
    static std::mutex mutex;
    return mutex;
  }
  std::lock_guard<std::mutex> lock_;
  std::string errors_;
};

}  // namespace

std::shared_ptr<urdf::ModelInterface> ParseWithUrdfdom(const std::string& text,
                                                       const std::string& where) {
  CapturedLog log;
  std::shared_ptr<urdf::ModelInterface> parsed;
  std::string reason;
  try {
    // Without the mark of UTF-8, `&#233;` is a byte of Latin-1.
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    parsed = urdf::parseURDF(text.starts_with(kByteOrderMark) ? text
                                                              : std::string(kByteOrderMark) + text);
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (parsed == nullptr || !log.errors().empty()) {
    throw models::ModelError(fmt::format("{}: URDF; got '{}{}'; expected what urdfdom can read",
                                         where, log.errors(), reason));
  }
  return parsed;
}

}  // namespace oca::robot
