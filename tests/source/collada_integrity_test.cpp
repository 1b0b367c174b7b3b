#include "source/file_integrity.h"

#include <bandvox/core/error.h>

#include <gtest/gtest.h>

#include <string>

namespace bandvox {
namespace {

/// A triangle, with a few of its words replaced.
std::string triangle(const std::string& word = "", const std::string& by = "") {
    std::string text =
        R"(<COLLADA version="1.4.1"><library_geometries><geometry id="g"><mesh><source id="p">)"
        R"(<float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>)"
        R"(<accessor source="#a" count="3" stride="3"/></technique_common></source><vertices )"
        R"(id="v"><input semantic="POSITION" source="#p"/></vertices><polylist count="1"><input )"
        R"(semantic="VERTEX" source="#v" offset="0"/><vcount>3</vcount><p>0 1 2</p></polylist>)"
        R"(</mesh></geometry></library_geometries></COLLADA>)";
    if (!word.empty()) text.replace(text.find(word), word.size(), by);
    return text;
}

std::string messageOf(const std::string& text) {
    try {
        checkCollada({"a.dae", text});
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Input);
        return error.what();
    }
    return "";
}

TEST(ColladaIntegrity, HonestFilesPass) {
    EXPECT_EQ(messageOf(triangle()), "");
    EXPECT_EQ(messageOf(triangle("0 1 2", " +0\n1\t-2 ")), "");
    EXPECT_EQ(messageOf(triangle("<p>0 1 2</p>", "<p/>")), "");
    EXPECT_EQ(messageOf(triangle(R"(count="3")", R"(offset="3" count="2")")), "");
    EXPECT_EQ(messageOf(triangle("<p>", R"(<extra count="many"/><p>)")), "");
}

TEST(ColladaIntegrity, ListsHoldWholeNumbers) {
    // The importer would read on at each of these, without end.
    for (const char* list :
         {"0 1 2e308", "nan", "0 1.5 2", "x", "0 &#49; 2", "<!-- --> 0 1 2", "<![CDATA[0 1 2]]>"}) {
        EXPECT_NE(messageOf(triangle("0 1 2", list)).find("whole numbers"), std::string::npos)
            << list << ": " << messageOf(triangle("0 1 2", list));
    }
    EXPECT_NE(messageOf(triangle("<vcount>3", "<vcount>x")), "");
}

TEST(ColladaIntegrity, AccessorsStayWithinTheirArray) {
    EXPECT_NE(messageOf(triangle(R"(count="3")", R"(count="4")")).find("up to 12"),
              std::string::npos);
    EXPECT_NE(messageOf(triangle(R"(count="3")", R"(offset="1" count="3")")), "");
    EXPECT_NE(messageOf(triangle(R"(stride="3")", R"(stride="4")")), "");
    EXPECT_NE(messageOf(triangle(R"(count="9")", R"(cnuot="9")")), "");
}

TEST(ColladaIntegrity, CountsAreNoMoreThanTheFileHasBytes) {
    for (const char* count : {"-1", "2147483648", "18446744073709551616", "1e3", "", "nan"}) {
        const std::string attribute = std::string("count=\"") + count + "\"";
        EXPECT_NE(messageOf(triangle(R"(count="1")", attribute)).find("whole number"),
                  std::string::npos)
            << count;
    }
    EXPECT_NE(messageOf(triangle(R"(offset="0")", R"(offset="99999")")), "");
}

}  // namespace
}  // namespace bandvox
