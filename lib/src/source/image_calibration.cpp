#include "source/image_calibration.h"

#include <charconv>
#include <cmath>
#include <map>
#include <sstream>

namespace bandvox {

namespace {

// Stands for a unit that has no name.
constexpr const char* kNoName = "unit";

std::map<std::string, std::string> settingsOf(const std::string& description) {
    std::map<std::string, std::string> settings;
    std::istringstream lines(description);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t equals = line.find('=');
        if (equals == std::string::npos) continue;
        while (!line.empty() && (line.back() == '\r' || line.back() == '\0')) line.pop_back();
        settings[line.substr(0, equals)] = line.substr(equals + 1);
    }
    return settings;
}

double numberIn(const std::map<std::string, std::string>& settings, const std::string& name) {
    const auto found = settings.find(name);
    double number = 1;
    if (found == settings.end()) return number;
    const char* const end = found->second.data() + found->second.size();
    const auto [stop, error] = std::from_chars(found->second.data(), end, number);
    return error == std::errc() && number > 0 && std::isfinite(number) ? number : 1;
}

int countIn(const std::map<std::string, std::string>& settings, const std::string& name) {
    const double number = numberIn(settings, name);
    return number <= 1 << 20 ? static_cast<int>(number) : 1 << 20;
}

// Its own ways to write the letter µ.
std::string plainUnit(const std::string& unit) {
    constexpr const char* kCoded = "\\u00B5m";
    return unit == kCoded || unit == "um" || unit == "\xC2\xB5m" || unit == "\xB5m" ? "micron"
                                                                                    : unit;
}

}  // namespace

std::optional<ImageCalibration> readCalibration(const SliceFileInfo& info) {
    if (!info.description.starts_with("ImageJ=")) return std::nullopt;
    const auto settings = settingsOf(info.description);
    ImageCalibration calibration;
    calibration.images = countIn(settings, "images");
    calibration.channels = countIn(settings, "channels");
    calibration.frames = countIn(settings, "frames");
    const auto unit = settings.find("unit");
    // Without a unit, or in pixels, it knows nothing of the world.
    if (unit == settings.end() || unit->second == "pixel" || unit->second == "pixels") {
        return calibration;
    }
    calibration.hasSpacing = true;
    if (unit->second != kNoName) calibration.unit = plainUnit(unit->second);
    for (int axis = 0; axis < 2; ++axis) {
        const double resolution = info.resolution[static_cast<std::size_t>(axis)];
        if (resolution > 0 && std::isfinite(resolution)) calibration.spacing[axis] = 1 / resolution;
    }
    calibration.spacing[2] = numberIn(settings, "spacing");
    return calibration;
}

std::string calibrationText(int images, double sliceStep, const std::string& unit) {
    char step[32];
    const auto end = std::to_chars(step, step + sizeof step, sliceStep).ptr;
    std::string text = "ImageJ=1.53\nimages=" + std::to_string(images);
    text += "\nslices=" + std::to_string(images);
    text += "\nunit=" + (unit.empty() ? std::string(kNoName) : unit);
    text += "\nspacing=" + std::string(step, end);
    return text + "\nloop=false\n";
}

}  // namespace bandvox
