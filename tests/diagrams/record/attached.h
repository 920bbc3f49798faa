// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sstream>
#include <vector>

#include "oca/diagrams/record/mcap_reader.h"
#include "oca/diagrams/record/mcap_writer.h"

namespace oca::record::test {

/// A record that has attachments alone.
inline McapFile FileOf(const std::vector<Attachment>& attachments) {
  std::ostringstream stream;
  McapWriter writer(stream, Compression::kNone);
  for (const Attachment& attachment : attachments) writer.AddAttachment(attachment);
  writer.Close();
  return McapFile::Parse(stream.str(), "attachments");
}

}  // namespace oca::record::test
