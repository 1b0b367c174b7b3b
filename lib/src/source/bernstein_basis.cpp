#include "source/bernstein_basis.h"

namespace bandvox {

BernsteinBasis::BernsteinBasis(int degree, double t) {
    mValue[0] = 1;
    mSlope[0] = 0;
    const double s = 1 - t;
    for (int r = 1; r <= degree; ++r) {
        if (r == degree) {
            for (int i = 0; i <= degree; ++i) {
                const double before = i > 0 ? mValue[static_cast<std::size_t>(i) - 1] : 0;
                const double here = i < degree ? mValue[static_cast<std::size_t>(i)] : 0;
                mSlope[static_cast<std::size_t>(i)] = degree * (before - here);
            }
        }
        mValue[static_cast<std::size_t>(r)] = t * mValue[static_cast<std::size_t>(r) - 1];
        for (int i = r - 1; i > 0; --i) {
            auto& value = mValue[static_cast<std::size_t>(i)];
            value = s * value + t * mValue[static_cast<std::size_t>(i) - 1];
        }
        mValue[0] *= s;
    }
}

}  // namespace bandvox
