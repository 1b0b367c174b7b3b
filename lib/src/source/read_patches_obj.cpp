// Free-form surfaces of Wavefront's .obj files. Wavefront, "Advanced Visualizer Manual", appendix
// B1: Object Files, 1995.

#include "source/read_patches.h"
#include "source/text_lines.h"

#include <bandvox/source/bspline_patch.h>

#include <algorithm>
#include <string>
#include <string_view>

namespace bandvox {
namespace {

class ObjSurfaces {
  public:
    ObjSurfaces(const FileContents& file, Progress& progress)
        : mFile(file), mLines(file), mProgress(progress) {}

    PatchModel read() {
        while (mLines.nextWithWords()) {
            while (mLines.joinContinued()) continue;
            if (mLines.number() % 4096 == 0) mProgress.throwIfInterrupted();
            if (!mLines.words().empty()) takeStatement(mLines.words()[0]);
        }
        if (mInBody) {
            mFile.fail("ends within the surface of line " + std::to_string(mSurfLine) +
                       "; expected \"end\"");
        }
        if (mModel.patches.empty()) {
            mFile.fail("has no free-form surface" +
                       std::string(mFaces > 0 ? ", only faces; expected surf statements"
                                              : "; expected surf statements"));
        }
        if (mFaces > 0) {
            mModel.warnings.push_back(std::to_string(mFaces) + " faces were left out");
        }
        return std::move(mModel);
    }

  private:
    void takeStatement(std::string_view word) {
        if (word == "v") return takePoint();
        if (word == "cstype") return takeType();
        if (word == "deg") return takeDegree();
        if (word == "surf") return takeSurface();
        if (word == "parm") return takeKnots();
        if (word == "end") return takeEnd();
        if (word == "o" || word == "g") return takeName();
        if (word == "f") ++mFaces;
        if (word == "trim" || word == "hole") {
            mLines.fail("trims a surface; expected surfaces that are not trimmed");
        }
        if (word == "curv" || word == "curv2") mInCurve = true;
    }

    void need(std::size_t words, const std::string& what) const {
        if (mLines.words().size() < words) mLines.fail("is too short; expected " + what);
    }

    void takePoint() {
        need(4, "v x y z");
        const double w = mLines.words().size() > 4 ? mLines.coordinate(4) : 1;
        mPoints.push_back({mLines.coordinate(1), mLines.coordinate(2), mLines.coordinate(3), w});
    }

    void takeType() {
        need(2, "cstype [rat] bezier or bspline");
        mRational = mLines.words()[1] == "rat";
        need(mRational ? 3 : 2, "cstype [rat] bezier or bspline");
        const std::string_view type = mLines.words()[mRational ? 2 : 1];
        mIsBezier = type == "bezier";
        mTypeWord = std::string(type.substr(0, 40));
    }

    void takeDegree() {
        need(2, "deg with one or two degrees");
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const std::size_t word = std::min(axis + 1, mLines.words().size() - 1);
            const std::int64_t degree = mLines.integer(word);
            if (degree < 1 || degree > BezierPatch::kHighestDegree) {
                mLines.fail("has the degree " + std::to_string(degree) + "; expected 1 to " +
                            std::to_string(BezierPatch::kHighestDegree));
            }
            mNet.degree[axis] = static_cast<int>(degree);
        }
        mHasDegree = true;
    }

    void takeSurface() {
        need(6, "surf s0 s1 t0 t1 and points");
        if (mInBody) mLines.fail("begins a surface within another one; expected \"end\"");
        if (mTypeWord != "bezier" && mTypeWord != "bspline") {
            mLines.fail("has a surface of cstype \"" + mTypeWord +
                        "\"; expected bezier or bspline");
        }
        if (!mHasDegree) mLines.fail("has a surface before any deg; expected its degrees");
        mInBody = true;
        mInCurve = false;
        mSurfLine = mLines.number();
        mNet.knots = {};
        mNet.control.clear();
        mNet.range = {{{mLines.coordinate(1), mLines.coordinate(2)},
                       {mLines.coordinate(3), mLines.coordinate(4)}}};
        for (const auto& [low, high] : mNet.range) {
            if (!(low < high)) {
                mLines.fail("has a surface whose parameter goes from " + std::to_string(low) +
                            " to " + std::to_string(high) + "; expected it to rise");
            }
        }
        for (std::size_t i = 5; i < mLines.words().size(); ++i) takeControl(i);
    }

    void takeControl(std::size_t word) {
        const auto index = leadingInteger(mLines.words()[word]);
        const auto count = static_cast<std::int64_t>(mPoints.size());
        const std::int64_t at = !index             ? -1
                                : index->value < 0 ? count + index->value
                                                   : index->value - 1;
        if (at < 0 || at >= count) {
            mLines.fail("refers to point \"" + std::string(mLines.words()[word].substr(0, 40)) +
                        "\" after " + std::to_string(count) + "; expected one of them");
        }
        std::array<double, 4> point = mPoints[static_cast<std::size_t>(at)];
        if (!mRational) point[3] = 1;
        if (!(point[3] > 0)) {
            mLines.fail("refers to point " + std::to_string(at + 1) + " with the weight " +
                        std::to_string(point[3]) + "; expected one above 0");
        }
        for (std::size_t c = 0; c < 3; ++c) point[c] *= point[3];
        mNet.control.push_back(point);
    }

    void takeKnots() {
        if (mInCurve) return;
        need(4, "parm u or v and two numbers or more");
        if (!mInBody) mLines.fail("has a parm without a surface; expected surf before it");
        const std::string_view axis = mLines.words()[1];
        if (axis != "u" && axis != "v") {
            mLines.fail("has a parm of \"" + std::string(axis.substr(0, 40)) +
                        "\"; expected u or v");
        }
        std::vector<double>& knots = mNet.knots[axis == "v"];
        for (std::size_t i = 2; i < mLines.words().size(); ++i) {
            knots.push_back(mLines.coordinate(i));
            if (knots.size() > 1 && knots.back() < knots[knots.size() - 2]) {
                mLines.fail("has a parm that descends; expected numbers that do not");
            }
        }
    }

    // Bézier curves that follow one another are a B-spline with each knot as often as its degree.
    void repeatKnots(std::size_t axis) {
        std::vector<double>& given = mNet.knots[axis];
        if (given.empty()) given = {0, 1};
        std::vector<double> knots{given.front()};
        for (const double knot : given) knots.insert(knots.end(), mNet.degree[axis], knot);
        knots.push_back(given.back());
        given = std::move(knots);
    }

    void takeEnd() {
        mInCurve = false;
        if (!mInBody) return;
        mInBody = false;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            if (mIsBezier) repeatKnots(axis);
            mNet.count[axis] = static_cast<int>(mNet.knots[axis].size()) - mNet.degree[axis] - 1;
            if (mNet.count[axis] <= mNet.degree[axis]) {
                failSurface(std::to_string(mNet.knots[axis].size()) + " numbers in parm " +
                            (axis == 0 ? "u" : "v") + ", too few for the degree " +
                            std::to_string(mNet.degree[axis]));
            }
        }
        const auto expected =
            static_cast<std::size_t>(mNet.count[0]) * static_cast<std::size_t>(mNet.count[1]);
        if (mNet.control.size() != expected) {
            failSurface(std::to_string(mNet.control.size()) + " points; expected " +
                        std::to_string(mNet.count[0]) + " x " + std::to_string(mNet.count[1]) +
                        ", by its degrees and parms");
        }
        appendPatches();
    }

    [[noreturn]] void failSurface(const std::string& found) const {
        mFile.fail("line " + std::to_string(mSurfLine) + " has a surface with " + found);
    }

    void appendPatches() {
        // The file has u running fastest.
        BsplineNet net = mNet;
        const auto columns = static_cast<std::size_t>(net.count[0]);
        const auto rows = static_cast<std::size_t>(net.count[1]);
        for (std::size_t i = 0; i < columns; ++i) {
            for (std::size_t j = 0; j < rows; ++j) {
                net.control[i * rows + j] = mNet.control[j * columns + i];
            }
        }
        if (mModel.objects.empty()) mModel.objects.push_back(mFile.path.stem().string());
        std::vector<BezierPatch> patches = bezierPatches(net);
        if (patches.empty()) {
            failSurface("nothing between its parameters, which its parms do not reach");
        }
        for (BezierPatch& patch : patches) {
            patch.object = static_cast<int>(mModel.objects.size()) - 1;
            mModel.patches.push_back(std::move(patch));
        }
    }

    void takeName() {
        if (mLines.words().size() < 2) return;
        const std::string name(mLines.words()[1]);
        const bool isUnused =
            !mModel.objects.empty() &&
            (mModel.patches.empty() ||
             mModel.patches.back().object + 1 != static_cast<int>(mModel.objects.size()));
        if (isUnused) {
            mModel.objects.back() = name;
        } else {
            mModel.objects.push_back(name);
        }
    }

    const FileContents& mFile;
    TextLines mLines;
    Progress& mProgress;
    PatchModel mModel;
    std::vector<std::array<double, 4>> mPoints;  // x, y, z, weight
    BsplineNet mNet;
    std::string mTypeWord;
    bool mRational = false, mIsBezier = false, mHasDegree = false;
    bool mInBody = false, mInCurve = false;
    std::size_t mSurfLine = 0;
    std::size_t mFaces = 0;
};

}  // namespace

PatchModel readObjPatches(const FileContents& file, Progress& progress) {
    return ObjSurfaces(file, progress).read();
}

}  // namespace bandvox
