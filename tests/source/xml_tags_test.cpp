#include "source/xml_tags.h"

#include <gtest/gtest.h>

#include <string>

namespace bandvox {
namespace {

/// The tags of a text, with one mark for each kind.
std::string tagsOf(const std::string& text) {
    std::string all;
    forEachXmlTag(text, [&all](const XmlTag& tag) {
        all += tag.kind == XmlTag::Kind::Open ? '+' : tag.kind == XmlTag::Kind::Close ? '-' : '=';
        all += tag.name;
    });
    return all;
}

TEST(XmlTags, AreFoundWhateverStandsBetween) {
    EXPECT_EQ(tagsOf("<a><b/>text</a>"), "+a=b-a");
    EXPECT_EQ(tagsOf("<?xml <x>?><!-- <x> --><a\n b='>'><![CDATA[<x>]]></a >"), "+a-a");
    EXPECT_EQ(tagsOf("<!DOCTYPE a [<!ENTITY b '<x>'>]><a/>"), "=a");
    EXPECT_EQ(tagsOf("<a b='/'>"), "+a");
}

TEST(XmlTags, OfDamagedTextEndWithIt) {
    EXPECT_EQ(tagsOf("<"), "+");
    EXPECT_EQ(tagsOf("<a b='>"), "+a");
    EXPECT_EQ(tagsOf("</"), "-");
    EXPECT_EQ(tagsOf("<a></"), "+a-");
    EXPECT_EQ(tagsOf("<a/"), "+a/");
    EXPECT_EQ(tagsOf("<!--"), "");
}

TEST(XmlTags, TellTheirAttributes) {
    forEachXmlTag("<a b = \"1\" cb='x=\"2\"' d e='' f='3", [](const XmlTag& tag) {
        EXPECT_EQ(tag.attribute("b"), "1");
        EXPECT_EQ(tag.attribute("cb"), "x=\"2\"");
        EXPECT_EQ(tag.attribute("x"), std::nullopt);
        EXPECT_EQ(tag.attribute("f"), "3");
        EXPECT_EQ(tag.attribute("g"), std::nullopt);
    });
}

}  // namespace
}  // namespace bandvox
