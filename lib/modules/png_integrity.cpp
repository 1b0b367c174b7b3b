// "Portable Network Graphics (PNG) Specification", W3C, section 5.
#include "png_integrity.h"

#include <bandvox/core/error.h>

#include <array>
#include <cctype>
#include <cstdint>
#include <string>
#include <string_view>

namespace bandvox {

namespace {

constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";

}  // namespace

bool isPng(std::istream& stream) {
    std::array<char, kSignature.size()> start{};
    stream.read(start.data(), start.size());
    const bool isWhole = static_cast<bool>(stream);
    stream.clear();
    stream.seekg(0);
    return isWhole && std::string_view(start.data(), start.size()) == kSignature;
}

void requireSoundPng(std::istream& stream, double length) {
    constexpr std::size_t kFrame = 12;  // bytes of length and kind before a chunk, and a sum behind
    constexpr std::size_t kBefore = 8;
    double left = length - double(kSignature.size());
    stream.seekg(kSignature.size());
    while (true) {
        std::array<unsigned char, kBefore> head{};
        stream.read(reinterpret_cast<char*>(head.data()), head.size());
        if (!stream) throw Error(ErrorKind::Input, "it is cut short");
        std::uint32_t size = 0;
        for (std::size_t i = 0; i < 4; ++i) size = size << 8 | head[i];
        std::string kind;
        for (std::size_t i = 4; i < kBefore; ++i) {
            kind += std::isalpha(head[i]) != 0 ? static_cast<char>(head[i]) : '?';
        }
        if (double(size) + kFrame > left) {
            std::string what = "its part " + kind + " tells of " + std::to_string(size);
            what += " bytes, and " + std::to_string(static_cast<long long>(left - kBefore));
            what += " follow; it is damaged, or cut short";
            throw Error(ErrorKind::Input, what);
        }
        if (kind == "IEND") return;
        left -= double(size) + kFrame;
        stream.seekg(std::streamoff(size) + std::streamoff(kFrame - kBefore), std::ios::cur);
    }
}

}  // namespace bandvox
