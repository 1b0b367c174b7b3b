#include "source/checked_files.h"

#include <bandvox/core/error.h>

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
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
    EXPECT_NO_THROW(check("# red\n  newmtl red\n\tmap_Kd a.png\n"));
    // Indented, the first line is no statement to the importer.
    EXPECT_NO_THROW(check("  map_Kd a.png\n"));
    for (const std::string& bytes :
         {"map_Kd a.png\n"s, "Map_Kd a.png\n"s, "bump a.png\nnewmtl red\n"s, "Kd 1 1 1\ndisp a"s,
          "# red\\\nnorm a.png"s, "a\rrefl a"s, "a\fmap_Ka a"s, "a\0map_Ka a"s,
          "NEWMTL red\nmap_Kd a"s, "aniso 0.5\n"s, "\0K\0a"s, "a"s, "Kd 1 1 1\n  map_Kd a.png\n"s,
          "\n\tdisp a"s, " newmtl red\nmap_Kd a.png"s}) {
        EXPECT_THROW(check(bytes), Error) << bytes;
    }
}

TEST(CheckedFiles, MaterialsThatEndTheImporterAreFound) {
    const auto path = std::filesystem::temp_directory_path() /
                      ("bandvox-materials-" + std::to_string(getpid()) + ".mtl");
    const auto isRefused = [&path](const std::string& bytes) {
        std::ofstream(path, std::ios::binary) << bytes;
        try {
            tryMaterials({path, bytes});
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos);
            return true;
        }
        return false;
    };
    EXPECT_FALSE(isRefused("newmtl red\nKd 1 0 0\nmap_Kd a.png\n"));
    EXPECT_TRUE(isRefused("# no material\n  map_Kd a.png\n# and a line that is left\n"));
    std::filesystem::remove(path);
}

TEST(CheckedFiles, OnlyRegularFilesAreOpened) {
    CheckedFiles files("a.ply", false);
    EXPECT_THROW(files.Open("/dev/zero", "rb"), Error);
    EXPECT_THROW(files.Open("/", "rb"), Error);
    EXPECT_EQ(files.Open("/there/is/no/such/file", "rb"), nullptr);
}

}  // namespace
}  // namespace bandvox
