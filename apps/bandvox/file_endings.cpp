#include "file_endings.h"

#include <bandvox/mesh/write_mesh.h>
#include <bandvox/source/point_cloud.h>
#include <bandvox/source/read_mesh.h>
#include <bandvox/source/read_patches.h>
#include <bandvox/source/shapes.h>

namespace bandvox::app {
namespace {

const std::vector<std::string> kArrayEndings{".npy", ".nrrd", ".nhdr", ".mha", ".mhd"};

void appendEndings(std::vector<std::string>& list, const std::vector<std::string>& more) {
    list.insert(list.end(), more.begin(), more.end());
}

}  // namespace

std::vector<std::string> vdbAndMeshEndings() {
    std::vector<std::string> endings{".vdb"};
    appendEndings(endings, meshExtensions());
    return endings;
}

std::vector<std::string> convertibleEndings() {
    std::vector<std::string> endings = vdbAndMeshEndings();
    endings.emplace_back(".bpt");
    appendEndings(endings, cadExtensions());
    appendEndings(endings, pointCloudExtensions());
    appendEndings(endings, kArrayEndings);
    appendEndings(endings, {".tif", ".tiff", ".png", ".exr", ".dcm"});
    return endings;
}

std::vector<std::string> convertedEndings() {
    std::vector<std::string> endings{".vdb", ".usda"};
    appendEndings(endings, writableMeshExtensions());
    appendEndings(endings, kArrayEndings);
    appendEndings(endings, {".tif", ".png", ".exr"});
    return endings;
}

std::vector<std::string> shapeWords() {
    std::vector<std::string> words;
    for (const std::string& name : shapeNames()) words.push_back("shape:" + name);
    return words;
}

}  // namespace bandvox::app
