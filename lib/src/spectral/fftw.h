#pragma once

#include <bandvox/core/error.h>

#include <fftw3.h>

#include <memory>
#include <string>
#include <type_traits>

namespace bandvox {

/// FFTW's functions for one precision under common names.
template <typename Real>
struct Fftw;

template <>
struct Fftw<float> {
    using Plan = fftwf_plan;
    using Complex = fftwf_complex;
    static constexpr auto planComplex = &fftwf_plan_many_dft;
    static constexpr auto planHalf = &fftwf_plan_many_dft_c2r;
    static constexpr auto execute = &fftwf_execute_dft;
    static constexpr auto executeHalf = &fftwf_execute_dft_c2r;
    static constexpr auto destroy = &fftwf_destroy_plan;
    static constexpr auto alignment = &fftwf_alignment_of;
    static constexpr auto allocate = &fftwf_malloc;
    static constexpr auto release = &fftwf_free;
};

template <>
struct Fftw<double> {
    using Plan = fftw_plan;
    using Complex = fftw_complex;
    static constexpr auto planComplex = &fftw_plan_many_dft;
    static constexpr auto planHalf = &fftw_plan_many_dft_c2r;
    static constexpr auto execute = &fftw_execute_dft;
    static constexpr auto executeHalf = &fftw_execute_dft_c2r;
    static constexpr auto destroy = &fftw_destroy_plan;
    static constexpr auto alignment = &fftw_alignment_of;
    static constexpr auto allocate = &fftw_malloc;
    static constexpr auto release = &fftw_free;
};

template <typename Real>
struct FftwPlanDeleter {
    void operator()(typename Fftw<Real>::Plan plan) const { Fftw<Real>::destroy(plan); }
};

/// A plan that ends with its owner.
template <typename Real>
using FftwPlan =
    std::unique_ptr<std::remove_pointer_t<typename Fftw<Real>::Plan>, FftwPlanDeleter<Real>>;

/// Owns what FFTW's planner returned for a transform of n points. Throws Error(ErrorKind::Runtime)
/// if it made no plan.
template <typename Real>
FftwPlan<Real> takePlan(int n, typename Fftw<Real>::Plan plan) {
    if (!plan) {
        throw Error(ErrorKind::Runtime,
                    "FFTW made no plan for a transform of " + std::to_string(n) + " points");
    }
    return FftwPlan<Real>(plan);
}

}  // namespace bandvox
