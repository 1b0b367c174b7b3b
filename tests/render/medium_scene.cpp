#include "render/medium_scene.h"

#include <random>

namespace bandvox::render_test {

using openvdb::Vec3d;

std::vector<Ray> raysPast(const Vec3d& place, double beside, int count) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
        Vec3d direction(normal(random), normal(random), normal(random));
        // The first along the axes.
        if (i < 3) direction = Vec3d(i == 0, i == 1, i == 2);
        direction.normalize();
        Vec3d offset = direction.cross(Vec3d(normal(random), normal(random), normal(random)));
        offset = beside * uniform(random) * offset.unit();
        rays.push_back({place + offset - 200 * direction, direction});
    }
    return rays;
}

}  // namespace bandvox::render_test
