// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/foreign_text.h"

#include <fmt/format.h>

#include <cstdint>
#include <iterator>

namespace oca::models::internal {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

unsigned char ByteAt(std::string_view text, std::size_t i) {
  return static_cast<unsigned char>(text[i]);
}

std::size_t AnnouncedLength(unsigned char first) {
  if (first < 0x80) return 1;
  if (first < 0xc2) return 0;
  if (first < 0xe0) return 2;
  if (first < 0xf0) return 3;
  return first < 0xf5 ? 4 : 0;
}

/// The control characters of ISO 6429 and those that turn the direction of text.
bool IsObeyed(std::uint32_t code) {
  const bool control = code < 0x20 || (code >= 0x7f && code < 0xa0);
  const bool turns = code == 0x61c || code == 0x200e || code == 0x200f ||
                     (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  return (control && code != '\n' && code != '\t') || turns;
}

/// A copy with `change(sequence, valid, out)` for each sequence, and each byte that is none.
template <class Change>
std::string Changed(std::string_view text, const Change& change) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = Utf8Length(text);
    const std::string_view sequence = text.substr(0, length == 0 ? 1 : length);
    change(sequence, length > 0, out);
    text.remove_prefix(sequence.size());
  }
  return out;
}

}  // namespace

void AppendUtf8(std::string& text, std::uint32_t code) {
  const auto tail = [&](int shift) { text += static_cast<char>(0x80 | (code >> shift & 0x3f)); };
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += static_cast<char>(0xc0 | code >> 6);
    tail(0);
  } else if (code < 0x10000) {
    text += static_cast<char>(0xe0 | code >> 12);
    tail(6);
    tail(0);
  } else {
    text += static_cast<char>(0xf0 | code >> 18);
    tail(12);
    tail(6);
    tail(0);
  }
}

std::uint32_t CodePoint(std::string_view sequence) {
  if (sequence.size() == 1) return ByteAt(sequence, 0);
  std::uint32_t code = ByteAt(sequence, 0) & (0xffu >> (sequence.size() + 1));
  for (std::size_t i = 1; i < sequence.size(); ++i) {
    code = code << 6 | (ByteAt(sequence, i) & 0x3fu);
  }
  return code;
}

std::size_t Utf8Length(std::string_view text) {
  const unsigned char first = ByteAt(text, 0);
  const std::size_t length = AnnouncedLength(first);
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((ByteAt(text, i) & 0xc0) != 0x80) return 0;
  }
  if (length < 3) return length;
  // Longer than needed, a surrogate, or beyond the last code point.
  const unsigned char second = ByteAt(text, 1);
  const bool wrong = (first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ||
                     (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f);
  return wrong ? 0 : length;
}

std::size_t Utf8Prefix(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t length = Utf8Length(text.substr(at));
    if (length == 0) return at;
    at += length;
  }
  return at;
}

std::string AsUtf8(std::string_view text) {
  if (Utf8Prefix(text) == text.size()) return std::string(text);
  return Changed(text, [](std::string_view sequence, bool valid, std::string& out) {
    out += valid ? sequence : kReplacement;
  });
}

std::string SpeltAsUtf8(std::string_view text) {
  return Changed(text, [](std::string_view sequence, bool valid, std::string& out) {
    if (valid) {
      out += sequence;
    } else {
      fmt::format_to(std::back_inserter(out), "{}{:02x}", kReplacement, ByteAt(sequence, 0));
    }
  });
}

std::string Harmless(std::string_view text) {
  return Changed(text, [](std::string_view sequence, bool valid, std::string& out) {
    if (!valid) {
      out += kReplacement;
      return;
    }
    const std::uint32_t code = CodePoint(sequence);
    if (!IsObeyed(code)) {
      out += sequence;
    } else if (code < 0x100) {
      fmt::format_to(std::back_inserter(out), "\\x{:02x}", code);
    } else {
      fmt::format_to(std::back_inserter(out), "\\u{:04x}", code);
    }
  });
}

}  // namespace oca::models::internal
