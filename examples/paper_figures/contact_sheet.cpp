#include "contact_sheet.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>

namespace paper_figures {

using bandvox::Image;

namespace {

constexpr int kMargin = 10;         // sheet pixels between pictures
constexpr int kCaptionHeight = 24;  // sheet pixels
constexpr int kFontSize = 15;
constexpr const char* kFont = "DejaVuSans";

constexpr float kPaper = 1;        // all linear
constexpr float kGround = 0.012F;  // behind the solids
constexpr float kAmbient = 0.03F;
constexpr float kBrightest = 0.85F;

// Where one picture of a sheet goes.
struct Cell {
    int left, top, side;
};

Image blankSheet(int width, int height) {
    Image sheet;
    sheet.width = width;
    sheet.height = height;
    const std::size_t pixels = static_cast<std::size_t>(width) * height;
    sheet.color.assign(4 * pixels, kPaper);
    sheet.depth.assign(pixels, 0.0F);
    sheet.normal.assign(3 * pixels, 0.0F);
    sheet.position.assign(3 * pixels, 0.0F);
    return sheet;
}

void place(Image& sheet, const Cell& cell, const Image& picture, int magnify) {
    for (int row = 0; row < cell.side; ++row) {
        for (int column = 0; column < cell.side; ++column) {
            const std::size_t from =
                4 * (static_cast<std::size_t>(row / magnify) * picture.width + column / magnify);
            const std::size_t to =
                4 * (static_cast<std::size_t>(cell.top + row) * sheet.width + cell.left + column);
            const bool isSeen = picture.color[from + 3] > 0;
            for (int c = 0; c < 3; ++c) {
                sheet.color[to + c] =
                    isSeen ? kAmbient + (kBrightest - kAmbient) * picture.color[from + c] : kGround;
            }
        }
    }
}

void writeCaption(Image& sheet, const Cell& cell, const std::string& caption) {
    const OIIO::ImageSpec spec(sheet.width, sheet.height, 4, OIIO::TypeDesc::FLOAT);
    OIIO::ImageBuf buffer(spec, sheet.color.data());
    const std::array<float, 4> ink{0, 0, 0, 1};
    const int baseline = cell.top + cell.side + kCaptionHeight - 7;
    // Without a font there is no caption.
    OIIO::ImageBufAlgo::render_text(buffer, cell.left, baseline, caption, kFontSize, kFont, ink);
}

}  // namespace

void writeContactSheet(const std::filesystem::path& folder, const ContactSheet& sheet) {
    const int side = sheet.panels.front().image.width * sheet.magnify;
    const int count = static_cast<int>(sheet.panels.size());
    const int rows = (count + sheet.columns - 1) / sheet.columns;
    Image picture = blankSheet(kMargin + sheet.columns * (side + kMargin),
                               kMargin + rows * (side + kCaptionHeight));
    for (int i = 0; i < count; ++i) {
        const Panel& panel = sheet.panels[i];
        const Cell cell{kMargin + i % sheet.columns * (side + kMargin),
                        kMargin + i / sheet.columns * (side + kCaptionHeight), side};
        place(picture, cell, panel.image, sheet.magnify);
        writeCaption(picture, cell, panel.caption);
        bandvox::writeImage(folder / (panel.name + ".exr"), panel.image);
    }
    bandvox::writeImage(folder / (sheet.name + ".png"), picture);
}

}  // namespace paper_figures
