// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xml_file.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "oca/models/error.h"
#include "oca/models/file_cache.h"
#include "oca/models/opened_files.h"

namespace oca::robot {
namespace {

constexpr std::uintmax_t kMaxBytes = 50'000'000;
constexpr std::size_t kMaxDepth = 64;
constexpr int kMaxAttributes = 1000;  // TinyXML compares each with all before it
constexpr std::string_view kSpace = " \t\r\n";

// Walks over XML text and refuses what TinyXML would accept or crash on: it parses recursively,
// takes unquoted attributes and stops quietly at the end of the first root element.
class XmlScanner {
 public:
  XmlScanner(std::string_view text, const std::string& where) : text_(text), where_(where) {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
  }

  void Scan() {
    if (text_.find('\0') != text_.npos) Fail("binary data", "XML text");
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

std::string ReadText(const std::filesystem::path& file) {
  models::NoteOpened(file);
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw models::ModelError(fmt::format(
        "{}: file; got {}; expected a readable file", file.string(),
        std::filesystem::exists(file, error) ? "no regular file" : "nothing of that name"));
  }
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (!error && bytes > kMaxBytes) {
    throw models::ModelError(fmt::format("{}: file size; got {} bytes; expected at most {}",
                                         file.string(), bytes, kMaxBytes));
  }
  std::ifstream stream(file, std::ios::binary);
  std::string text(error ? 0 : bytes, '\0');
  if (error || !stream.read(text.data(), static_cast<std::streamsize>(bytes))) {
    throw models::ModelError(file.string() +
                             ": file; got one that cannot be read; expected a readable file");
  }
  return text;
}

}  // namespace

void XmlDeleter::operator()(TiXmlDocument* document) const { delete document; }

std::string ReadXmlFile(const std::filesystem::path& file) {
  return *models::ReadOnce<std::string>(file, "XML", [&] { return ReadText(file); });
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
  document->Parse(text.c_str());
  if (document->Error() || document->RootElement() == nullptr) {
    throw models::ModelError(fmt::format("{}:{}: XML; got '{}'; expected well-formed XML", where,
                                         document->ErrorRow(), document->ErrorDesc()));
  }
  return document;
}

}  // namespace oca::robot
