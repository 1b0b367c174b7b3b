#include "mesh/mesh_checksum.h"

#include "mesh/mesh_notes.h"

#include <bandvox/core/error.h>
#include <bandvox/mesh/write_mesh.h>

#include <zlib.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace bandvox {

namespace {

constexpr std::size_t kChecksumDigits = 8;

// Where the digits begin; npos if the file says none. Other notes come before it.
std::size_t checksumPlace(std::string_view head) {
    const std::size_t mark = head.rfind(kChecksumMark);
    if (mark == std::string_view::npos) return mark;
    const std::size_t place = mark + kChecksumMark.size();
    return place + kChecksumDigits <= head.size() ? place : std::string_view::npos;
}

std::string hexDigits(std::uint32_t number) {
    std::string text(kChecksumDigits, '0');
    for (std::size_t i = 0; i < kChecksumDigits; ++i) {
        text[i] = "0123456789abcdef"[number >> (28 - 4 * i) & 15];
    }
    return text;
}

}  // namespace

std::uint32_t checksumOf(std::string_view bytes, std::uint32_t before) {
    return static_cast<std::uint32_t>(
        crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

void storeChecksum(const std::filesystem::path& path, std::uint32_t checksum) {
    const std::size_t place = checksumPlace(headOfMeshFile(path));
    // Of notes that are longer than what is looked at there is none.
    if (place == std::string::npos) return;
    errno = 0;
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(static_cast<std::streamoff>(place));
    file << hexDigits(checksum);
    file.close();
    if (file) return;
    throw Error(ErrorKind::Runtime, "cannot write " + path.string() + ": " +
                                        (errno != 0 ? std::strerror(errno) : "unknown failure"));
}

bool isAsWritten(const std::filesystem::path& path, Progress& progress) {
    const std::string head = headOfMeshFile(path);
    const std::size_t place = checksumPlace(head);
    if (place == std::string::npos) return false;
    const std::string stored = head.substr(place, kChecksumDigits);
    std::ifstream file(path, std::ios::binary);
    std::string some(std::size_t(1) << 20, '\0');
    std::uint32_t checksum = 0;
    for (bool isFirst = true; file; isFirst = false) {
        progress.throwIfInterrupted();
        file.read(some.data(), static_cast<std::streamsize>(some.size()));
        some.resize(static_cast<std::size_t>(file.gcount()));
        // The head is as long as these are.
        if (isFirst && some.size() < place + kChecksumDigits) return false;
        if (isFirst) some.replace(place, kChecksumDigits, kUnknownChecksum);
        checksum = checksumOf(some, checksum);
    }
    return hexDigits(checksum) == stored;
}

}  // namespace bandvox
