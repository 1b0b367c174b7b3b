#include "frame_pattern.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <system_error>

namespace bandvox::app {
namespace {

// Where the number goes, and how many digits it has at least.
struct Place {
    std::size_t begin = 0, length = 0;
    int digits = 0;
};

std::optional<Place> findPlace(const std::string& name) {
    // In the last part of the path only.
    const std::size_t slash = name.rfind('/');
    const std::size_t start = slash == std::string::npos ? 0 : slash + 1;
    const std::size_t hash = name.find('#', start);
    if (hash != std::string::npos) {
        const std::size_t end = std::min(name.find_first_not_of('#', hash), name.size());
        return Place{hash, end - hash, static_cast<int>(end - hash)};
    }
    for (std::size_t percent = name.find('%', start); percent != std::string::npos;
         percent = name.find('%', percent + 1)) {
        std::size_t end = percent + 1;
        while (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end])) != 0) ++end;
        if (end >= name.size() || name[end] != 'd' || end - percent > 4) continue;
        int digits = 1;
        std::from_chars(name.data() + percent + 1, name.data() + end, digits);
        return Place{percent, end + 1 - percent, digits};
    }
    return std::nullopt;
}

bool readNumber(const char*& at, const char* end, int& number) {
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc() || number < 0) return false;
    at = next;
    return true;
}

}  // namespace

std::vector<int> FrameRange::numbers() const {
    std::vector<int> all;
    for (long long frame = first; frame <= last; frame += step) {
        all.push_back(static_cast<int>(frame));
    }
    return all;
}

std::optional<FrameRange> parseFrames(const std::string& text) {
    const char* at = text.data();
    const char* const end = at + text.size();
    FrameRange range{0, 0, 1};
    if (!readNumber(at, end, range.first)) return std::nullopt;
    range.last = range.first;
    if (at != end && *at == '-') {
        if (!readNumber(++at, end, range.last)) return std::nullopt;
        if (at != end && *at == 'x' && !readNumber(++at, end, range.step)) return std::nullopt;
    }
    if (at != end || range.last < range.first || range.step < 1 || range.last > kMostFrame) {
        return std::nullopt;
    }
    return range;
}

bool hasFrame(const std::string& name) {
    std::error_code ignored;
    return findPlace(name).has_value() && !std::filesystem::exists(name, ignored);
}

std::string withFrame(const std::string& name, int frame) {
    if (!hasFrame(name)) return name;
    const auto place = findPlace(name);
    std::string number = std::to_string(frame);
    if (static_cast<int>(number.size()) < place->digits) {
        number.insert(0, static_cast<std::size_t>(place->digits) - number.size(), '0');
    }
    return name.substr(0, place->begin) + number + name.substr(place->begin + place->length);
}

std::vector<int> framesOnDisk(const std::string& name) {
    const auto place = findPlace(name);
    if (!place) return {};
    const std::filesystem::path pattern = name;
    const std::size_t start = name.size() - pattern.filename().string().size();
    const std::string before = name.substr(start, place->begin - start);
    const std::string after = name.substr(place->begin + place->length);
    const std::filesystem::path folder = pattern.has_parent_path() ? pattern.parent_path() : ".";
    std::vector<int> frames;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        const std::string found = entry.path().filename().string();
        if (found.size() <= before.size() + after.size() || !found.starts_with(before) ||
            !found.ends_with(after)) {
            continue;
        }
        const char* at = found.data() + before.size();
        const char* const end = found.data() + found.size() - after.size();
        int frame = 0;
        if (!readNumber(at, end, frame) || at != end || frame > kMostFrame) continue;
        // Of 7, 07 and 007 one is meant.
        if (withFrame(name, frame).substr(start) == found) frames.push_back(frame);
    }
    std::sort(frames.begin(), frames.end());
    return frames;
}

}  // namespace bandvox::app
