#pragma once

#include "core/dicom_files.h"
#include "core/slice_files.h"

#include <filesystem>
#include <memory>

// The parts of the module, as ImageLibrary describes them.
namespace bandvox {

std::unique_ptr<SliceFile> openSliceFile(const std::filesystem::path& path, int threads);
std::unique_ptr<SliceOutput> createSliceFile(const std::filesystem::path& path,
                                             const SliceOutputInfo& info);
std::unique_ptr<DicomFile> openDicomFile(const std::filesystem::path& path);

}  // namespace bandvox
