// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <tinyxml.h>

#include <filesystem>
#include <fstream>

#include "oca/models/error.h"
#include "oca/models/robot/xml_file.h"
#include "oca/models/robot/xml_numbers.h"
#include "tests/temporary_folder.h"

namespace oca::robot::test {
namespace xml_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Optional;
using testing::ThrowsMessage;

void ExpectRefused(const std::string& text, const char* reason) {
  EXPECT_THAT([&] { ParseXml(text, "file.urdf"); },
              ThrowsMessage<models::ModelError>(AllOf(HasSubstr("file.urdf"), HasSubstr(reason))));
}

TEST(XmlTest, ReadsDeclarationCommentsCdataAndAttributes) {
  const auto document = ParseXml(
      "\xEF\xBB\xBF<?xml version=\"1.0\"?>\n<!-- a < b -->\n<a x='1 > 0' y = \"2\"><b/>text"
      "<![CDATA[<c>]]></a >\n<!-- end -->\n",
      "file.urdf");
  EXPECT_STREQ(document->RootElement()->Attribute("x"), "1 > 0");
  EXPECT_STREQ(document->RootElement()->FirstChildElement()->Value(), "b");
}

TEST(XmlTest, RefusesWhatIsNoXml) {
  ExpectRefused("", "got nothing");
  ExpectRefused(" \n\t", "got nothing");
  ExpectRefused("hello", "outside the root");
  ExpectRefused("<!-- only -->", "root element");
  ExpectRefused(std::string("<a>\0</a>", 8), "binary");
  ExpectRefused(
      "\x7f"
      "ELF\x02\x01",
      "binary data");
}

TEST(XmlTest, RefusesMalformedXmlWithItsLine) {
  ExpectRefused("<a>\n<b>\n</a>", "file.urdf:3");
  ExpectRefused("<a>", "inside <a>");
  ExpectRefused("</a>", "opening tag");
  ExpectRefused("<a/><b/>", "second root");
  ExpectRefused("<a/>text", "outside the root");
  ExpectRefused("<a b=c/>", "without quotes");
  ExpectRefused("<a b/>", "without value");
  ExpectRefused("<a b='1/>", "without closing quote");
  ExpectRefused("<a b='<'/>", "without closing quote");
  ExpectRefused("<a / >", "'/'");
  ExpectRefused("<a", "name");
  ExpectRefused("< a/>", "without name");
  ExpectRefused("<a><!-- x </a>", "comment without end");
  ExpectRefused("<a b='1' b='2'/>", "got");
}

TEST(XmlTest, RefusesDocumentTypeDeclarations) {
  ExpectRefused("<!DOCTYPE a [<!ENTITY x 'y'>]><a>&x;</a>", "document type");
}

std::string Nested(int depth) {
  std::string text;
  for (int i = 0; i < depth; ++i) text += "<a>";
  for (int i = 0; i < depth; ++i) text += "</a>";
  return text;
}

TEST(XmlTest, RefusesMoreThan64NestedElements) {
  EXPECT_NO_THROW(ParseXml(Nested(64), "file.urdf"));
  ExpectRefused(Nested(65), "more than 64");
  ExpectRefused(Nested(1'000'000), "more than 64");
  ExpectRefused(std::string(3'000'000, '<'), "without name");
}

TEST(XmlTest, RefusesFilesThatCannotBeRead) {
  EXPECT_THAT([] { ReadXmlFile("/nowhere/robot.urdf"); },
              ThrowsMessage<models::ModelError>(HasSubstr("/nowhere/robot.urdf")));
  EXPECT_THAT([] { ReadXmlFile(testing::TempDir()); },
              ThrowsMessage<models::ModelError>(HasSubstr("not a regular file")));
}

TEST(XmlTest, RefusesFilesAbove50Megabytes) {
  const oca::test::TemporaryFolder folder;
  const std::string file = folder.Write("large.urdf", "<robot/>").string();
  std::filesystem::resize_file(file, 50'000'000);
  EXPECT_EQ(ReadXmlFile(file).size(), 50'000'000u);
  std::filesystem::resize_file(file, 50'000'001);
  EXPECT_THAT([&] { ReadXmlFile(file); },
              ThrowsMessage<models::ModelError>(HasSubstr("50000001 bytes")));
}

TEST(XmlNumbersTest, ReadsNumbersSeparatedByAnySpace) {
  EXPECT_THAT(ParseFiniteNumbers(" 1\t-2.5e-3\n+4 "), Optional(ElementsAre(1.0, -2.5e-3, 4.0)));
  EXPECT_THAT(ParseFiniteNumbers(""), Optional(ElementsAre()));
}

TEST(XmlNumbersTest, RefusesWhatIsNoFiniteNumber) {
  for (const char* text : {"nan", "inf", "-inf", "1e999", "1,5", "0x10", "1 2x", "--1", "+-1"}) {
    EXPECT_EQ(ParseFiniteNumbers(text), std::nullopt) << text;
  }
}

}  // namespace xml_test
}  // namespace oca::robot::test
