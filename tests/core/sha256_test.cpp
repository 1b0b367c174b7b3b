#include "core/sha256_blocks.h"

#include <bandvox/core/error.h>
#include <bandvox/core/sha256.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <vector>

namespace bandvox {
namespace {

TEST(Sha256, GivesThePublishedDigests) {
    EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(sha256(std::string(1000000, 'a')),
              "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, IsTheSameOnAnyProcessor) {
    std::mt19937 random(5);
    std::vector<unsigned char> blocks(7 * kSha256BlockBytes);
    for (unsigned char& byte : blocks) byte = static_cast<unsigned char>(random());
    for (std::size_t count = 0; count <= 7; ++count) {
        Sha256State a{1, 2, 3, 4, 5, 6, 7, 0xfedcba98}, b = a;
        addSha256Blocks(a, blocks.data(), count);
        addSha256BlocksAnywhere(b, blocks.data(), count);
        EXPECT_EQ(a, b) << count;
    }
}

TEST(Sha256, DoesNotDependOnThePieces) {
    const std::string text(1000, 'x');
    for (const std::size_t piece : {1u, 7u, 63u, 64u, 65u, 200u}) {
        Sha256 digest;
        for (std::size_t at = 0; at < text.size(); at += piece) digest.add(text.substr(at, piece));
        EXPECT_EQ(digest.finish(), sha256(text)) << piece;
    }
}

TEST(Sha256, RefusesAFileThatIsNotThere) {
    try {
        sha256OfFile("/no/such/file");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Input);
    }
    EXPECT_THROW(sha256OfFile(std::filesystem::temp_directory_path()), Error);
}

}  // namespace
}  // namespace bandvox
