#include "source/dicom_places.h"

#include "core/words.h"
#include "source/array_header.h"

#include <algorithm>
#include <array>
#include <cmath>

// The image plane, PS3.3 of the DICOM standard, section C.7.6.2.
namespace bandvox {

namespace {

using openvdb::Vec3d;

// How far numbers may be from what they should be: places relative to the step from slice to
// slice, directions and spacings to themselves. Files carry a few digits only.
constexpr double kPlaceTolerance = 0.01;
constexpr double kTurnTolerance = 1e-4;

Vec3d vectorOf(const std::array<double, 3>& numbers) {
    return {numbers[0], numbers[1], numbers[2]};
}

Vec3d positionOf(const DicomSlice& slice) {
    return vectorOf(*slice.place.position);
}

std::string placeInWords(const Vec3d& place) {
    std::string text;
    for (int axis = 0; axis < 3; ++axis) {
        char number[32];
        std::snprintf(number, sizeof number, "%.6g", place[axis]);
        text += axis == 0 ? "(" : ", ";
        text += number;
    }
    return text + ")";
}

template <std::size_t Count>
std::string listInWords(const std::array<double, Count>& numbers) {
    std::string text;
    for (const double number : numbers) {
        char word[32];
        std::snprintf(word, sizeof word, "%.6g", number);
        if (!text.empty()) text += '\\';
        text += word;
    }
    return text;
}

void requireComplete(const DicomSlice& slice) {
    const DicomFrame& place = slice.place;
    const char* missing = !place.position      ? "ImagePositionPatient"
                          : !place.orientation ? "ImageOrientationPatient"
                          : !place.spacing     ? "PixelSpacing"
                                               : nullptr;
    if (missing) {
        failArray(slice.name(),
                  std::string("it has no ") + missing + ", so that it is not known where it lies");
    }
    const auto& axes = *place.orientation;
    const Vec3d row(axes[0], axes[1], axes[2]), column(axes[3], axes[4], axes[5]);
    if (std::abs(row.length() - 1) > 1e-3 || std::abs(column.length() - 1) > 1e-3 ||
        std::abs(row.dot(column)) > 1e-3) {
        failArray(slice.name(), "its ImageOrientationPatient is " + listInWords(axes) +
                                    "; expected two directions at a right angle");
    }
    for (const double spacing : *place.spacing) {
        if (spacing > 0) continue;
        failArray(slice.name(),
                  "its PixelSpacing is " + listInWords(*place.spacing) + "; expected it above 0");
    }
}

template <std::size_t Count>
void requireEqual(const DicomSlice& slice, const DicomSlice& first, const char* what,
                  const std::array<double, Count>& found,
                  const std::array<double, Count>& expected) {
    for (std::size_t i = 0; i < Count; ++i) {
        if (std::abs(found[i] - expected[i]) <= kTurnTolerance) continue;
        failArray(slice.name(), std::string("its ") + what + " is " + listInWords(found) +
                                    ", and that of " + first.name() + " " + listInWords(expected) +
                                    "; expected the same");
    }
}

// Throws unless all slices are one step after the other, none left out and none twice.
void requireEvenSteps(const std::vector<DicomSlice>& slices, const Vec3d& normal) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < slices.size(); ++i) {
        steps.push_back((positionOf(slices[i]) - positionOf(slices[i - 1])).dot(normal));
    }
    std::vector<double> sorted = steps;
    std::sort(sorted.begin(), sorted.end());
    const double usual = sorted[sorted.size() / 2];
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const DicomSlice& before = slices[i];
        const DicomSlice& after = slices[i + 1];
        if (steps[i] <= kPlaceTolerance * std::max(usual, 1e-3)) {
            failArray(after.name(), "it lies where " + before.name() + " does, at " +
                                        placeInWords(positionOf(after)) +
                                        "; expected one slice at a place");
        }
        if (std::abs(steps[i] - usual) <= kPlaceTolerance * usual) continue;
        const double times = std::round(steps[i] / usual);
        const bool isGap =
            times >= 2 && std::abs(steps[i] - times * usual) <= times * kPlaceTolerance * usual;
        std::string message = "it lies " + inShort(steps[i]) + " mm after " + before.name();
        message += ", and most slices " + inShort(usual) + " mm after the one before";
        failArray(after.name(),
                  message + (isGap ? "; " + counted(static_cast<std::size_t>(times) - 1,
                                                    "slice is missing", "slices are missing")
                                   : "; expected even steps"));
    }
    // And on one line.
    const Vec3d first = positionOf(slices.front());
    const Vec3d step = (positionOf(slices.back()) - first) / double(slices.size() - 1);
    for (std::size_t i = 1; i < slices.size(); ++i) {
        const Vec3d expected = first + double(i) * step;
        const double distance = (positionOf(slices[i]) - expected).length();
        if (distance <= kPlaceTolerance * step.length() + 1e-3) continue;
        failArray(slices[i].name(), "it lies at " + placeInWords(positionOf(slices[i])) + ", " +
                                        inShort(distance) + " mm from " + placeInWords(expected) +
                                        ", where even steps from the first slice to the last "
                                        "would have it");
    }
}

}  // namespace

std::string DicomSlice::name() const {
    return file.string() + (frames > 1 ? ", frame " + std::to_string(frame) : std::string());
}

openvdb::Mat4d orderByPlace(std::vector<DicomSlice>& slices, double step) {
    for (const DicomSlice& slice : slices) {
        requireComplete(slice);
        requireEqual(slice, slices.front(), "ImageOrientationPatient", *slice.place.orientation,
                     *slices.front().place.orientation);
        requireEqual(slice, slices.front(), "PixelSpacing", *slice.place.spacing,
                     *slices.front().place.spacing);
    }
    const std::array<double, 6> axes = *slices.front().place.orientation;
    const std::array<double, 2> spacing = *slices.front().place.spacing;
    const Vec3d row(axes[0], axes[1], axes[2]), column(axes[3], axes[4], axes[5]);
    const Vec3d normal = row.cross(column).unit();
    std::stable_sort(slices.begin(), slices.end(), [&](const DicomSlice& a, const DicomSlice& b) {
        return positionOf(a).dot(normal) < positionOf(b).dot(normal);
    });
    Vec3d across = normal * (step > 0 ? step : 1.0);
    if (slices.size() > 1) {
        requireEvenSteps(slices, normal);
        across =
            (positionOf(slices.back()) - positionOf(slices.front())) / double(slices.size() - 1);
    }
    // Rows lie as far apart as the first number says, columns as the second.
    const std::array<Vec3d, 4> rows{row * spacing[1], column * spacing[0], across,
                                    positionOf(slices.front())};
    openvdb::Mat4d matrix = openvdb::Mat4d::identity();
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 3; ++j) matrix(i, j) = rows[static_cast<std::size_t>(i)][j];
    }
    return matrix;
}

}  // namespace bandvox
