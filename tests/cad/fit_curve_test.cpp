// Curves of parameters as polynomials.

#include "cad/fit_curve.h"

#include "source/parameter_curve.h"

#include <bandvox/core/error.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bandvox::cad_test {
namespace {

double largestGap(const std::vector<CadPiece>& pieces, const CurveFunction& function) {
    double gap = 0;
    for (const CadPiece& piece : pieces) {
        for (int k = 0; k <= 40; ++k) {
            const double t = k / 40.0;
            const auto a = jetAt(piece.curve, t).place;
            const auto b = function(piece.from + t * (piece.to - piece.from));
            gap = std::max({gap, std::abs(a[0] - b[0]), std::abs(a[1] - b[1])});
        }
    }
    return gap;
}

TEST(FitCurve, FollowsASmoothCurveToTheTolerance) {
    const CurveFunction function = [](double t) {
        return std::array<double, 2>{std::cos(t), std::sin(2 * t)};
    };
    std::vector<CadPiece> pieces;
    EXPECT_LE(fitCurve(function, 0, 5, 1e-12, pieces), 1e-12);
    EXPECT_LE(largestGap(pieces, function), 1e-11);
    EXPECT_EQ(pieces.front().from, 0);
    EXPECT_EQ(pieces.back().to, 5);
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
        EXPECT_EQ(pieces[i].to, pieces[i + 1].from);
        EXPECT_EQ(pieces[i].curve.back(), pieces[i + 1].curve.front());
    }
}

TEST(FitCurve, ComesDownToPlacesWhereTheCurveTurns) {
    const CurveFunction function = [](double t) {
        return std::array<double, 2>{t, std::abs(t - 0.3) + std::abs(t - 0.712)};
    };
    std::vector<CadPiece> pieces;
    EXPECT_LE(fitCurve(function, 0, 1, 1e-12, pieces), 1e-7);
    EXPECT_LE(largestGap(pieces, function), 1e-7);
    EXPECT_LT(pieces.size(), 100U);
}

TEST(FitCurve, TellsHowFarItIsFromACurveThatTurnsTooOften) {
    const CurveFunction function = [](double t) {
        return std::array<double, 2>{t, std::sin(1e6 * t)};
    };
    std::vector<CadPiece> pieces;
    EXPECT_GT(fitCurve(function, 0, 1, 1e-12, pieces), 0.1);
    EXPECT_EQ(pieces.size(), 1024U);
}

TEST(FitCurve, RefusesPlacesThatAreNotFinite) {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(), 1e200}) {
        const CurveFunction function = [&](double t) {
            return std::array<double, 2>{t, t > 0.5 ? bad : 0.0};
        };
        std::vector<CadPiece> pieces;
        try {
            fitCurve(function, 0, 1, 1e-12, pieces);
            ADD_FAILURE() << bad;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Input);
        }
    }
}

}  // namespace
}  // namespace bandvox::cad_test
