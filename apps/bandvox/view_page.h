#pragma once

#include <bandvox/core/progress.h>
#include <bandvox/grid/volume_summary.h>

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace bandvox::app {

/// Samples along the longest side of what a page shows.
constexpr int kViewSize = 160;
constexpr int kLeastViewSize = 16;
constexpr int kMostViewSize = 512;

/// What a page shows of a grid.
struct ViewPage {
    std::string title;  ///< any bytes
    std::string file;   ///< name of the file that the grid is from; any bytes
    openvdb::FloatGrid::ConstPtr grid;
    double iso = 0.5;
    VolumeTexture texture;
    ValueHistogram histogram;
    RadialSpectrum spectrum;
};

/// The iso-value that a grid is shown with: `asked`, else what it says of itself, else 0 of a level
/// set, else 0.5, or the middle of the texture's values if they do not reach that.
double viewIso(const openvdb::FloatGrid& grid, const std::optional<double>& asked,
               const VolumeTexture& texture);

/// Fills in all of a page but its words and its grid, of which the rest is made. `asked`: the
/// iso-value; `size`: samples along the longest side, kLeastViewSize to kMostViewSize.
void summarizeGrid(ViewPage& page, const std::optional<double>& asked, int size,
                   Progress& progress);

/// What a user should know of a page, in words.
std::vector<std::string> doubtsAbout(const ViewPage& page);

/// What the page says in words and numbers. Keys: version, title, file, iso, inside ("above" or
/// "below" the iso-value), background, texture {size, low, high, spacing, first (index
/// space), center (world), steps (world vectors from a sample to the next along x, y and z),
/// linear, not_finite}, histogram {low, high, active, inactive}, spectrum {block_side, blocks,
/// power}, grid (what gridReport says).
nlohmann::ordered_json viewHeader(const ViewPage& page);

/// The texture's values as (v - low) / (high - low), 16-bit floats: first the low bytes of all of
/// them, then the high ones, deflated (zlib).
std::string viewTexture(const VolumeTexture& texture, const Progress& progress);

/// The whole page, HTML that needs nothing beside it. Whatever the strings hold, none of it is
/// taken for HTML or for a script.
std::string viewHtml(const ViewPage& page, const Progress& progress);

}  // namespace bandvox::app
