#include "core/worker_pool.h"
#include "spectral/sight_line.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>
#include <bandvox/spectral/spectrum_to_screen.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <string>

namespace bandvox {

namespace {

constexpr int kLargestScreen = 65536;
constexpr float kNothing = std::numeric_limits<float>::infinity();

template <typename Real>
void requireValid(const BasicSpectralVolume<Real>& volume, const ScreenOptions& options) {
    const std::int64_t size = std::int64_t(volume.resolution()) * options.magnification;
    if (options.magnification < 1 || size > kLargestScreen) {
        throw Error(ErrorKind::Usage, "a screen of N = " + std::to_string(volume.resolution()) +
                                          " times L = " + std::to_string(options.magnification) +
                                          " is asked for; L must be at least "
                                          "1 and M = LN at most " +
                                          std::to_string(kLargestScreen));
    }
    if (!std::isfinite(options.iso)) {
        throw Error(ErrorKind::Usage, "the iso-value of a screen is " +
                                          std::to_string(options.iso) + "; it must be finite");
    }
}

// Algorithm II. The names are those of figure 14: x = q + pL, y = s + rL; W1 holds, for one s,
// the frequencies along x and z of N rows, W2, for one row and one q, the frequencies along z of
// N lines of sight.
template <typename Real>
class ScreenSearch {
  public:
    using Complex = std::complex<Real>;

    ScreenSearch(const BasicSpectralVolume<Real>& volume, const ScreenOptions& options,
                 Screen& screen)
        : mVolume(volume),
          mOptions(options),
          mN(volume.resolution()),
          mL(options.magnification),
          mStride(volume.rowStride()),
          mPhases(mN, mL),
          mSubset(mPhases),
          mLines(mPhases),
          mW1(volume.size()),
          mPool([this] { return std::make_unique<Work>(*this); }),
          mScreen(screen) {}

    void run(Progress& progress) {
        const ProgressStage stage(progress, "looking", mL);
        for (int s = 0; s < mL; ++s) {
            interpolateRows(s, progress);
            parallelFor(mN, [&](std::int64_t r) {
                progress.throwIfInterrupted();
                auto work = mPool.take();
                searchRow(s, static_cast<int>(r), *work);
                mPool.giveBack(std::move(work));
            });
            findYComponents(s, progress);
            progress.advance();
        }
    }

    double multiplications() const {
        double sum = 0;
        for (const auto& work : mPool.idle()) sum += work->count.multiplications;
        return sum;
    }

  private:
    // The work arrays of one thread.
    struct Work {
        explicit Work(const ScreenSearch& search)
            : w2(static_cast<std::size_t>(search.mN) * search.mStride),
              line(search.mLines.makeWork()) {}

        std::vector<Complex> w2;  // [N][rowStride]
        std::vector<Complex> scratch;
        typename SightLines<Real>::Work line;
        std::vector<int> seen;  // p of the lines of one row and q that meet the surface
        OperationCount count;
    };

    std::size_t pixel(int s, int r, int q, int p) const {
        const auto m = static_cast<std::size_t>(mN) * mL;
        return (static_cast<std::size_t>(r) * mL + s) * m + static_cast<std::size_t>(p) * mL + q;
    }

    // 2πk/N for the signed frequency of an index: times i, what differentiates, per voxel.
    Real derivative(int index) const {
        const double k = 2 * index == mN ? 0 : signedFrequency(index, mN);
        return static_cast<Real>(2 * std::numbers::pi * k / mN);
    }

    // Step I: W1 for one s, for all (l, n).
    void interpolateRows(int s, Progress& progress) {
        parallelFor(mN, [&](std::int64_t l) {
            progress.throwIfInterrupted();
            auto work = mPool.take();
            mPhases(s, {mVolume.row(static_cast<int>(l), 0), mStride}, {planeOf(l), mStride},
                    mStride, work->scratch, &work->count);
            mPool.giveBack(std::move(work));
        });
    }

    Complex* planeOf(std::int64_t l) {
        return mW1.data() + static_cast<std::size_t>(l) * mN * mStride;
    }

    // The frequencies along x of row r: element l is rowStride numbers at l·N·rowStride.
    SignalBatch<Complex> rowOf(int r) {
        return {mW1.data() + static_cast<std::size_t>(r) * mStride,
                static_cast<std::ptrdiff_t>(mN) * mStride};
    }

    // Steps II and III for one row: crossings, and the z and x components of their normals.
    void searchRow(int s, int r, Work& work) {
        const SignalBatch<Complex> row = rowOf(r);
        if (mOptions.onlySeen && !canReach(row)) return;
        for (int q = 0; q < mL; ++q) {
            mPhases(q, row, {work.w2.data(), mStride}, mStride, work.scratch, &work.count);
            for (int p = 0; p < mN; ++p) {
                searchLine(pixel(s, r, q, p), work.w2.data() + p * mStride, work);
            }
        }
        weigh(row, row, work.count);
        evaluateRow(0, s, r, row, work);
    }

    // False if no line of sight of the row can reach the iso-value.
    bool canReach(SignalBatch<const Complex> row) const {
        double sum = 0;
        for (int l = 0; l < mN; ++l) sum += mLines.bound(row.data + l * row.stride);
        return sum / mN > mOptions.iso;
    }

    void searchLine(std::size_t at, const Complex* spectrum, Work& work) {
        if (mOptions.onlySeen && mLines.bound(spectrum) <= mOptions.iso) return;
        const auto step =
            mLines.crossing(spectrum, mOptions.iso, mOptions.refine, work.line, work.count);
        if (!step) return;
        mScreen.depth[at] = static_cast<float>(*step / mL);
        mScreen.normal[at].z() = static_cast<float>(-mLines.slopeAt(spectrum, *step, work.count));
    }

    // Multiplies frequencies along x or y by what differentiates.
    void weigh(SignalBatch<const Complex> from, SignalBatch<Complex> to,
               OperationCount& count) const {
        for (int k = 0; k < mN; ++k) {
            const Real factor = derivative(k);
            const Complex* source = from.data + k * from.stride;
            Complex* target = to.data + k * to.stride;
            for (int n = 0; n < mStride; ++n) {
                target[n] = Complex(-factor * source[n].imag(), factor * source[n].real());
            }
        }
        count.multiplications += static_cast<double>(mN) * mStride;
    }

    // One component of the normals of row r, from its frequencies along x.
    void evaluateRow(int component, int s, int r, SignalBatch<const Complex> row, Work& work) {
        const SignalBatch<Complex> lines{work.w2.data(), mStride};
        for (int q = 0; q < mL; ++q) {
            collectSeen(s, r, q, work.seen);
            if (!mOptions.onlySeen) {
                mPhases(q, row, lines, mStride, work.scratch, &work.count);
            } else if (!work.seen.empty()) {
                mSubset(q, work.seen, row, lines, mStride, work.scratch, &work.count);
            }
            for (std::size_t i = 0; i < work.seen.size(); ++i) {
                const int p = work.seen[i];
                const std::size_t at = pixel(s, r, q, p);
                const auto line = static_cast<std::ptrdiff_t>(mOptions.onlySeen ? i : p);
                const double slope = mLines.valueAt(lines.data + line * mStride,
                                                    double(mScreen.depth[at]) * mL, work.count);
                mScreen.normal[at][component] = static_cast<float>(-slope);
            }
        }
    }

    // The y components for one s: W1 anew, from frequencies times 2πi m/N.
    void findYComponents(int s, Progress& progress) {
        std::vector<int> rows;
        for (int r = 0; r < mN; ++r) {
            if (!mOptions.onlySeen || isSeen(s, r)) rows.push_back(r);
        }
        if (rows.empty()) return;
        parallelFor(mN, [&](std::int64_t l) {
            progress.throwIfInterrupted();
            auto work = mPool.take();
            const SignalBatch<Complex> weighted{work->w2.data(), mStride};
            weigh({mVolume.row(static_cast<int>(l), 0), mStride}, weighted, work->count);
            if (mOptions.onlySeen) {
                mSubset(s, rows, weighted, {planeOf(l), mStride}, mStride, work->scratch,
                        &work->count);
            } else {
                mPhases(s, weighted, {planeOf(l), mStride}, mStride, work->scratch, &work->count);
            }
            mPool.giveBack(std::move(work));
        });
        parallelFor(static_cast<std::int64_t>(rows.size()), [&](std::int64_t i) {
            progress.throwIfInterrupted();
            auto work = mPool.take();
            const SignalBatch<Complex> row = rowOf(static_cast<int>(i));
            evaluateRow(1, s, rows[i], row, *work);
            mPool.giveBack(std::move(work));
        });
    }

    void collectSeen(int s, int r, int q, std::vector<int>& seen) const {
        seen.clear();
        for (int p = 0; p < mN; ++p) {
            if (mScreen.depth[pixel(s, r, q, p)] != kNothing) seen.push_back(p);
        }
    }

    bool isSeen(int s, int r) const {
        const float* row = mScreen.depth.data() + pixel(s, r, 0, 0);
        return std::any_of(row, row + static_cast<std::size_t>(mN) * mL,
                           [](float depth) { return depth != kNothing; });
    }

    const BasicSpectralVolume<Real>& mVolume;
    const ScreenOptions& mOptions;
    const int mN, mL, mStride;
    const PhaseTransform<Real> mPhases;
    const SubsetTransform<Real> mSubset;
    const SightLines<Real> mLines;
    std::vector<Complex> mW1;  // [l][r][n]
    WorkerPool<Work> mPool;
    Screen& mScreen;
};

}  // namespace

template <typename Real>
Screen spectrumToScreen(const BasicSpectralVolume<Real>& volume, const ScreenOptions& options,
                        Progress& progress, OperationCount* count) {
    requireValid(volume, options);
    Screen screen;
    screen.size = volume.resolution() * options.magnification;
    const std::size_t pixels = static_cast<std::size_t>(screen.size) * screen.size;
    requireMemory(4.0 * sizeof(float) * static_cast<double>(pixels) +
                      sizeof(std::complex<Real>) * static_cast<double>(volume.size()),
                  ("a screen of M = " + std::to_string(screen.size)).c_str());
    screen.depth.assign(pixels, kNothing);
    screen.normal.assign(pixels, openvdb::Vec3f(0.0F));
    ScreenSearch<Real> search(volume, options, screen);
    search.run(progress);
    if (count) count->multiplications += search.multiplications();
    return screen;
}

template Screen spectrumToScreen<float>(const SpectralVolume&, const ScreenOptions&, Progress&,
                                        OperationCount*);
template Screen spectrumToScreen<double>(const PreciseSpectralVolume&, const ScreenOptions&,
                                         Progress&, OperationCount*);

}  // namespace bandvox
