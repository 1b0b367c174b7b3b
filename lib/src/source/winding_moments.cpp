#include "source/winding_moments.h"

namespace bandvox {

using openvdb::Vec3d;

WindingMoments WindingMoments::ofTriangle(const std::array<Vec3d, 3>& corner, const Vec3d& center) {
    WindingMoments moments;
    const Vec3d area = 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const std::array<Vec3d, 3> d = {corner[0] - center, corner[1] - center, corner[2] - center};
    const Vec3d sum = d[0] + d[1] + d[2];
    moments.mArea = area;
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) moments.mFirst[i][k] = sum[i] / 3 * area[k];
        for (int j = 0; j < 3; ++j) {
            // The mean of a product over a triangle.
            const double mean =
                (d[0][i] * d[0][j] + d[1][i] * d[1][j] + d[2][i] * d[2][j] + sum[i] * sum[j]) / 12;
            for (int k = 0; k < 3; ++k) moments.mSecond[i][j][k] = mean * area[k];
        }
    }
    return moments;
}

void WindingMoments::add(const WindingMoments& other, const Vec3d& shift) {
    mArea += other.mArea;
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            mFirst[i][k] += other.mFirst[i][k] + shift[i] * other.mArea[k];
        }
        for (int j = 0; j < 3; ++j) {
            for (int k = 0; k < 3; ++k) {
                mSecond[i][j][k] += other.mSecond[i][j][k] + shift[i] * other.mFirst[j][k] +
                                    shift[j] * other.mFirst[i][k] +
                                    shift[i] * shift[j] * other.mArea[k];
            }
        }
    }
}

WindingMoments::Coefficients WindingMoments::coefficients(double unit) const {
    const double first = 1 / (unit * unit * unit), second = first / unit;
    const double zeroth = 1 / (unit * unit);
    const auto& q = mFirst;
    const auto& s = mSecond;
    Coefficients result;
    std::size_t next = 0;
    const auto put = [&](double value) { result[next++] = static_cast<float>(value); };
    for (int k = 0; k < 3; ++k) put(zeroth * mArea[k]);
    // The gradient of R / r³ is 1 / r³ - 3 R R / r⁵.
    put(first * (q[0][0] + q[1][1] + q[2][2]));
    for (int i = 0; i < 3; ++i) put(first * q[i][i]);
    put(first * (q[0][1] + q[1][0]));
    put(first * (q[0][2] + q[2][0]));
    put(first * (q[1][2] + q[2][1]));
    // Half of its second derivative: -3/2 (δ_ij R_k + δ_ik R_j + δ_jk R_i) / r⁵ +
    // 15/2 R_i R_j R_k / r⁷.
    for (int k = 0; k < 3; ++k) {
        double sum = 0;
        for (int i = 0; i < 3; ++i) sum += s[i][i][k] + s[i][k][i] + s[k][i][i];
        put(1.5 * second * sum);
    }
    const double cubic = 7.5 * second;
    for (int i = 0; i < 3; ++i) put(cubic * s[i][i][i]);
    const auto twice = [&](int i, int j) {  // of R_i² R_j
        put(cubic * (s[i][i][j] + s[i][j][i] + s[j][i][i]));
    };
    twice(0, 1);
    twice(0, 2);
    twice(1, 0);
    twice(1, 2);
    twice(2, 0);
    twice(2, 1);
    put(cubic * 2 * (s[0][1][2] + s[0][2][1] + s[1][2][0]));
    return result;
}

}  // namespace bandvox
