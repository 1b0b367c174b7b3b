#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bandvox {

/// The files of a stack.
struct StackFiles {
    enum class Kind { Images, Dicom };
    std::filesystem::path name;  ///< as it was given
    Kind kind = Kind::Images;
    std::vector<std::filesystem::path> files;  ///< images in order; DICOM files as they come
    std::vector<std::string> notes;            ///< what was left out
};

/// True for an image, a pattern of images, a folder that is there, and a DICOM file.
bool isStack(const std::filesystem::path& path);

/// Looks the files up. Throws Error(ErrorKind::Input) if there are none, if a folder holds several
/// kinds or names that are no sequence, and if numbers are missing.
StackFiles findStack(const std::filesystem::path& path);

}  // namespace bandvox
