#pragma once

#include <bandvox/source/colored_mesh.h>

#include <assimp/scene.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace bandvox {

/// What a material says of the colour of a surface.
struct MaterialColor {
    /// `Guessed`: the grey that the importer gives a material whose colour it does not know.
    enum class Kind { None, Guessed, Known };
    Kind kind = Kind::None;
    openvdb::Vec3f factor{1};  ///< linear light; of the texture, if there is one
    int texture = TrianglePaint::kNoTexture;
    unsigned uvChannel = 0;
    aiMatrix3x3 uvTransform;
};

/// How the colours in a kind of file are meant.
struct ColorConvention {
    bool isGltf;             ///< linear; points, materials and textures multiply
    bool hasMaterials;       ///< those of other kinds the importer makes up
    bool multipliesTexture;  ///< the material's colour is a factor of its texture

    /// `extension` of the mesh file, in lower case with its dot.
    static ColorConvention of(const std::string& extension);

    /// Linear light of a colour of a point or a material, limited to [0, 1].
    openvdb::Vec3f linear(float r, float g, float b) const;
};

/// Reads the materials of a scene, and each of their textures once.
class MaterialReader {
  public:
    /// `meshPath`: the file that the scene came from; paths of textures are relative to it.
    MaterialReader(const aiScene& scene, std::filesystem::path meshPath);

    MaterialColor read(unsigned material);

    const ColorConvention& convention() const { return mConvention; }
    std::vector<MeshTexture> textures;
    std::vector<std::string> warnings;

  private:
    int textureOf(const aiMaterial& material, aiTextureType type);
    std::shared_ptr<const Texture> picture(const std::string& name);

    const aiScene& mScene;
    std::filesystem::path mPath;
    ColorConvention mConvention;
    std::map<std::string, std::shared_ptr<const Texture>> mPictures;  // null: cannot be used
};

}  // namespace bandvox
