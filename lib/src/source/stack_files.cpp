#include "source/stack_files.h"

#include "core/letter_case.h"
#include "core/number_pattern.h"
#include "core/words.h"
#include "source/array_header.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <fstream>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

namespace bandvox {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 1 << 20;
constexpr std::size_t kMostNamed = 5;  // in a message

// Kinds of images, and all the extensions of each.
constexpr std::array<std::string_view, 24> kImageExtensions{
    ".tif", ".tiff", ".png", ".exr",  ".bmp", ".jpg", ".jpeg", ".jp2",
    ".j2k", ".pgm",  ".ppm", ".pnm",  ".pbm", ".pfm", ".dpx",  ".tga",
    ".psd", ".webp", ".sgi", ".fits", ".cin", ".iff", ".ico",  ".hdr"};

// One name for all extensions of a kind; empty if it is no image's.
std::string imageKind(const fs::path& path) {
    std::string extension = lowerExtension(path);
    if (std::find(kImageExtensions.begin(), kImageExtensions.end(), extension) ==
        kImageExtensions.end()) {
        return {};
    }
    if (extension == ".tiff") return ".tif";
    if (extension == ".jpeg") return ".jpg";
    return extension;
}

bool hasDicomName(const fs::path& path) {
    const std::string extension = lowerExtension(path);
    return extension == ".dcm" || extension == ".dicom" || extension == ".ima";
}

// Of the content: four letters after 128 bytes that mean nothing.
bool hasDicomStart(const fs::path& path) {
    constexpr std::size_t kStart = 128;
    std::array<char, kStart + 4> bytes{};
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) return false;
    std::ifstream stream(path, std::ios::binary);
    return stream.read(bytes.data(), bytes.size()) && std::string_view(&bytes[kStart], 4) == "DICM";
}

// Some of the names, and how many more there are.
std::string someOf(const std::vector<fs::path>& paths) {
    std::string text;
    for (std::size_t i = 0; i < std::min(paths.size(), kMostNamed); ++i) {
        if (i > 0) text += ", ";
        text += paths[i].filename().string();
    }
    if (paths.size() > kMostNamed) {
        text += " and " + std::to_string(paths.size() - kMostNamed) + " more";
    }
    return text;
}

// A name in parts: texts, and the numbers between them.
struct NameParts {
    std::string skeleton;              // with '#' for each number
    std::vector<std::string> numbers;  // as they are written
};

NameParts partsOf(const fs::path& path) {
    NameParts parts;
    std::string digits;
    for (const char c : path.stem().string()) {
        if (std::isdigit(static_cast<unsigned char>(c)) != 0) {
            digits += c;
            continue;
        }
        if (!digits.empty()) {
            parts.numbers.push_back(std::exchange(digits, {}));
            parts.skeleton += '#';
        }
        parts.skeleton += c;
    }
    if (!digits.empty()) {
        parts.numbers.push_back(digits);
        parts.skeleton += '#';
    }
    return parts;
}

// Compares numbers of any length.
bool isLess(const std::string& a, const std::string& b) {
    const auto bare = [](const std::string& text) {
        return text.substr(std::min(text.find_first_not_of('0'), text.size()));
    };
    const std::string first = bare(a), second = bare(b);
    return first.size() != second.size() ? first.size() < second.size() : first < second;
}

// In steps that are all alike the numbers leave none out.
void requireNoGap(const fs::path& name, const std::vector<fs::path>& files,
                  const std::vector<long long>& numbers, std::vector<std::string>& notes) {
    long long step = 0;
    for (std::size_t i = 1; i < numbers.size(); ++i) {
        const long long here = numbers[i] - numbers[i - 1];
        if (here == 0) {
            failArray(name, "its files " + files[i - 1].filename().string() + " and " +
                                files[i].filename().string() +
                                " have the same number; expected different ones");
        }
        step = step == 0 ? here : std::min(step, here);
    }
    std::string missing;
    std::size_t count = 0;
    for (std::size_t i = 1; i < numbers.size(); ++i) {
        for (long long at = numbers[i - 1] + step; at < numbers[i]; at += step) {
            if (count > 0 && count < kMostNamed) missing += ", ";
            if (++count <= kMostNamed) missing += std::to_string(at);
            if (count > kMostFiles) break;
        }
    }
    if (count > 0) {
        if (count > kMostNamed) missing += " and more";
        failArray(name, "of the slices " + files.front().filename().string() + " to " +
                            files.back().filename().string() +
                            (count == 1 ? " that with the number " : " those with the numbers ") +
                            missing + (count == 1 ? " is missing" : " are missing"));
    }
    if (step > 1) notes.push_back("the numbers of slices go in steps of " + std::to_string(step));
}

std::optional<long long> wholeNumber(const std::string& text) {
    long long number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

// Brings files of a folder into the order of the numbers in their names.
void sortByNumbers(const fs::path& name, StackFiles& stack) {
    std::vector<fs::path>& files = stack.files;
    std::map<std::string, std::vector<fs::path>> bySkeleton;
    for (const fs::path& file : files) bySkeleton[partsOf(file).skeleton].push_back(file);
    if (bySkeleton.size() > 1) {
        std::string found;
        for (const auto& [skeleton, alike] : bySkeleton) {
            if (!found.empty()) found += "; ";
            found += someOf(alike);
        }
        failArray(name, "the names of its images are no sequence (" + found.substr(0, 400) +
                            "); expected names that differ by numbers, or a pattern as "
                            "slice.####.tif in place of the folder");
    }
    const auto numbersOf = [](const fs::path& file) { return partsOf(file).numbers; };
    std::vector<std::pair<std::vector<std::string>, fs::path>> keyed;
    keyed.reserve(files.size());
    for (const fs::path& file : files) keyed.emplace_back(numbersOf(file), file);
    std::sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) {
        for (std::size_t i = 0; i < a.first.size(); ++i) {
            if (isLess(a.first[i], b.first[i])) return true;
            if (isLess(b.first[i], a.first[i])) return false;
        }
        return a.second < b.second;
    });
    for (std::size_t i = 0; i < files.size(); ++i) files[i] = keyed[i].second;
    if (files.size() < 2) return;

    // Where one number alone differs, none may be left out.
    std::vector<std::size_t> differing;
    for (std::size_t part = 0; part < keyed.front().first.size(); ++part) {
        const auto differs = [&](const auto& other) {
            return isLess(other.first[part], keyed.front().first[part]) ||
                   isLess(keyed.front().first[part], other.first[part]);
        };
        if (std::any_of(keyed.begin(), keyed.end(), differs)) differing.push_back(part);
    }
    if (differing.size() > 1) {
        stack.notes.push_back(
            "several numbers differ in the names of slices, so that none can be missed");
        return;
    }
    std::vector<long long> numbers;
    for (const auto& [parts, file] : keyed) {
        const auto number = wholeNumber(differing.empty() ? "0" : parts[differing.front()]);
        if (!number) return;
        numbers.push_back(*number);
    }
    requireNoGap(name, files, numbers, stack.notes);
}

// What is in a folder, by kind.
struct FolderContent {
    std::map<std::string, std::vector<fs::path>> images;
    std::vector<fs::path> dicom, others;
};

FolderContent listFolder(const fs::path& folder) {
    FolderContent content;
    std::error_code error;
    fs::directory_iterator entries(folder, error);
    std::size_t count = 0;
    for (; !error && entries != fs::directory_iterator(); entries.increment(error)) {
        const fs::path& path = entries->path();
        if (++count > kMostFiles) failArray(folder, "it has more than 2^20 files; expected fewer");
        std::error_code ignored;
        const bool isTaken =
            !path.filename().string().starts_with('.') && fs::is_regular_file(path, ignored);
        const std::string kind = isTaken ? imageKind(path) : "";
        if (!kind.empty()) {
            content.images[kind].push_back(path);
        } else if (isTaken && (hasDicomName(path) || hasDicomStart(path))) {
            content.dicom.push_back(path);
        } else {
            content.others.push_back(path);
        }
    }
    if (error) failArray(folder, "it cannot be listed: " + error.message());
    std::sort(content.others.begin(), content.others.end());
    std::sort(content.dicom.begin(), content.dicom.end());
    return content;
}

StackFiles findInFolder(const fs::path& folder) {
    FolderContent content = listFolder(folder);
    StackFiles stack;
    stack.name = folder;
    if (content.images.size() + (content.dicom.empty() ? 0 : 1) > 1) {
        std::string found;
        for (const auto& [kind, files] : content.images) {
            if (!found.empty()) found += ", ";
            found += std::to_string(files.size());
            found += " " + kind;
        }
        if (!content.dicom.empty()) {
            found += ", " + std::to_string(content.dicom.size()) + " of DICOM";
        }
        failArray(folder, "it is a folder of images of several kinds (" + found +
                              "); expected one kind, or a pattern as slice.####.tif");
    }
    if (!content.others.empty()) {
        stack.notes.push_back(counted(content.others.size(), "entry of the folder was",
                                      "entries of the folder were") +
                              " left out: " + someOf(content.others));
    }
    if (!content.dicom.empty()) {
        stack.kind = StackFiles::Kind::Dicom;
        stack.files = std::move(content.dicom);
        return stack;
    }
    if (content.images.empty()) {
        failArray(folder,
                  "it is a folder without images; expected images of slices, or DICOM files");
    }
    stack.files = std::move(content.images.begin()->second);
    sortByNumbers(folder, stack);
    return stack;
}

StackFiles findByPattern(const fs::path& name, const NumberPattern& pattern) {
    StackFiles stack;
    stack.name = name;
    if (imageKind(name).empty()) stack.kind = StackFiles::Kind::Dicom;
    std::vector<int> numbers;
    std::error_code error;
    fs::directory_iterator entries(pattern.folder(), error);
    const bool inFolder = pattern.before.find('/') != std::string::npos;
    for (; !error && entries != fs::directory_iterator(); entries.increment(error)) {
        const fs::path path = inFolder ? entries->path() : entries->path().filename();
        if (const auto number = pattern.numberOf(path)) numbers.push_back(*number);
    }
    if (error) failArray(name, "its folder cannot be listed: " + error.message());
    if (numbers.empty()) failArray(name, "there is no file of such a name");
    std::sort(numbers.begin(), numbers.end());
    for (const int number : numbers) stack.files.push_back(pattern.with(number));
    requireNoGap(name, stack.files, {numbers.begin(), numbers.end()}, stack.notes);
    return stack;
}

}  // namespace

bool isStack(const fs::path& path) {
    std::error_code ignored;
    return !imageKind(path).empty() || hasDicomName(path) || fs::is_directory(path, ignored) ||
           hasDicomStart(path);
}

StackFiles findStack(const fs::path& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) return findInFolder(path);
    if (const auto pattern = NumberPattern::parse(path)) return findByPattern(path, *pattern);
    StackFiles stack;
    stack.name = path;
    stack.files = {path};
    if (!fs::exists(path, ignored)) failArray(path, "there is no such file");
    if (imageKind(path).empty()) {
        stack.kind = StackFiles::Kind::Dicom;
        if (!hasDicomName(path) && !hasDicomStart(path)) {
            failArray(path, "its extension is \"" + path.extension().string() +
                                "\"; expected .npy, .nrrd, .nhdr, .mha, .mhd, an image, a folder "
                                "of images or a DICOM file");
        }
    }
    return stack;
}

}  // namespace bandvox
