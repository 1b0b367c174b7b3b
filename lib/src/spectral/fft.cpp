#include "spectral/fft.h"

#include "core/instruction_sets.h"
#include "spectral/fftw.h"
#include "spectral/packed_row.h"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <new>
#include <numbers>
#include <string>
#include <tuple>

namespace bandvox {

namespace {

// Rows start on 32 bytes, and not on a multiple of 128 floats, which would make the rows of a
// column share cache sets.
int paddedRow(int length) {
    int padded = (length + 7) / 8 * 8;
    if (padded % 32 == 0) padded += 8;
    return padded;
}

// In place, on the complex numbers that begin there.
void execute(const FftwPlan<float>& plan, float* at) {
    auto* complex = reinterpret_cast<fftwf_complex*>(at);
    fftwf_execute_dft(plan.get(), complex, complex);
}

// Of the transform Z of pairs of samples, as complex numbers, makes that of the samples, up to
// Nyquist: X(k) = E + u S, where E and S are half the sum and the difference of Z(k) and the
// conjugate of Z(n/2 - k). `mirrored` has room for n numbers.
BANDVOX_FOR_EACH_INSTRUCTION_SET
void unpackRow(float* row, int n, const float* turns, float* mirrored) {
    turnedConjugates(row, n, mirrored);
    const float nyquist = row[0] - row[1];
    for (int k = 0; k < n / 2; ++k) {
        const float re = row[2 * k], im = row[2 * k + 1];
        const float mirroredRe = mirrored[2 * k + 1], mirroredIm = -mirrored[2 * k];
        const float sumRe = 0.5F * (re + mirroredRe), sumIm = 0.5F * (im + mirroredIm);
        const float lessRe = 0.5F * (re - mirroredRe), lessIm = 0.5F * (im - mirroredIm);
        const float turnRe = turns[2 * k], turnIm = turns[2 * k + 1];
        row[2 * k] = sumRe + (turnRe * lessRe - turnIm * lessIm);
        row[2 * k + 1] = sumIm + (turnRe * lessIm + turnIm * lessRe);
    }
    row[n] = nyquist;
    row[n + 1] = 0;
}

// The other way around, twice as large, of a row whose imaginary parts at 0 and Nyquist are left
// out.
BANDVOX_FOR_EACH_INSTRUCTION_SET
void packRow(float* row, int n, const float* turns, float* mirrored) {
    const float zero = row[0], nyquist = row[n];
    turnedConjugates(row, n, mirrored);
    for (int k = 0; k < n / 2; ++k) {
        const float re = row[2 * k], im = row[2 * k + 1];
        const float mirroredRe = mirrored[2 * k + 1], mirroredIm = -mirrored[2 * k];
        const float sumRe = re + mirroredRe, sumIm = im + mirroredIm;
        const float lessRe = re - mirroredRe, lessIm = im - mirroredIm;
        const float turnRe = turns[2 * k], turnIm = turns[2 * k + 1];
        row[2 * k] = sumRe + (turnRe * lessRe + turnIm * lessIm);
        row[2 * k + 1] = sumIm + (turnRe * lessIm - turnIm * lessRe);
    }
    row[0] = zero + nyquist;
    row[1] = zero - nyquist;
}

}  // namespace

std::mutex& fftPlannerMutex() {
    static std::mutex mutex;
    return mutex;
}

void FftBufferDeleter::operator()(float* data) const {
    fftwf_free(data);
}

// One plan for each axis and direction, each for a whole plane of rows.
struct RealFft3::Plans {
    FftwPlan<float> forwardZ, forwardY, forwardX;
    FftwPlan<float> inverseZ, inverseY, inverseX;
};

RealFft3::RealFft3(int n, int margin, int zMargin, int inner, SpectrumLayout layout)
    : mSize(n),
      mInner(inner > 0 ? inner : n),
      mXCount(n + margin),
      mYCount(n + margin),
      mZStride(paddedRow(std::max(2 * (n / 2 + 1), n + zMargin))),
      mLayout(layout),
      mPlans(std::make_unique<Plans>()) {
    if (n % 2 != 0) {
        throw Error(ErrorKind::Runtime, "a real transform of " + std::to_string(n) +
                                            " points along an axis; expected an even number");
    }
    const FftBuffer buffer = allocate();
    auto* complex = reinterpret_cast<fftwf_complex*>(buffer.get());
    const int pairs = n / 2;
    const int rowStride = mZStride / 2;
    const int planeStride = mYCount * rowStride;
    const auto plan = [&](int length, int count, int stride, int distance, int sign) {
        return takePlan<float>(
            n, fftwf_plan_many_dft(1, &length, count, complex, nullptr, stride, distance, complex,
                                   nullptr, stride, distance, sign, FFTW_ESTIMATE));
    };
    const int columns = layout == SpectrumLayout::Half ? pairs + 1 : pairs;
    mPlans->forwardZ = plan(pairs, n, 1, rowStride, FFTW_FORWARD);
    mPlans->inverseZ = plan(pairs, mInner, 1, rowStride, FFTW_BACKWARD);
    mPlans->forwardY = plan(n, columns, rowStride, 1, FFTW_FORWARD);
    mPlans->inverseY = plan(n, columns, rowStride, 1, FFTW_BACKWARD);
    mPlans->forwardX = plan(n, columns, planeStride, 1, FFTW_FORWARD);
    mPlans->inverseX = plan(n, columns, planeStride, 1, FFTW_BACKWARD);
    for (int k = 0; k < pairs; ++k) {
        const double angle = 2 * std::numbers::pi * k / n;
        mTurns.push_back(static_cast<float>(-std::sin(angle)));
        mTurns.push_back(static_cast<float>(-std::cos(angle)));
    }
}

RealFft3::~RealFft3() = default;

const RealFft3& RealFft3::get(int n, int margin, int zMargin, int inner, SpectrumLayout layout) {
    using Shape = std::tuple<int, int, int, int, SpectrumLayout>;
    static std::map<Shape, std::unique_ptr<RealFft3>> plans;
    const std::lock_guard<std::mutex> lock(fftPlannerMutex());
    std::unique_ptr<RealFft3>& plan = plans[{n, margin, zMargin, inner, layout}];
    if (!plan) plan.reset(new RealFft3(n, margin, zMargin, inner, layout));
    return *plan;
}

std::size_t RealFft3::bufferSize() const {
    return static_cast<std::size_t>(mXCount) * mYCount * mZStride;
}

FftBuffer RealFft3::allocate() const {
    FftBuffer buffer(fftwf_alloc_real(bufferSize()));
    if (!buffer) throw std::bad_alloc();
    std::fill_n(buffer.get(), bufferSize(), 0.0F);
    return buffer;
}

void RealFft3::forward(float* data) const {
    const std::size_t plane = static_cast<std::size_t>(mYCount) * mZStride;
    // Transform each plane of constant x along z, then y, while it is in the cache.
    std::vector<float> mirrored(mLayout == SpectrumLayout::Half ? mSize : 0);
    for (int x = 0; x < mSize; ++x) {
        float* rows = data + x * plane;
        execute(mPlans->forwardZ, rows);
        if (mLayout == SpectrumLayout::Half) {
            for (int y = 0; y < mSize; ++y) {
                unpackRow(rows + y * mZStride, mSize, mTurns.data(), mirrored.data());
            }
        }
        execute(mPlans->forwardY, rows);
    }
    for (int y = 0; y < mSize; ++y) execute(mPlans->forwardX, data + y * mZStride);
}

void RealFft3::inverse(float* data, int first) const {
    const std::size_t plane = static_cast<std::size_t>(mYCount) * mZStride;
    for (int y = 0; y < mSize; ++y) execute(mPlans->inverseX, data + y * mZStride);
    std::vector<float> mirrored(mLayout == SpectrumLayout::Half ? mSize : 0);
    for (int x = first; x < first + mInner; ++x) {
        execute(mPlans->inverseY, data + x * plane);
        float* rows = data + x * plane + static_cast<std::size_t>(first) * mZStride;
        if (mLayout == SpectrumLayout::Half) {
            for (int y = 0; y < mInner; ++y) {
                packRow(rows + y * mZStride, mSize, mTurns.data(), mirrored.data());
            }
        }
        execute(mPlans->inverseZ, rows);
    }
}

}  // namespace bandvox
