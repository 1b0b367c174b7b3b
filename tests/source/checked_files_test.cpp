#include "source/checked_files.h"

#include <bandvox/core/error.h>

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace bandvox {
namespace {

using namespace std::string_literals;

void check(const std::string& bytes) {
    checkMaterials({"a.mtl", bytes});
}

TEST(CheckedFiles, TexturesBelongToAMaterial) {
    EXPECT_NO_THROW(check(""));
    EXPECT_NO_THROW(check("# red\n\nnewmtl red\nKd 1 0 0\nmap_Kd a.png\nbump b.png\n"));
    EXPECT_NO_THROW(check("Kd 1 0 0\nillum 2\nd 1\nNs 3\nnewmtl red\nnorm a.png"));
    // Indented, it is no statement to the importer.
    EXPECT_NO_THROW(check("  map_Kd a.png\n"));
    for (const std::string& bytes :
         {"map_Kd a.png\n"s, "Map_Kd a.png\n"s, "bump a.png\nnewmtl red\n"s, "Kd 1 1 1\ndisp a"s,
          "# red\\\nnorm a.png"s, "a\rrefl a"s, "a\fmap_Ka a"s, "a\0map_Ka a"s,
          "NEWMTL red\nmap_Kd a"s, "aniso 0.5\n"s, "\0K\0a"s, "a"s}) {
        EXPECT_THROW(check(bytes), Error) << bytes;
    }
}

TEST(CheckedFiles, OnlyRegularFilesAreOpened) {
    CheckedFiles files("a.ply", false);
    EXPECT_THROW(files.Open("/dev/zero", "rb"), Error);
    EXPECT_THROW(files.Open("/", "rb"), Error);
    EXPECT_EQ(files.Open("/there/is/no/such/file", "rb"), nullptr);
}

}  // namespace
}  // namespace bandvox
