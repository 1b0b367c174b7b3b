// What this machine can do at most, as JSON: how fast it copies what no cache holds, how fast it
// multiplies and adds what the first cache holds, and how fast FFTW transforms tiles of 64³.

#include <bandvox/core/parallel.h>

#include <fftw3.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace {

constexpr int kTasks = 64;
constexpr int kRounds = 5;

// Seconds of a work of so many tasks on some threads; the least of a few rounds.
double leastSeconds(int threads, const std::function<void(std::int64_t)>& task) {
    const bandvox::ThreadLimit limit(threads);
    double least = 1e30;
    for (int round = 0; round < kRounds; ++round) {
        const auto begin = std::chrono::steady_clock::now();
        bandvox::parallelFor(kTasks, task);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        least = std::min(least, took.count());
    }
    return least;
}

// Gigabytes a second, read and written.
double copyRate(int threads) {
    constexpr std::size_t kBytes = std::size_t(8) << 20U;
    std::vector<char> from(kBytes * kTasks, 1), to(kBytes * kTasks);
    const double seconds = leastSeconds(threads, [&](std::int64_t i) {
        const std::ptrdiff_t at = i * static_cast<std::ptrdiff_t>(kBytes);
        std::copy_n(from.begin() + at, kBytes, to.begin() + at);
    });
    return 2e-9 * static_cast<double>(kBytes) * kTasks / seconds;
}

// Billions of multiplications and additions of floats a second, a pair counted as two.
double multiplyAddRate(int threads) {
    constexpr std::size_t kFloats = 2048;
    constexpr int kPasses = 20000;
    std::vector<std::vector<float>> all(kTasks, std::vector<float>(kFloats, 1));
    const double seconds = leastSeconds(threads, [&](std::int64_t i) {
        float* const values = all[static_cast<std::size_t>(i)].data();
        for (int pass = 0; pass < kPasses; ++pass) {
            const float factor = 1 + 1e-7F * static_cast<float>(pass);
            for (std::size_t k = 0; k < kFloats; ++k) values[k] = values[k] * factor + 1e-6F;
        }
    });
    return 2e-9 * static_cast<double>(kFloats) * kPasses * kTasks / seconds;
}

// Billions of operations a second of real transforms of 64³ numbers, counted as 2.5 n log2 n.
double transformRate(int threads) {
    constexpr int kSide = 64;
    constexpr std::size_t kReal = std::size_t(kSide) * kSide * kSide;
    constexpr std::size_t kComplex = std::size_t(kSide) * kSide * (kSide / 2 + 1);
    const auto release = [](void* memory) { fftwf_free(memory); };
    using Numbers = std::unique_ptr<float, decltype(release)>;
    std::vector<Numbers> in, out;
    for (int i = 0; i < kTasks; ++i) {
        in.emplace_back(fftwf_alloc_real(kReal), release);
        out.emplace_back(fftwf_alloc_real(2 * kComplex), release);
        std::fill_n(in.back().get(), kReal, 1.0F);
    }
    const auto complex = [&](std::size_t i) {
        return reinterpret_cast<fftwf_complex*>(out[i].get());
    };
    fftwf_plan plan =
        fftwf_plan_dft_r2c_3d(kSide, kSide, kSide, in[0].get(), complex(0), FFTW_MEASURE);
    std::fill_n(in[0].get(), kReal, 1.0F);
    const double seconds = leastSeconds(threads, [&](std::int64_t i) {
        const auto k = static_cast<std::size_t>(i);
        fftwf_execute_dft_r2c(plan, in[k].get(), complex(k));
    });
    fftwf_destroy_plan(plan);
    constexpr double kLog2 = 18;
    return 2.5e-9 * static_cast<double>(kReal) * kLog2 * kTasks / seconds;
}

std::string line(const char* name, const char* unit, double (*rate)(int)) {
    char text[200];
    std::snprintf(text, sizeof text, R"(  "%s": {"unit": "%s", "rates": [%.4g, %.4g]})", name, unit,
                  rate(1), rate(2));
    return text;
}

}  // namespace

int main() {
    std::string json = "{\n";
    json += line("copying memory", "GB/s", copyRate) + ",\n";
    json += line("multiplying and adding in the first cache", "Gflop/s", multiplyAddRate) + ",\n";
    json += line("FFTW, real tiles of 64\\u00b3", "Gflop/s", transformRate) + "\n}\n";
    std::fputs(json.c_str(), stdout);
    return 0;
}
