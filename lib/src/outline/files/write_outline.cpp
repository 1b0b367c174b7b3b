#include "core/letter_case.h"

#include <bandvox/core/error.h>
#include <bandvox/outline/write_outline.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace bandvox {
namespace {

using OutlineWriter = void (*)(AtomicFile&, const Outline&, const StrokeOptions&);

// In the order of their extensions.
constexpr std::array<OutlineWriter, 4> kOutlineWriters{writeSvg, writePdf, writeEps, writeDxf};

}  // namespace

const std::vector<std::string>& outlineExtensions() {
    static const std::vector<std::string> extensions{".svg", ".pdf", ".eps", ".dxf"};
    return extensions;
}

void writeOutline(AtomicFile& file, const Outline& outline, const StrokeOptions& options) {
    const auto& known = outlineExtensions();
    const auto found = std::find(known.begin(), known.end(), lowerExtension(file.target()));
    if (found == known.end()) {
        throw Error(ErrorKind::Usage, "cannot write a drawing as \"" + file.target().string() +
                                          "\"; expected .svg, .pdf, .eps or .dxf");
    }
    kOutlineWriters[static_cast<std::size_t>(found - known.begin())](file, outline, options);
}

}  // namespace bandvox
