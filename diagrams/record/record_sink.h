// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "oca/diagrams/record/attachment.h"
#include "oca/diagrams/record/record_channel.h"

namespace oca::record {

/// Where the samples of a run go: a file, or whoever looks on. Unless told otherwise, called on the
/// recorder's own thread, one call at a time; may take its time there.
class RecordSink {
 public:
  virtual ~RecordSink() = default;
  /// Before the run, on its thread: channel number `i` is channels[i]. Again when the run goes on
  /// with another diagram, whose channels these are.
  virtual void Begin(const std::vector<RecordChannel>& channels) = 0;
  virtual void Write(int channel, const RecordSample& sample) = 0;
  virtual void AddMetadata(const Metadata& /*metadata*/) {}
  virtual void AddAttachment(const Attachment& /*attachment*/) {}
  /// Many times a second, also while nothing is written.
  virtual void Idle() {}
  /// After the last sample of the run, on its thread.
  virtual void End() {}
};

}  // namespace oca::record
