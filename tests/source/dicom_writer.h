#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace bandvox {

/// Writes DICOM files with explicit value representations, least byte first (PS3.5 and PS3.10).
class DicomWriter {
  public:
    /// Appends an element of text; elements have to come in the order of their tags.
    void text(std::uint32_t tag, const char* vr, std::string value) {
        if (value.size() % 2 != 0) value += std::string(vr) == "UI" ? '\0' : ' ';
        put(mData, tag, vr, value);
    }

    void number(std::uint32_t tag, std::uint16_t value) {
        put(mData, tag, "US",
            std::string{static_cast<char>(value & 255), static_cast<char>(value >> 8)});
    }

    /// A sequence, each item of which holds what a writer has been given.
    void sequence(std::uint32_t tag, const std::vector<DicomWriter>& items) {
        std::string all;
        for (const DicomWriter& item : items) {
            all += std::string("\xfe\xff\x00\xe0", 4);
            appendNumber(all, static_cast<std::uint32_t>(item.mData.size()), 4);
            all += item.mData;
        }
        put(mData, tag, "SQ", all);
    }

    /// The pixels, OW.
    void pixels(const std::string& bytes) { put(mData, 0x7fe00010, "OW", bytes); }

    /// The same in one fragment of an encapsulated transfer syntax.
    void fragment(std::string bytes) {
        if (bytes.size() % 2 != 0) bytes += '\0';
        appendTag(mData, 0x7fe00010);
        mData += std::string("OB\0\0\xff\xff\xff\xff", 8);
        mData += std::string("\xfe\xff\x00\xe0\0\0\0\0", 8);  // no offsets
        mData += std::string("\xfe\xff\x00\xe0", 4);
        appendNumber(mData, static_cast<std::uint32_t>(bytes.size()), 4);
        mData += bytes;
        mData += std::string("\xfe\xff\xdd\xe0\0\0\0\0", 8);
    }

    /// The whole file.
    std::string file(const std::string& transferSyntax = "1.2.840.10008.1.2.1") const {
        DicomWriter meta;
        put(meta.mData, 0x00020001, "OB", std::string("\0\1", 2));
        meta.text(0x00020002, "UI", "1.2.840.10008.5.1.4.1.1.2");
        meta.text(0x00020003, "UI", "1.2.3.4.5");
        meta.text(0x00020010, "UI", transferSyntax);
        meta.text(0x00020012, "UI", "1.2.3.4.6");
        std::string bytes(128, '\0');
        bytes += "DICM";
        std::string length;
        appendNumber(length, static_cast<std::uint32_t>(meta.mData.size()), 4);
        put(bytes, 0x00020000, "UL", length);
        return bytes + meta.mData + mData;
    }

  private:
    static void appendNumber(std::string& to, std::uint32_t number, int size) {
        for (int i = 0; i < size; ++i) to += static_cast<char>(number >> 8 * i & 255);
    }

    static void appendTag(std::string& to, std::uint32_t tag) {
        appendNumber(to, tag >> 16, 2);
        appendNumber(to, tag & 0xffff, 2);
    }

    static void put(std::string& to, std::uint32_t tag, const std::string& vr,
                    const std::string& value) {
        appendTag(to, tag);
        to += vr;
        const auto length = static_cast<std::uint32_t>(value.size());
        if (vr == "OB" || vr == "OW" || vr == "SQ") {
            appendNumber(to, 0, 2);
            appendNumber(to, length, 4);
        } else {
            appendNumber(to, length, 2);
        }
        to += value;
    }

    std::string mData;
};

/// Numbers as DICOM has them in a text, with as many digits as it takes.
inline std::string dicomNumbers(const std::vector<double>& numbers) {
    std::string text;
    for (const double number : numbers) {
        char word[32];
        std::snprintf(word, sizeof word, "%.9g", number);
        if (!text.empty()) text += '\\';
        text += word;
    }
    return text;
}

}  // namespace bandvox
