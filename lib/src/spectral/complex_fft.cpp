#include "spectral/complex_fft.h"

#include "spectral/fft.h"
#include "spectral/fftw.h"

#include <fftw3.h>

#include <map>
#include <mutex>
#include <new>
#include <tuple>

namespace bandvox {

namespace {

std::size_t extent(int n, int batch, const FftLayout& layout) {
    return static_cast<std::size_t>(n - 1) * layout.stride +
           static_cast<std::size_t>(batch - 1) * layout.distance + 1;
}

// Scratch to plan on: an estimated plan does not touch it, but looks at its alignment.
template <typename Real>
struct PlanningBuffer {
    explicit PlanningBuffer(std::size_t reals)
        : data(static_cast<Real*>(Fftw<Real>::allocate(reals * sizeof(Real)))) {
        if (!data) throw std::bad_alloc();
    }
    ~PlanningBuffer() { Fftw<Real>::release(data); }
    PlanningBuffer(const PlanningBuffer&) = delete;
    PlanningBuffer& operator=(const PlanningBuffer&) = delete;

    Real* data;
};

// The one entry of a cache of plans under `key`, made by `make` the first time.
template <typename Value, typename Key, typename Make>
const Value& cached(const Key& key, const Make& make) {
    static std::map<Key, std::unique_ptr<Value>> plans;
    const std::lock_guard<std::mutex> lock(fftPlannerMutex());
    std::unique_ptr<Value>& plan = plans[key];
    if (!plan) plan.reset(make());
    return *plan;
}

}  // namespace

// One plan for data on FFTW's alignment, which may use vector instructions, one for any other.
template <typename Real>
struct FftPlanPair {
    /// `make` is called with the planner's flags. Throws Error(ErrorKind::Runtime) if there is no
    /// plan for n points.
    template <typename Make>
    FftPlanPair(int n, const Make& make)
        : aligned(takePlan<Real>(n, make(FFTW_ESTIMATE))),
          unaligned(takePlan<Real>(n, make(FFTW_ESTIMATE | FFTW_UNALIGNED))) {}

    typename Fftw<Real>::Plan suiting(const void* in, const void* out) const {
        const auto alignment = [](const void* data) {
            return Fftw<Real>::alignment(const_cast<Real*>(static_cast<const Real*>(data)));
        };
        return (alignment(in) == 0 && alignment(out) == 0 ? aligned : unaligned).get();
    }

    const FftwPlan<Real> aligned, unaligned;
};

template <typename Real>
ComplexFft<Real>::ComplexFft(int n, int batch, FftDirection direction, FftLayout in, FftLayout out,
                             bool inPlace) {
    using Complex = typename Fftw<Real>::Complex;
    const PlanningBuffer<Real> source(2 * extent(n, batch, in));
    const PlanningBuffer<Real> target(2 * extent(n, batch, out));
    auto* from = reinterpret_cast<Complex*>(source.data);
    auto* to = inPlace ? from : reinterpret_cast<Complex*>(target.data);
    const int sign = direction == FftDirection::Forward ? FFTW_FORWARD : FFTW_BACKWARD;
    mPlans = std::make_unique<FftPlanPair<Real>>(n, [&](unsigned flags) {
        return Fftw<Real>::planComplex(
            1, &n, batch, from, nullptr, static_cast<int>(in.stride), static_cast<int>(in.distance),
            to, nullptr, static_cast<int>(out.stride), static_cast<int>(out.distance), sign, flags);
    });
}

template <typename Real>
ComplexFft<Real>::~ComplexFft() = default;

template <typename Real>
const ComplexFft<Real>& ComplexFft<Real>::get(int n, int batch, FftDirection direction,
                                              FftLayout in, FftLayout out, bool inPlace) {
    const auto key =
        std::tuple(n, batch, direction, in.stride, in.distance, out.stride, out.distance, inPlace);
    return cached<ComplexFft>(
        key, [&] { return new ComplexFft(n, batch, direction, in, out, inPlace); });
}

template <typename Real>
void ComplexFft<Real>::operator()(const std::complex<Real>* in, std::complex<Real>* out) const {
    using Complex = typename Fftw<Real>::Complex;
    auto* from = reinterpret_cast<Complex*>(const_cast<std::complex<Real>*>(in));
    auto* to = reinterpret_cast<Complex*>(out);
    Fftw<Real>::execute(mPlans->suiting(in, out), from, to);
}

template <typename Real>
HalfComplexFft<Real>::HalfComplexFft(int n, int batch, FftLayout in, FftLayout out) {
    using Complex = typename Fftw<Real>::Complex;
    const PlanningBuffer<Real> source(2 * extent(n / 2 + 1, batch, in));
    const PlanningBuffer<Real> target(extent(n, batch, out));
    mPlans = std::make_unique<FftPlanPair<Real>>(n, [&](unsigned flags) {
        return Fftw<Real>::planHalf(1, &n, batch, reinterpret_cast<Complex*>(source.data), nullptr,
                                    static_cast<int>(in.stride), static_cast<int>(in.distance),
                                    target.data, nullptr, static_cast<int>(out.stride),
                                    static_cast<int>(out.distance), flags);
    });
}

template <typename Real>
HalfComplexFft<Real>::~HalfComplexFft() = default;

template <typename Real>
const HalfComplexFft<Real>& HalfComplexFft<Real>::get(int n, int batch, FftLayout in,
                                                      FftLayout out) {
    const auto key = std::tuple(n, batch, in.stride, in.distance, out.stride, out.distance);
    return cached<HalfComplexFft>(key, [&] { return new HalfComplexFft(n, batch, in, out); });
}

template <typename Real>
void HalfComplexFft<Real>::operator()(std::complex<Real>* in, Real* out) const {
    Fftw<Real>::executeHalf(mPlans->suiting(in, out),
                            reinterpret_cast<typename Fftw<Real>::Complex*>(in), out);
}

template class ComplexFft<float>;
template class ComplexFft<double>;
template class HalfComplexFft<float>;
template class HalfComplexFft<double>;

}  // namespace bandvox
