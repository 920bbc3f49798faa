// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace oca::models {

/// An interned string: the size of a pointer, compared by identity, copied without a heap.
///
/// Signals that name a link or an obstacle thousand times a second carry this instead of a
/// std::string. The text lives as long as the process; equal texts are the same Name in any thread.
class Name {
 public:
  /// The empty name.
  Name();
  /// Interns `text`; takes a lock, so it belongs into loading, not into a tick.
  explicit Name(std::string_view text);

  const std::string& text() const { return *text_; }
  bool empty() const { return text_->empty(); }
  friend bool operator==(Name a, Name b) { return a.text_ == b.text_; }

 private:
  const std::string* text_;
};

}  // namespace oca::models
