#pragma once

#include <bandvox/render/image.h>

#include <filesystem>
#include <string>
#include <vector>

namespace paper_figures {

/// One of the pictures on a sheet.
struct Panel {
    std::string name;     ///< of its file
    std::string caption;  ///< one line below it
    bandvox::Image image;
};

/// Pictures of one size side by side, row by row.
struct ContactSheet {
    std::string name;  ///< of its file
    int columns = 1;   ///< in a row
    int magnify = 1;   ///< sheet pixels along the side of one of the pictures'
    std::vector<Panel> panels;
};

/// Writes NAME.png with all pictures, a little ambient light added, and one .exr for each picture
/// as it is. Captions are left out where no font is installed.
void writeContactSheet(const std::filesystem::path& folder, const ContactSheet& sheet);

}  // namespace paper_figures
