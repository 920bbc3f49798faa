// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "oca/framework/dataflow/signal.h"

namespace oca::record {

/// A signal of a run, and how it becomes text for those who need text.
struct SignalFormat {
  std::string system;
  std::string port;
  const SignalType* type;
  int length;                       ///< of a Vector
  std::string unit;                 ///< of a Vector; may be empty
  std::vector<std::string> joints;  ///< one an element; empty: no joints
  bool brief{false};                ///< of proximities only names and distance
};

/// A stream of samples. `schema` is the JSON Schema of their text.
struct RecordChannel {
  std::string topic{};
  std::string schema_name{};
  std::string schema{};
  /// What the samples are values of; none: messages of Foxglove, which are text from the start.
  std::optional<SignalFormat> signal{};
};

/// A value of a channel at an instant, on its way to sinks; valid during one RecordSink::Write.
class RecordSample {
 public:
  /// `value` as `format.type` knows it, of a Vector its numbers. `text` is where its JSON goes,
  /// once however many sinks ask for it, and is not touched if none does. `time` ns since the
  /// epoch.
  RecordSample(const SignalFormat& format, const void* value, std::uint64_t time, std::string& text)
      : format_(&format), value_(value), time_(time), text_(&text) {}
  RecordSample(std::string_view message, std::uint64_t time) : time_(time), json_(message) {}

  std::uint64_t time() const { return time_; }
  /// nullptr of a message that is text from the start.
  const void* value() const { return value_; }
  std::string_view json() const;

 private:
  const SignalFormat* format_{nullptr};
  const void* value_{nullptr};
  std::uint64_t time_;
  std::string* text_{nullptr};
  mutable std::string_view json_{};  ///< empty: nobody asked yet
};

}  // namespace oca::record
