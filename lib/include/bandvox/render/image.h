#pragma once

#include <bandvox/core/progress.h>

#include <openvdb/Types.h>
#include <openvdb/math/Mat4.h>

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace bandvox {

class AtomicFile;

/// Something that is said of a picture. Matrices act on rows, as OpenVDB's and OpenEXR's do.
using ImageAttribute = std::variant<std::string, int, double, openvdb::math::Mat4d>;

/// Numbers of any kind, one for each pixel.
struct ImagePlane {
    std::string name;           ///< of the channel
    std::vector<float> values;  ///< [height][width]
};

/// A picture, and what was seen at each of its pixels. Rows from the top.
struct Image {
    int width = 0;
    int height = 0;
    int left = 0;                 ///< of a picture that is a part of a larger one: its place there
    int top = 0;                  ///< the same
    int fullWidth = 0;            ///< of the larger one; 0 if it is none
    int fullHeight = 0;           ///< the same
    std::vector<float> color;     ///< [height][width][4] linear R G B, A; colour times coverage
    std::vector<float> depth;     ///< [height][width] world units along the view; inf where nothing
    std::vector<float> normal;    ///< [height][width][3] world, unit; 0 where nothing
    std::vector<float> position;  ///< [height][width][3] world; 0 where nothing
    std::vector<ImagePlane> planes;  ///< what else there is; written to an .exr, as floats
    std::vector<std::pair<std::string, ImageAttribute>> metadata;
};

/// What is kept of a picture in an .exr.
struct ImageChannels {
    bool color = true;     ///< R G B A, half
    bool depth = true;     ///< Z, float
    bool normal = true;    ///< N.X N.Y N.Z, float
    bool position = true;  ///< P.X P.Y P.Z, float
};

/// Extensions that writeImage takes, lower case with the dot.
bool isImageFile(const std::filesystem::path& path);

/// Why the colour configuration that the environment variable OCIO names is not what a .png is
/// written by, which is the sRGB that is built in then: it cannot be read, or has no way there from
/// linear light. Begins with its name; empty if nothing is wrong, or if none is named.
std::string colorConfigurationFault();

/// Writes a picture, whole or not at all. `.png`: 8-bit sRGB with alpha, by OpenImageIO's colour
/// management. `.exr`: the channels that are asked for, linear; of a part of a larger picture the
/// data window, in that one's display window. Throws Error(ErrorKind::Runtime) if it cannot be
/// written, Error(ErrorKind::Usage) for another extension, or if no channel is asked for.
void writeImage(const std::filesystem::path& path, const Image& image,
                const ImageChannels& channels = {});

/// The same to a file that the caller commits. Throws Error(ErrorKind::Interrupted) besides.
void writeImage(AtomicFile& file, const Image& image, const ImageChannels& channels = {},
                Progress& progress = silentProgress());

}  // namespace bandvox
