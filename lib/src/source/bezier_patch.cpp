#include <bandvox/source/bezier_patch.h>

#include <span>
#include <utility>

namespace bandvox {
namespace {

using Homogeneous = std::array<double, 4>;

// A point of a Bézier curve and its first and second derivatives, by de Casteljau's scheme.
struct CurveJet {
    Homogeneous value{}, first{}, second{};
};

CurveJet curveJet(std::vector<Homogeneous> points, double t) {
    const int degree = static_cast<int>(points.size()) - 1;
    CurveJet jet;
    for (int rest = degree; rest >= 0; --rest) {
        const auto at = [&](int i, std::size_t c) {
            return points[static_cast<std::size_t>(i)][c];
        };
        for (std::size_t c = 0; c < 4; ++c) {
            if (rest == 2) {
                jet.second[c] = degree * (degree - 1) * (at(2, c) - 2 * at(1, c) + at(0, c));
            }
            if (rest == 1) jet.first[c] = degree * (at(1, c) - at(0, c));
            if (rest == 0) jet.value[c] = at(0, c);
        }
        for (int i = 0; i < rest; ++i) {
            auto& point = points[static_cast<std::size_t>(i)];
            for (std::size_t c = 0; c < 4; ++c) {
                point[c] = (1 - t) * point[c] + t * points[static_cast<std::size_t>(i) + 1][c];
            }
        }
    }
    return jet;
}

// The Bézier points of a curve between two parameters: its blossom at every mixture of them.
void restrictCurve(std::span<Homogeneous> points, double t0, double t1) {
    const std::vector<Homogeneous> original(points.begin(), points.end());
    const std::size_t degree = points.size() - 1;
    for (std::size_t late = 0; late <= degree; ++late) {
        std::vector<Homogeneous> mixed = original;
        for (std::size_t step = 0; step < degree; ++step) {
            const double t = step < late ? t1 : t0;
            for (std::size_t i = 0; i + step < degree; ++i) {
                for (std::size_t c = 0; c < 4; ++c) {
                    mixed[i][c] = (1 - t) * mixed[i][c] + t * mixed[i + 1][c];
                }
            }
        }
        points[late] = mixed[0];
    }
}

std::array<double, 3> point(const Homogeneous& p) {
    return {p[0] / p[3], p[1] / p[3], p[2] / p[3]};
}

}  // namespace

PatchJet evaluate(const BezierPatch& patch, double u, double v) {
    std::vector<Homogeneous> value, first, second;  // along u, of the curves across
    for (int i = 0; i <= patch.degreeU; ++i) {
        const auto* row = &patch.at(i, 0);
        const CurveJet jet = curveJet({row, row + patch.degreeV + 1}, v);
        value.push_back(jet.value);
        first.push_back(jet.first);
        second.push_back(jet.second);
    }
    const CurveJet s = curveJet(value, u);
    const CurveJet sv = curveJet(first, u);
    const CurveJet svv = curveJet(second, u);
    // With P = w S the derivatives follow from those of P and w by the rule of products.
    PatchJet jet{.position = point(s.value)};
    const double w = s.value[3];
    for (std::size_t c = 0; c < 3; ++c) {
        const double p = jet.position[c];
        jet.du[c] = (s.first[c] - s.first[3] * p) / w;
        jet.dv[c] = (sv.value[c] - sv.value[3] * p) / w;
        jet.duu[c] = (s.second[c] - 2 * s.first[3] * jet.du[c] - s.second[3] * p) / w;
        jet.duv[c] =
            (sv.first[c] - s.first[3] * jet.dv[c] - sv.value[3] * jet.du[c] - sv.first[3] * p) / w;
        jet.dvv[c] = (svv.value[c] - 2 * sv.value[3] * jet.dv[c] - svv.value[3] * p) / w;
    }
    return jet;
}

void PatchModel::append(PatchModel other) {
    const int shift = static_cast<int>(objects.size());
    topology.append(std::move(other.topology), patches.size(), other.patches.size());
    for (BezierPatch& patch : other.patches) {
        patch.object += shift;
        patches.push_back(std::move(patch));
    }
    objects.insert(objects.end(), other.objects.begin(), other.objects.end());
    warnings.insert(warnings.end(), other.warnings.begin(), other.warnings.end());
}

BezierPatch restricted(const BezierPatch& patch, double u0, double u1, double v0, double v1) {
    BezierPatch result = patch;
    const auto columns = static_cast<std::size_t>(patch.degreeV) + 1;
    for (int i = 0; i <= patch.degreeU; ++i) {
        restrictCurve({&result.at(i, 0), columns}, v0, v1);
    }
    std::vector<Homogeneous> column(static_cast<std::size_t>(patch.degreeU) + 1);
    for (int j = 0; j <= patch.degreeV; ++j) {
        for (int i = 0; i <= patch.degreeU; ++i) {
            column[static_cast<std::size_t>(i)] = result.at(i, j);
        }
        restrictCurve(column, u0, u1);
        for (int i = 0; i <= patch.degreeU; ++i) {
            result.at(i, j) = column[static_cast<std::size_t>(i)];
        }
    }
    return result;
}

}  // namespace bandvox
