#include <bandvox/render/shading.h>

namespace bandvox {

const std::vector<std::string>& shadingNames() {
    static const std::vector<std::string> names{"spectral", "depth",   "phong",
                                                "cross",    "sobel2d", "sobel3d"};
    return names;
}

}  // namespace bandvox
