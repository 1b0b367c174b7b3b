#include "core/worker_pool.h"
#include "source/sample_range.h"

#include <bandvox/core/error.h>
#include <bandvox/core/memory.h>
#include <bandvox/core/parallel.h>
#include <bandvox/spectral/field_to_spectrum.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace bandvox {

namespace {

constexpr double kDefaultMargin = 1.5;  // side of the default domain over the field's longest

SpectralDomain chooseDomain(const FieldSource& source, const SpectrumOptions& options) {
    if (options.domain) return *options.domain;
    const openvdb::BBoxd box = source.bounds();
    const openvdb::Vec3d size = box.extents();
    const double side = kDefaultMargin * std::max({size.x(), size.y(), size.z()});
    return {box.getCenter() - openvdb::Vec3d(side / 2), side};
}

// Where the field is sampled: R³ places, of which only those in the field's box need be asked.
struct Sampling {
    Sampling(const FieldSource& field, const SpectralDomain& domain, int samples)
        : source(field), origin(domain.origin), step(domain.side / samples) {
        const openvdb::BBoxd box = field.bounds();
        for (int axis = 0; axis < 3; ++axis) {
            range[axis] = samplesWithin((box.min()[axis] - origin[axis]) / step,
                                        (box.max()[axis] - origin[axis]) / step, samples);
        }
    }

    bool isEmptyPlane(int x) const { return !range[0].contains(x); }

    // Samples a row along z into `row`, which is 0 where the field is.
    void sample(int x, int y, std::span<float> row) const {
        std::fill(row.begin(), row.end(), 0.0F);
        if (isEmptyPlane(x) || !range[1].contains(y)) return;
        const openvdb::Vec3d start = origin + step * openvdb::Vec3d(x, y, range[2].begin);
        source.sampleRow(start, openvdb::Vec3d(0, 0, step),
                         row.subspan(range[2].begin, range[2].end - range[2].begin));
    }

    const FieldSource& source;
    openvdb::Vec3d origin;  // world
    double step;            // world
    SampleRange range[3];
};

// The work arrays of one thread.
template <typename Real>
struct PlaneWork {
    using Complex = std::complex<Real>;

    PlaneWork(int samples, int rowStride)
        : row(samples),
          rows{std::vector<Real>(samples), std::vector<Real>(samples)},
          plane(static_cast<std::size_t>(samples) * rowStride) {}

    std::vector<float> row;
    std::vector<Real> rows[2];
    std::vector<Complex> plane;  // [R][rowStride]: W2 of figure 12
    std::vector<Complex> scratch;
    OperationCount count;
};

// Steps I and II of figure 12 for the plane of one x: samples along z and y become N frequencies
// each, [N][rowStride].
template <typename Real>
void reducePlane(const Sampling& sampling, const LowFrequencyTransform<Real>& reduce, int x,
                 int rowStride, PlaneWork<Real>& work, std::complex<Real>* out) {
    const SampleRange used = sampling.range[1];
    std::fill(work.plane.begin(), work.plane.end(), std::complex<Real>(0));
    // R is even, as N is, so rows come in pairs.
    for (int y = used.begin & ~1; y < used.end; y += 2) {
        for (int i = 0; i < 2; ++i) {
            sampling.sample(x, y + i, work.row);
            std::copy(work.row.begin(), work.row.end(), work.rows[i].begin());
        }
        std::complex<Real>* first = work.plane.data() + static_cast<std::size_t>(y) * rowStride;
        reduce.pair(work.rows[0].data(), work.rows[1].data(), first, first + rowStride,
                    work.scratch, &work.count);
    }
    reduce({work.plane.data(), rowStride}, {out, rowStride}, rowStride, work.scratch, &work.count);
}

// Multiplies one row of frequencies with the filter; what has no sign, or is padding, becomes 0.
template <typename Real>
void filterRow(const ExponentialFilter& filter, int resolution, int l, int m,
               std::span<std::complex<Real>> row, double scale) {
    const auto frequency = [&](int index) {
        return static_cast<double>(signedFrequency(index, resolution)) / resolution;
    };
    const double across = frequency(l) * frequency(l) + frequency(m) * frequency(m);
    const bool isNyquist = 2 * l == resolution || 2 * m == resolution;
    for (int n = 0; n < static_cast<int>(row.size()); ++n) {
        const double along = static_cast<double>(n) / resolution;
        const bool isZero = isNyquist || 2 * n >= resolution;
        row[n] *= static_cast<Real>(isZero ? 0 : scale * filter(std::sqrt(across + along * along)));
    }
}

}  // namespace

template <typename Real>
BasicSpectralVolume<Real> fieldToSpectrum(const FieldSource& source, const SpectrumOptions& options,
                                          Progress& progress, OperationCount* count) {
    using Complex = std::complex<Real>;
    const int n = options.resolution;
    const int r = options.samples;
    BasicSpectralVolume<Real> volume(n, r, options.filter, chooseDomain(source, options));
    const int rowStride = volume.rowStride();
    const std::size_t plane = static_cast<std::size_t>(n) * rowStride;
    requireMemory(
        (static_cast<double>(r) * plane +
         static_cast<double>(threadCount()) * r * (rowStride + 4)) *
            sizeof(Complex),
        ("Algorithm I at R = " + std::to_string(r) + ", N = " + std::to_string(n)).c_str());

    // Sample and reduce plane by plane: W3 of figure 12.
    const Sampling sampling(source, volume.domain(), r);
    const LowFrequencyTransform<Real> reduce(r, n);
    std::vector<Complex> planes(r * plane);
    WorkerPool<PlaneWork<Real>> pool(
        [&] { return std::make_unique<PlaneWork<Real>>(r, rowStride); });
    const ProgressStage stage(progress, "sampling", r);
    parallelFor(r, [&](std::int64_t x) {
        progress.throwIfInterrupted();
        if (!sampling.isEmptyPlane(static_cast<int>(x))) {
            auto work = pool.take();
            reducePlane(sampling, reduce, static_cast<int>(x), rowStride, *work,
                        planes.data() + x * plane);
            pool.giveBack(std::move(work));
        }
        progress.advance();
    });

    // Reduce along x, step III, and filter. One sample stands for (N/R)³ voxels.
    const double scale = std::pow(static_cast<double>(n) / r, 3);
    parallelFor(n, [&](std::int64_t m) {
        progress.throwIfInterrupted();
        auto work = pool.take();
        reduce({planes.data() + m * rowStride, static_cast<std::ptrdiff_t>(plane)},
               {volume.row(0, static_cast<int>(m)), static_cast<std::ptrdiff_t>(plane)}, rowStride,
               work->scratch, &work->count);
        for (int l = 0; l < n; ++l) {
            filterRow<Real>(
                options.filter, n, l, static_cast<int>(m),
                {volume.row(l, static_cast<int>(m)), static_cast<std::size_t>(rowStride)}, scale);
        }
        pool.giveBack(std::move(work));
    });
    if (count) {
        for (const auto& work : pool.idle()) count->multiplications += work->count.multiplications;
    }
    return volume;
}

template BasicSpectralVolume<float> fieldToSpectrum<float>(const FieldSource&,
                                                           const SpectrumOptions&, Progress&,
                                                           OperationCount*);
template BasicSpectralVolume<double> fieldToSpectrum<double>(const FieldSource&,
                                                             const SpectrumOptions&, Progress&,
                                                             OperationCount*);

}  // namespace bandvox
