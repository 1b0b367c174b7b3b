#include "source/solid_angle.h"
#include "source/winding_tree.h"

#include <bandvox/source/winding_number.h>

#include <numbers>
#include <utility>

namespace bandvox {

WindingNumber::WindingNumber(Mesh mesh)
    : mTree(std::make_unique<const WindingTree>(std::move(mesh))) {}
WindingNumber::~WindingNumber() = default;
WindingNumber::WindingNumber(WindingNumber&&) noexcept = default;
WindingNumber& WindingNumber::operator=(WindingNumber&&) noexcept = default;

double WindingNumber::at(const openvdb::Vec3d& place) const {
    constexpr double kFarAway = 3.5;
    static thread_local WindingTerms terms;
    mTree->collect({place, 0}, kFarAway, terms);
    return terms.at(place);
}

double WindingNumber::exactAt(const openvdb::Vec3d& place) const {
    double sum = 0;
    for (std::uint32_t t = 0; t < mTree->triangleCount(); ++t) {
        sum += solidAngle(place, mTree->corners(t));
    }
    return sum / (4 * std::numbers::pi);
}

}  // namespace bandvox
