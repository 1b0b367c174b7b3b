#pragma once

#include "core/image_library.h"

#include <bandvox/core/progress.h>
#include <bandvox/render/image.h>

#include <iosfwd>

namespace bandvox {

/// Writes the channels of a complete picture as OpenEXR, to a stream that is seekable. May throw
/// Error(ErrorKind::Interrupted).
WriteFailure writeExr(std::ostream& stream, const Image& image, const ImageChannels& channels,
                      Progress& progress);

}  // namespace bandvox
