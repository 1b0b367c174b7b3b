#include "source/mesh_materials.h"

#include "core/letter_case.h"
#include "source/mesh_import.h"
#include "source/read_texture.h"
#include "source/srgb.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>

#include <assimp/material.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>
#include <utility>

namespace bandvox {
namespace {

namespace fs = std::filesystem;

// What the importer says where a file says nothing.
constexpr const char* kMadeUpMaterial = AI_DEFAULT_MATERIAL_NAME;
const aiColor3D kMadeUpColor(0.6F, 0.6F, 0.6F);

/// A file name in which %20 stands for a space, and so on.
std::string percentDecoded(const std::string& name) {
    std::string decoded;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const bool isCode = name[i] == '%' && i + 2 < name.size() &&
                            std::isxdigit(static_cast<unsigned char>(name[i + 1])) != 0 &&
                            std::isxdigit(static_cast<unsigned char>(name[i + 2])) != 0;
        if (isCode) {
            decoded += static_cast<char>(std::stoi(name.substr(i + 1, 2), nullptr, 16));
            i += 2;
        } else {
            decoded += name[i];
        }
    }
    return decoded;
}

/// Where a texture may lie: where its name says, relative to the mesh, else beside the mesh, since
/// many names are those of a folder on another machine.
fs::path findTexture(const fs::path& folder, std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');
    std::error_code ignored;
    for (const std::string& spelled : {name, percentDecoded(name)}) {
        for (const fs::path& path : {folder / spelled, folder / fs::path(spelled).filename()}) {
            if (fs::exists(path, ignored)) return path;
        }
    }
    return folder / name;
}

/// A texture that is part of the mesh file.
std::shared_ptr<const Texture> readEmbedded(const aiTexture& texture) {
    if (texture.mHeight == 0) {
        const auto* bytes = reinterpret_cast<const std::byte*>(texture.pcData);
        return readTexture({bytes, texture.mWidth}, texture.achFormatHint);
    }
    requireMemory(Texture::memory(texture.mWidth, texture.mHeight), "a texture of the mesh");
    std::vector<std::uint16_t> rgb;
    const std::size_t texels = static_cast<std::size_t>(texture.mWidth) * texture.mHeight;
    rgb.reserve(3 * texels);
    for (std::size_t i = 0; i < texels; ++i) {
        const aiTexel& texel = texture.pcData[i];
        for (const unsigned char value : {texel.r, texel.g, texel.b}) {
            rgb.push_back(
                static_cast<std::uint16_t>(std::lround(65535 * linearOfSrgb(value / 255.0))));
        }
    }
    return std::make_shared<Texture>(static_cast<int>(texture.mWidth),
                                     static_cast<int>(texture.mHeight), std::move(rgb));
}

TextureWrap wrapOf(const aiMaterial& material, const char* key, aiTextureType type) {
    int mode = aiTextureMapMode_Wrap;
    material.Get(key, type, 0, mode);
    if (mode == aiTextureMapMode_Mirror) return TextureWrap::Mirror;
    return mode == aiTextureMapMode_Wrap ? TextureWrap::Repeat : TextureWrap::Clamp;
}

/// The transform of texture coordinates, about the lower left corner, that a glTF file asks for.
/// The importer keeps it as a turn about the middle; this undoes that (its translation is the
/// offset and what that change needs), and applies the extension's own order: scale, turn, offset.
aiMatrix3x3 gltfTransform(const aiUVTransform& kept) {
    const float turn = -kept.mRotation;
    const float c = std::cos(turn);
    const float s = std::sin(turn);
    const aiVector2D scale = kept.mScaling;
    const float offsetX = kept.mTranslation.x - 0.5F * scale.x * (-c + s + 1);
    const float offsetY = 0.5F * scale.y * (s + c - 1) + 1 - scale.y - kept.mTranslation.y;
    // From the lower left to the upper left, where glTF begins, and back.
    const aiMatrix3x3 flip(1, 0, 0, 0, -1, 1, 0, 0, 1);
    const aiMatrix3x3 transform(c * scale.x, s * scale.y, offsetX, -s * scale.x, c * scale.y,
                                offsetY, 0, 0, 1);
    return flip * transform * flip;
}

}  // namespace

ColorConvention ColorConvention::of(const std::string& extension) {
    const bool isGltf = extension == ".gltf" || extension == ".glb";
    const bool hasMaterials =
        isGltf || extension == ".obj" || extension == ".fbx" || extension == ".dae";
    return {isGltf, hasMaterials, isGltf || extension == ".obj"};
}

openvdb::Vec3f ColorConvention::linear(float r, float g, float b) const {
    openvdb::Vec3f color(std::clamp(r, 0.0F, 1.0F), std::clamp(g, 0.0F, 1.0F),
                         std::clamp(b, 0.0F, 1.0F));
    if (isGltf) return color;
    for (int k = 0; k < 3; ++k) color[k] = static_cast<float>(linearOfSrgb(color[k]));
    return color;
}

MaterialReader::MaterialReader(const aiScene& scene, fs::path meshPath)
    : mScene(scene),
      mPath(std::move(meshPath)),
      mConvention(ColorConvention::of(lowerExtension(mPath))) {}

MaterialColor MaterialReader::read(unsigned index) {
    MaterialColor color;
    if (!mConvention.hasMaterials || index >= mScene.mNumMaterials) return color;
    const aiMaterial& material = *mScene.mMaterials[index];

    // Its own colour.
    aiString name;
    material.Get(AI_MATKEY_NAME, name);
    aiColor4D diffuse(1, 1, 1, 1);
    const bool hasColor = material.Get(AI_MATKEY_BASE_COLOR, diffuse) == AI_SUCCESS ||
                          material.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse) == AI_SUCCESS;
    const aiColor3D rgb(diffuse.r, diffuse.g, diffuse.b);
    const bool isMadeUp = !mConvention.isGltf && rgb == kMadeUpColor;
    // Of a glTF file the last material is that of triangles without one: white, without a name.
    const bool isNone = !hasColor || name == aiString(kMadeUpMaterial) ||
                        (mConvention.isGltf && name.length == 0 && rgb == aiColor3D(1, 1, 1));
    if (!isNone) color.kind = isMadeUp ? MaterialColor::Kind::Guessed : MaterialColor::Kind::Known;
    color.factor = mConvention.linear(rgb.r, rgb.g, rgb.b);

    // Its texture.
    const bool hasBase = material.GetTextureCount(aiTextureType_BASE_COLOR) > 0;
    const aiTextureType type = hasBase ? aiTextureType_BASE_COLOR : aiTextureType_DIFFUSE;
    if (material.GetTextureCount(type) == 0) return color;
    color.texture = textureOf(material, type);
    if (color.texture < 0) {
        // It has been said that the material's colour stands for the texture.
        if (hasColor) color.kind = MaterialColor::Kind::Known;
        return color;
    }
    int channel = 0;
    material.Get(AI_MATKEY_UVWSRC(type, 0), channel);
    color.uvChannel = static_cast<unsigned>(channel);
    aiUVTransform transform;
    if (mConvention.isGltf &&
        material.Get(AI_MATKEY_UVTRANSFORM(type, 0), transform) == AI_SUCCESS) {
        color.uvTransform = gltfTransform(transform);
    }
    if (isNone || isMadeUp || !mConvention.multipliesTexture) color.factor = openvdb::Vec3f(1);
    color.kind = MaterialColor::Kind::Known;
    return color;
}

// The index of a material's texture, which is read if no other material had it.
int MaterialReader::textureOf(const aiMaterial& material, aiTextureType type) {
    aiString name;
    if (material.GetTexture(type, 0, &name) != AI_SUCCESS) return TrianglePaint::kNoTexture;
    const std::shared_ptr<const Texture> used = picture(name.C_Str());
    if (!used) return TrianglePaint::kNoTexture;
    textures.push_back({used,
                        {wrapOf(material, _AI_MATKEY_MAPPINGMODE_U_BASE, type),
                         wrapOf(material, _AI_MATKEY_MAPPINGMODE_V_BASE, type)}});
    return static_cast<int>(textures.size()) - 1;
}

std::shared_ptr<const Texture> MaterialReader::picture(const std::string& name) {
    const auto known = mPictures.find(name);
    if (known != mPictures.end()) return known->second;
    std::shared_ptr<const Texture>& place = mPictures[name];
    const aiTexture* embedded = mScene.GetEmbeddedTexture(name.c_str());
    const std::string called =
        embedded != nullptr ? name : findTexture(mPath.parent_path(), name).string();
    try {
        place = embedded != nullptr ? readEmbedded(*embedded) : readTexture(fs::path(called));
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Input) throw;
        warnings.push_back("the texture \"" + called + "\" " + error.what() +
                           "; the material's colour stands for it");
    }
    return place;
}

}  // namespace bandvox
