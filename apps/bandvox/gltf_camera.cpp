#include "gltf_camera.h"

#include "words.h"

#include <bandvox/core/error.h>

#include <nlohmann/json.hpp>
#include <openvdb/Exceptions.h>
#include <openvdb/math/Mat4.h>
#include <openvdb/math/Quat.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace bandvox::app {
namespace {

namespace fs = std::filesystem;
using openvdb::Vec3d;
using openvdb::math::Mat4d;
// Nodes under each other; more than any scene has, and what keeps a circle from going on.
constexpr int kDeepest = 256;

[[noreturn]] void fail(const std::string& file, const std::string& why) {
    throw Error(ErrorKind::Input, "'" + file + "' " + why);
}

// The description in JSON: the first chunk of a binary file, or all of a text.
std::string jsonOf(const std::string& file) {
    std::error_code ignored;
    if (fs::is_directory(file, ignored)) fail(file, "is a folder; expected a file");
    std::ifstream stream(file, std::ios::binary);
    if (!stream) fail(file, "cannot be opened for reading");
    std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    constexpr std::size_t kHeaders = 20, kLengthAt = 12;
    if (!bytes.starts_with("glTF") || bytes.size() < kHeaders) return bytes;
    std::uint32_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        length |= std::uint32_t(static_cast<unsigned char>(bytes[kLengthAt + i])) << (8 * i);
    }
    return bytes.substr(kHeaders, length);
}

Vec3d vectorOf(const nlohmann::json& node, const char* key, const Vec3d& standard) {
    if (!node.contains(key)) return standard;
    return {node.at(key).at(0), node.at(key).at(1), node.at(key).at(2)};
}

// A node's own transform, for points as columns.
Mat4d transformOf(const nlohmann::json& node) {
    Mat4d matrix = Mat4d::identity();
    if (node.contains("matrix")) {
        for (int i = 0; i < 16; ++i) matrix(i % 4, i / 4) = node.at("matrix").at(i).get<double>();
        return matrix;
    }
    double x = 0, y = 0, z = 0, w = 1;
    if (node.contains("rotation")) {
        const nlohmann::json& q = node.at("rotation");
        x = q.at(0), y = q.at(1), z = q.at(2), w = q.at(3);
    }
    const Vec3d scale = vectorOf(node, "scale", Vec3d(1.0));
    const Vec3d shift = vectorOf(node, "translation", Vec3d(0.0));
    const double rotation[3][3] = {
        {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
        {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
        {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            matrix(row, column) = rotation[row][column] * scale[column];
        }
        matrix(row, 3) = shift[row];
    }
    return matrix;
}

// A camera where a node puts it.
struct PlacedCamera {
    nlohmann::json camera;
    Mat4d transform;
};

class CameraSearch {
  public:
    CameraSearch(const nlohmann::json& scene, std::string name)
        : mScene(scene), mName(std::move(name)) {}

    std::optional<PlacedCamera> find() {
        // Nodes that no other has are where trees begin.
        const nlohmann::json nodes = mScene.value("nodes", nlohmann::json::array());
        std::vector<bool> isChild(nodes.size(), false);
        for (const nlohmann::json& node : nodes) {
            for (const nlohmann::json& child : node.value("children", nlohmann::json::array())) {
                isChild.at(child.get<std::size_t>()) = true;
            }
        }
        mVisited.assign(nodes.size(), false);
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (isChild[i]) continue;
            if (auto found = findUnder(i, Mat4d::identity(), 0)) return found;
        }
        return std::nullopt;
    }

  private:
    std::optional<PlacedCamera> findUnder(std::size_t index, const Mat4d& above, int depth) {
        // A node has one parent; what says otherwise is not followed twice.
        if (depth > kDeepest || mVisited.at(index)) return std::nullopt;
        mVisited[index] = true;
        const nlohmann::json& node = mScene.at("nodes").at(index);
        const Mat4d transform = above * transformOf(node);
        if (node.contains("camera")) {
            const nlohmann::json& camera =
                mScene.at("cameras").at(node.at("camera").get<std::size_t>());
            if (mName.empty() || node.value("name", "") == mName ||
                camera.value("name", "") == mName) {
                return PlacedCamera{camera, transform};
            }
        }
        for (const nlohmann::json& child : node.value("children", nlohmann::json::array())) {
            if (auto found = findUnder(child.get<std::size_t>(), transform, depth + 1)) {
                return found;
            }
        }
        return std::nullopt;
    }

    const nlohmann::json& mScene;
    std::string mName;
    std::vector<bool> mVisited;
};

CameraOptions optionsOf(const PlacedCamera& placed, double aspect) {
    const auto column = [&](int i) {
        return Vec3d(placed.transform(0, i), placed.transform(1, i), placed.transform(2, i));
    };
    CameraOptions options;
    options.eye = column(3);
    options.up = column(1);
    options.lookat = *options.eye - column(2).unit();  // cameras look along their -z
    if (placed.camera.at("type") == "orthographic") {
        options.projection = CameraOptions::Projection::Orthographic;
        const double halfHeight = placed.camera.at("orthographic").at("ymag");
        options.frame = 2 * halfHeight / aspect;
    } else {
        const double angle = placed.camera.at("perspective").at("yfov");
        options.focal = 0.5 * options.aperture * aspect / std::tan(0.5 * angle);
    }
    return options;
}

}  // namespace

CameraOptions readGltfCamera(const std::string& file, double aspect) {
    // A colon is a part of the name if there is such a file.
    std::string path = file, name;
    const std::size_t colon = file.rfind(':');
    if (colon != std::string::npos && !fs::exists(file)) {
        path = file.substr(0, colon);
        name = file.substr(colon + 1);
    }
    if (!fs::exists(path)) fail(path, "is not there; expected a .gltf or .glb file with a camera");
    try {
        const nlohmann::json scene = nlohmann::json::parse(jsonOf(path));
        const auto found = CameraSearch(scene, name).find();
        if (!found) {
            fail(path, name.empty() ? "has no camera that a node places"
                                    : "has no camera '" + name + "' that a node places");
        }
        return optionsOf(*found, aspect);
    } catch (const nlohmann::json::exception& error) {
        fail(path, std::string("is no glTF file whose cameras can be read (") + error.what() + ")");
    } catch (const openvdb::Exception&) {
        fail(path, "has a camera that looks nowhere: its node makes all lengths 0");
    } catch (const std::out_of_range&) {
        fail(path, "is no glTF file whose cameras can be read (a node that is not there)");
    }
}

}  // namespace bandvox::app
