// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xml_file.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "oca/models/error.h"
#include "oca/models/file_bytes.h"
#include "oca/models/file_cache.h"
#include "oca/models/foreign_text.h"

namespace oca::robot {
namespace {

constexpr std::uintmax_t kMaxBytes = 50'000'000;
constexpr std::size_t kMaxDepth = 64;
constexpr int kMaxAttributes = 1000;  // TinyXML compares each with all before it
constexpr std::string_view kSpace = " \t\r\n";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
// source XML 1.0, 2.2
constexpr std::string_view kNotInXml(
    "\0\1\2\3\4\5\6\7\b\v\f\x0e\x0f\x10\x11\x12\x13\x14\x15\x16\x17\x18\x19\x1a\x1b\x1c\x1d\x1e"
    "\x1f",
    29);

bool IsXmlCharacter(std::uint32_t code) {
  return code == '\t' || code == '\n' || code == '\r' || (code >= 0x20 && code < 0xd800) ||
         (code >= 0xe000 && code < 0xfffe) || (code >= 0x10000 && code < 0x110000);
}

/// NameStartChar and NameChar of XML 1.0, 2.3.
bool StartsXmlName(std::uint32_t code) {
  constexpr std::pair<std::uint32_t, std::uint32_t> kRanges[] = {
      {':', ':'},       {'A', 'Z'},       {'_', '_'},       {'a', 'z'},
      {0xc0, 0xd6},     {0xd8, 0xf6},     {0xf8, 0x2ff},    {0x370, 0x37d},
      {0x37f, 0x1fff},  {0x200c, 0x200d}, {0x2070, 0x218f}, {0x2c00, 0x2fef},
      {0x3001, 0xd7ff}, {0xf900, 0xfdcf}, {0xfdf0, 0xfffd}, {0x10000, 0xeffff}};
  return std::any_of(std::begin(kRanges), std::end(kRanges), [&](const auto& range) {
    return code >= range.first && code <= range.second;
  });
}
bool ContinuesXmlName(std::uint32_t code) {
  return StartsXmlName(code) || code == '-' || code == '.' || (code >= '0' && code <= '9') ||
         code == 0xb7 || (code >= 0x300 && code <= 0x36f) || code == 0x203f || code == 0x2040;
}

/// The offset of the first sequence of UTF-8 that is none or whose code point `holds` is false for;
/// the length if there is none.
template <class Holds>
std::size_t PrefixWhere(std::string_view text, const Holds& holds) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t length = models::internal::Utf8Length(text.substr(at));
    if (length == 0 || !holds(models::internal::CodePoint(text.substr(at, length)))) return at;
    at += length;
  }
  return at;
}

// Walks over XML text and refuses what TinyXML would accept or crash on: it parses recursively,
// takes unquoted attributes and stops quietly at the end of the first root element.
class XmlScanner {
 public:
  XmlScanner(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  void Scan() {
    at_ = std::min(models::internal::Utf8Prefix(text_), text_.find_first_of(kNotInXml));
    if (at_ < text_.size()) Fail("binary data, or text of another encoding", "XML text in UTF-8");
    at_ = text_.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
    CheckReferences();
    while (ScanText()) ScanMarkup();
    if (!open_.empty()) Fail(fmt::format("end of text inside <{}>", open_.back()), "closing tags");
    if (!rooted_) Fail("no element", "XML with a root element");
  }

 private:
  [[noreturn]] void Fail(std::string_view got, std::string_view expected) const {
    const auto line =
        1 + std::count(text_.begin(), text_.begin() + std::min(at_, text_.size()), '\n');
    throw models::ModelError(
        fmt::format("{}:{}: XML; got {}; expected {}", where_, line, got, expected));
  }

  /// What `&#27;` stands for must be a character that may stand there itself.
  void CheckReferences() {
    const std::size_t begin = at_;
    for (at_ = text_.find("&#"); at_ != text_.npos; at_ = text_.find("&#", at_ + 2)) {
      const bool hexadecimal = text_.substr(at_ + 2).starts_with('x');
      const char* const first = text_.data() + at_ + (hexadecimal ? 3 : 2);
      std::uint32_t code = 0;
      const auto [end, error] =
          std::from_chars(first, text_.data() + text_.size(), code, hexadecimal ? 16 : 10);
      const bool whole = error == std::errc() && end != text_.data() + text_.size() && *end == ';';
      if (whole && IsXmlCharacter(code)) continue;
      Fail(fmt::format("the reference {:.12}", text_.substr(at_)), "one to a character of XML");
    }
    at_ = begin;
  }

  // To the next '<'; false at the end.
  bool ScanText() {
    const std::size_t next = std::min(text_.find('<', at_), text_.size());
    const std::size_t solid = text_.find_first_not_of(kSpace, at_);
    if (open_.empty() && solid < next) Fail("text outside the root element", "an element");
    at_ = next;
    return at_ < text_.size();
  }

  void ScanMarkup() {
    const std::string_view rest = text_.substr(at_);
    if (rest.starts_with("<!--")) return SkipPast("-->", 4, "a comment without end");
    if (rest.starts_with("<![CDATA[")) return SkipPast("]]>", 9, "a CDATA section without end");
    if (rest.starts_with("<!")) Fail("a document type declaration", "elements only");
    if (rest.starts_with("<?")) return SkipPast(">", 2, "a declaration without end");
    if (rest.starts_with("</")) return ScanClosingTag();
    ScanOpeningTag();
  }

  void SkipPast(std::string_view end, std::size_t from, std::string_view got) {
    const std::size_t found = text_.find(end, at_ + from);
    if (found == text_.npos) Fail(got, "its end");
    at_ = found + end.size();
  }

  void SkipSpace() { at_ = std::min(text_.find_first_not_of(kSpace, at_), text_.size()); }
  char Here() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  std::string_view ScanName() {
    const std::size_t end = std::min(text_.find_first_of(" \t\r\n/>=<\"'", at_), text_.size());
    if (end == at_) Fail("a tag or attribute without name", "a name");
    const std::string_view name = text_.substr(at_, end - at_);
    at_ = end;
    return name;
  }

  void ScanClosingTag() {
    at_ += 2;
    const std::string_view name = ScanName();
    SkipSpace();
    if (open_.empty() || open_.back() != name || Here() != '>') {
      Fail(fmt::format("</{}>", name),
           open_.empty() ? "an opening tag first" : fmt::format("</{}>", open_.back()));
    }
    ++at_;
    open_.pop_back();
  }

  void ScanOpeningTag() {
    if (open_.empty() && rooted_) Fail("a second root element", "one root element");
    rooted_ = true;
    ++at_;
    const std::string_view name = ScanName();
    int attributes = 0;
    for (SkipSpace(); Here() != '>' && Here() != '/'; SkipSpace()) {
      ScanAttribute();
      if (++attributes > kMaxAttributes) {
        Fail(fmt::format("more than {} attributes in <{}>", kMaxAttributes, name), "fewer");
      }
    }
    if (Here() == '/') {
      if (++at_; Here() != '>') Fail("'/' inside a tag", "'/>'");
    } else {
      open_.push_back(name);
      if (open_.size() > kMaxDepth) {
        Fail(fmt::format("more than {} nested elements", kMaxDepth), "a robot description");
      }
    }
    ++at_;
  }

  void ScanAttribute() {
    const std::string_view name = ScanName();
    SkipSpace();
    if (Here() != '=') Fail(fmt::format("attribute {} without value", name), "name=\"value\"");
    ++at_;
    SkipSpace();
    const char quote = Here();
    if (quote != '"' && quote != '\'') {
      Fail(fmt::format("attribute {} without quotes", name), "name=\"value\"");
    }
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == text_.npos || text_.substr(at_, end - at_).find('<') != text_.npos) {
      Fail(fmt::format("attribute {} without closing quote", name), "name=\"value\"");
    }
    at_ = end + 1;
  }

  std::string_view text_;
  const std::string& where_;
  std::size_t at_{0};
  bool rooted_{false};
  std::vector<std::string_view> open_;
};

}  // namespace

std::size_t XmlPrefix(std::string_view text) { return PrefixWhere(text, IsXmlCharacter); }

bool IsXmlName(std::string_view text) {
  const std::size_t first = text.empty() ? 0 : models::internal::Utf8Length(text);
  return first > 0 && StartsXmlName(models::internal::CodePoint(text.substr(0, first))) &&
         PrefixWhere(text, ContinuesXmlName) == text.size();
}

void XmlDeleter::operator()(TiXmlDocument* document) const { delete document; }

std::string ReadXmlFile(const std::filesystem::path& file) {
  return *models::ReadOnce<std::string>(file, "XML",
                                        [&] { return models::ReadFile(file, kMaxBytes); });
}

XmlDocument ParseXml(const std::string& text, const std::string& where) {
  if (text.find_first_not_of(kSpace) == text.npos) {
    throw models::ModelError(where + ": text; got nothing; expected XML");
  }
  if (text.size() > kMaxBytes) {
    throw models::ModelError(fmt::format("{}: text size; got {} bytes; expected at most {}", where,
                                         text.size(), kMaxBytes));
  }
  XmlScanner(text, where).Scan();
  XmlDocument document(new TiXmlDocument);
  document->Parse(text.c_str(), nullptr, TIXML_ENCODING_UTF8);
  if (document->Error() || document->RootElement() == nullptr) {
    throw models::ModelError(fmt::format("{}:{}: XML; got '{}'; expected well-formed XML", where,
                                         document->ErrorRow(), document->ErrorDesc()));
  }
  return document;
}

}  // namespace oca::robot
