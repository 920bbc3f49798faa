// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace oca::models::internal {

// Text that somebody else wrote: names of files, words of a command line, what a record holds.

/// Appends a code point, which is no surrogate and at most U+10FFFF. source RFC 3629, 3
void AppendUtf8(std::string& text, std::uint32_t code);
/// Its code point, of a sequence that is UTF-8.
std::uint32_t CodePoint(std::string_view sequence);
/// Length of the UTF-8 sequence that `text`, which is not empty, begins with; 0 if it begins with
/// none. source RFC 3629, 4
std::size_t Utf8Length(std::string_view text);
/// How many bytes of it are UTF-8 up to the first that is not: all, if it is UTF-8.
std::size_t Utf8Prefix(std::string_view text);
/// The same with U+FFFD in place of each byte that is no UTF-8: what JSON, MCAP and YAML can hold.
std::string AsUtf8(std::string_view text);

/// The same with U+FFFD and two hexadecimal digits, by which texts that differ still do.
std::string SpeltAsUtf8(std::string_view text);

/// What a terminal shows and does not obey: UTF-8 in which each character that it would act upon,
/// or that turns the direction of others, is spelt: `\x1b`, `\u202e`. Ends of lines and tabs stay.
std::string Harmless(std::string_view text);

}  // namespace oca::models::internal
