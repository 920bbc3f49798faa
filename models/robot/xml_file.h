// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

class TiXmlDocument;

namespace oca::robot {

/// Deletes what this header only declares.
struct XmlDeleter {
  void operator()(TiXmlDocument* document) const;
};
using XmlDocument = std::unique_ptr<TiXmlDocument, XmlDeleter>;

/// The whole text of a regular file of at most 50 MB. throws ModelError naming the file
std::string ReadXmlFile(const std::filesystem::path& file);

/// Parses `text`; `where` begins each message. The document has a root element.
/// throws ModelError if the text is empty, binary, malformed, nested deeper than 64 elements, has
/// more than 1000 attributes in an element or a document type declaration
XmlDocument ParseXml(const std::string& text, const std::string& where);

/// How many bytes of a text are characters that XML may hold, up to the first that is none.
/// source XML 1.0, 2.2
std::size_t XmlPrefix(std::string_view text);
/// Whether it may name an element or an attribute. source XML 1.0, 2.3
bool IsXmlName(std::string_view text);

}  // namespace oca::robot
