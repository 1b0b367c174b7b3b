#include "spectral/fft.h"

#include "spectral/fftw.h"

#include <fftw3.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <new>
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

RealFft3::RealFft3(int n, int margin, int zMargin, int inner)
    : mSize(n),
      mInner(inner > 0 ? inner : n),
      mXCount(n + margin),
      mYCount(n + margin),
      mZStride(paddedRow(std::max(2 * (n / 2 + 1), n + zMargin))),
      mPlans(std::make_unique<Plans>()) {
    const FftBuffer buffer = allocate();
    float* real = buffer.get();
    auto* complex = reinterpret_cast<fftwf_complex*>(real);
    const int frequencies = n / 2 + 1;
    const int rowStride = mZStride / 2;
    const int planeStride = mYCount * rowStride;

    mPlans->forwardZ =
        takePlan<float>(n, fftwf_plan_many_dft_r2c(1, &n, n, real, nullptr, 1, mZStride, complex,
                                                   nullptr, 1, rowStride, FFTW_ESTIMATE));
    mPlans->inverseZ =
        takePlan<float>(n, fftwf_plan_many_dft_c2r(1, &n, mInner, complex, nullptr, 1, rowStride,
                                                   real, nullptr, 1, mZStride, FFTW_ESTIMATE));
    const auto planComplex = [&](int stride, int sign) {
        return takePlan<float>(
            n, fftwf_plan_many_dft(1, &n, frequencies, complex, nullptr, stride, 1, complex,
                                   nullptr, stride, 1, sign, FFTW_ESTIMATE));
    };
    mPlans->forwardY = planComplex(rowStride, FFTW_FORWARD);
    mPlans->inverseY = planComplex(rowStride, FFTW_BACKWARD);
    mPlans->forwardX = planComplex(planeStride, FFTW_FORWARD);
    mPlans->inverseX = planComplex(planeStride, FFTW_BACKWARD);
}

RealFft3::~RealFft3() = default;

const RealFft3& RealFft3::get(int n, int margin, int zMargin, int inner) {
    static std::map<std::tuple<int, int, int, int>, std::unique_ptr<RealFft3>> plans;
    const std::lock_guard<std::mutex> lock(fftPlannerMutex());
    std::unique_ptr<RealFft3>& plan = plans[{n, margin, zMargin, inner}];
    if (!plan) plan.reset(new RealFft3(n, margin, zMargin, inner));
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
    for (int x = 0; x < mSize; ++x) {
        float* real = data + x * plane;
        auto* complex = reinterpret_cast<fftwf_complex*>(real);
        fftwf_execute_dft_r2c(mPlans->forwardZ.get(), real, complex);
        fftwf_execute_dft(mPlans->forwardY.get(), complex, complex);
    }
    for (int y = 0; y < mSize; ++y) {
        auto* complex = reinterpret_cast<fftwf_complex*>(data + y * mZStride);
        fftwf_execute_dft(mPlans->forwardX.get(), complex, complex);
    }
}

void RealFft3::inverse(float* data, int first) const {
    const std::size_t plane = static_cast<std::size_t>(mYCount) * mZStride;
    for (int y = 0; y < mSize; ++y) {
        auto* complex = reinterpret_cast<fftwf_complex*>(data + y * mZStride);
        fftwf_execute_dft(mPlans->inverseX.get(), complex, complex);
    }
    for (int x = first; x < first + mInner; ++x) {
        auto* complex = reinterpret_cast<fftwf_complex*>(data + x * plane);
        fftwf_execute_dft(mPlans->inverseY.get(), complex, complex);
        float* rows = data + x * plane + static_cast<std::size_t>(first) * mZStride;
        fftwf_execute_dft_c2r(mPlans->inverseZ.get(), reinterpret_cast<fftwf_complex*>(rows), rows);
    }
}

}  // namespace bandvox
