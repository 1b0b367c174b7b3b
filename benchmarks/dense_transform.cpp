#include "dense_transform.h"

#include "source/sample_range.h"

#include <bandvox/core/parallel.h>
#include <bandvox/spectral/pruned_transform.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <new>
#include <span>

namespace bandvox::benchmarks {

DenseTransform::DenseTransform(int n, int threads, bool inverse)
    : mSize(n),
      mHalf(n / 2 + 1),
      mData(fftwf_alloc_real(static_cast<std::size_t>(n) * n * 2 * mHalf)) {
    if (!mData) throw std::bad_alloc();
    fftwf_init_threads();
    fftwf_plan_with_nthreads(threads);
    auto* complex = reinterpret_cast<fftwf_complex*>(mData);
    mPlan = inverse ? fftwf_plan_dft_c2r_3d(n, n, n, complex, mData, FFTW_ESTIMATE)
                    : fftwf_plan_dft_r2c_3d(n, n, n, mData, complex, FFTW_ESTIMATE);
}

DenseTransform::~DenseTransform() {
    fftwf_destroy_plan(mPlan);
    fftwf_free(mData);
}

SpectralVolume DenseTransform::lowPass(const FieldSource& source, int resolution,
                                       const ExponentialFilter& filter,
                                       const SpectralDomain& domain) {
    // Sample the field's box, as Algorithm I does.
    const double step = domain.side / mSize;
    const openvdb::BBoxd box = source.bounds();
    SampleRange range[3];
    for (int axis = 0; axis < 3; ++axis) {
        range[axis] = samplesWithin((box.min()[axis] - domain.origin[axis]) / step,
                                    (box.max()[axis] - domain.origin[axis]) / step, mSize);
    }
    parallelFor(mSize, [&](std::int64_t i) {
        const auto x = static_cast<int>(i);
        for (int y = 0; y < mSize; ++y) {
            std::fill_n(row(x, y), mSize, 0.0F);
            if (!range[0].contains(x) || !range[1].contains(y)) continue;
            source.sampleRow(domain.origin + step * openvdb::Vec3d(x, y, range[2].begin),
                             {0, 0, step},
                             std::span(row(x, y) + range[2].begin,
                                       static_cast<std::size_t>(range[2].end - range[2].begin)));
        }
    });
    fftwf_execute(mPlan);

    const int n = resolution;
    SpectralVolume volume(n, mSize, filter, domain);
    const double scale = std::pow(static_cast<double>(n) / mSize, 3);
    const auto wrapped = [&](int k) { return k < 0 ? k + mSize : k; };
    for (int l = 0; l < n; ++l) {
        for (int m = 0; m < n; ++m) {
            const int kl = signedFrequency(l, n), km = signedFrequency(m, n);
            if (2 * l == n || 2 * m == n) continue;
            const fftwf_complex* from = frequencies(wrapped(kl), wrapped(km));
            for (int k = 0; 2 * k < n; ++k) {
                const double distance =
                    std::sqrt(double(kl) * kl + double(km) * km + double(k) * k);
                const auto weight = static_cast<float>(scale * filter(distance / n));
                volume.row(l, m)[k] = {weight * from[k][0], weight * from[k][1]};
            }
        }
    }
    return volume;
}

std::vector<int> DenseTransform::crossings(const SpectralVolume& volume, float iso) {
    const int n = volume.resolution();
    const std::size_t count = static_cast<std::size_t>(mSize) * mSize * 2 * mHalf;
    parallelFor(mSize, [&](std::int64_t x) {
        std::fill_n(row(static_cast<int>(x), 0), count / mSize, 0.0F);
    });
    const auto wrapped = [&](int index) {
        const int k = signedFrequency(index, n);
        return k < 0 ? k + mSize : k;
    };
    for (int l = 0; l < n; ++l) {
        for (int m = 0; m < n; ++m) {
            fftwf_complex* to = frequencies(wrapped(l), wrapped(m));
            for (int k = 0; 2 * k < n; ++k) {
                to[k][0] = volume.row(l, m)[k].real();
                to[k][1] = volume.row(l, m)[k].imag();
            }
        }
    }
    fftwf_execute(mPlan);

    const float level = iso * std::pow(static_cast<float>(n), 3.0F);
    std::vector<int> found(static_cast<std::size_t>(mSize) * mSize, -1);
    parallelFor(mSize, [&](std::int64_t x) {
        for (int y = 0; y < mSize; ++y) {
            const float* values = row(static_cast<int>(x), y);
            for (int z = 0; z < mSize; ++z) {
                if (values[z] <= level) continue;
                found[static_cast<std::size_t>(x) * mSize + y] = z;
                break;
            }
        }
    });
    return found;
}

}  // namespace bandvox::benchmarks
