#include "outline/patches/bernstein.h"

#include <algorithm>
#include <cmath>

namespace bandvox {
namespace {

double binomial(int n, int k) {
    double result = 1;
    for (int i = 1; i <= k; ++i) result = result * (n - k + i) / i;
    return result;
}

std::vector<double> binomials(int n) {
    std::vector<double> row;
    for (int k = 0; k <= n; ++k) row.push_back(binomial(n, k));
    return row;
}

// Replaces coefficients, `step` apart, by those of the first half; writes those of the second one.
void halve(double* low, double* high, int degree, std::ptrdiff_t step) {
    high[degree * step] = low[degree * step];
    for (int r = 1; r <= degree; ++r) {
        for (int i = degree; i >= r; --i) {
            low[i * step] = 0.5 * (low[i * step] + low[(i - 1) * step]);
        }
        high[(degree - r) * step] = low[degree * step];
    }
}

bool isPositive(double value) {
    return value >= 0;
}

// The root of a polynomial that is monotone on [a, b] and changes its sign there.
double monotoneRoot(const std::vector<double>& c, double a, double b) {
    const int degree = static_cast<int>(c.size()) - 1;
    const bool rises = isPositive(c.back());
    double low = 0, high = 1, t = c.front() / (c.front() - c.back());
    for (int step = 0; step < 100; ++step) {
        if (!(t > low && t < high)) t = 0.5 * (low + high);
        const BernsteinBasis basis(degree, t);
        double value = 0, slope = 0;
        for (int i = 0; i <= degree; ++i) {
            value += c[static_cast<std::size_t>(i)] * basis.value(i);
            slope += c[static_cast<std::size_t>(i)] * basis.slope(i);
        }
        (isPositive(value) == rises ? high : low) = t;
        const double next = slope == 0 ? 0.5 * (low + high) : t - value / slope;
        if (std::abs(next - t) < 1e-15 || high - low < 1e-15) break;
        t = next;
    }
    return a + (b - a) * std::clamp(t, 0.0, 1.0);
}

}  // namespace

double Bernstein2::smallest() const {
    return *std::min_element(c.begin(), c.end());
}
double Bernstein2::largest() const {
    return *std::max_element(c.begin(), c.end());
}
double Bernstein2::largestMagnitude() const {
    return std::max(largest(), -smallest());
}

Bernstein2 operator+(const Bernstein2& a, const Bernstein2& b) {
    Bernstein2 sum = a;
    for (std::size_t i = 0; i < sum.c.size(); ++i) sum.c[i] += b.c[i];
    return sum;
}

Bernstein2 operator-(const Bernstein2& a, const Bernstein2& b) {
    Bernstein2 difference = a;
    for (std::size_t i = 0; i < difference.c.size(); ++i) difference.c[i] -= b.c[i];
    return difference;
}

Bernstein2 operator*(const Bernstein2& a, const Bernstein2& b) {
    Bernstein2 product(a.m + b.m, a.n + b.n);
    const std::vector<double> am = binomials(a.m), an = binomials(a.n), bm = binomials(b.m),
                              bn = binomials(b.n), pm = binomials(product.m),
                              pn = binomials(product.n);
    const auto of = [](const std::vector<double>& row, int k) {
        return row[static_cast<std::size_t>(k)];
    };
    for (int i = 0; i <= a.m; ++i) {
        for (int j = 0; j <= a.n; ++j) {
            const double factor = a.at(i, j) * of(am, i) * of(an, j);
            if (factor == 0) continue;
            for (int k = 0; k <= b.m; ++k) {
                for (int l = 0; l <= b.n; ++l) {
                    product.at(i + k, j + l) += factor * b.at(k, l) * of(bm, k) * of(bn, l);
                }
            }
        }
    }
    for (int i = 0; i <= product.m; ++i) {
        for (int j = 0; j <= product.n; ++j) product.at(i, j) /= of(pm, i) * of(pn, j);
    }
    return product;
}

Bernstein2 derivativeU(const Bernstein2& p) {
    if (p.m == 0) return {0, p.n};
    Bernstein2 result(p.m - 1, p.n);
    for (int i = 0; i < p.m; ++i) {
        for (int j = 0; j <= p.n; ++j) result.at(i, j) = p.m * (p.at(i + 1, j) - p.at(i, j));
    }
    return result;
}

Bernstein2 derivativeV(const Bernstein2& p) {
    if (p.n == 0) return {p.m, 0};
    Bernstein2 result(p.m, p.n - 1);
    for (int i = 0; i <= p.m; ++i) {
        for (int j = 0; j < p.n; ++j) result.at(i, j) = p.n * (p.at(i, j + 1) - p.at(i, j));
    }
    return result;
}

std::pair<Bernstein2, Bernstein2> splitU(const Bernstein2& p) {
    std::pair<Bernstein2, Bernstein2> halves{p, Bernstein2(p.m, p.n)};
    for (int j = 0; j <= p.n; ++j) {
        halve(&halves.first.at(0, j), &halves.second.at(0, j), p.m, p.n + 1);
    }
    return halves;
}

std::pair<Bernstein2, Bernstein2> splitV(const Bernstein2& p) {
    std::pair<Bernstein2, Bernstein2> halves{p, Bernstein2(p.m, p.n)};
    for (int i = 0; i <= p.m; ++i) {
        halve(&halves.first.at(i, 0), &halves.second.at(i, 0), p.n, 1);
    }
    return halves;
}

std::array<Bernstein2, 4> quarters(const Bernstein2& p) {
    const auto [low, high] = splitU(p);
    auto [lowLow, lowHigh] = splitV(low);
    auto [highLow, highHigh] = splitV(high);
    return {std::move(lowLow), std::move(lowHigh), std::move(highLow), std::move(highHigh)};
}

Bernstein2 withoutFactor(const Bernstein2& p, int side) {
    const bool alongU = side < 2;
    const bool atEnd = side % 2 == 1;
    const int degree = alongU ? p.m : p.n;
    Bernstein2 result(alongU ? p.m - 1 : p.m, alongU ? p.n : p.n - 1);
    for (int i = 0; i <= result.m; ++i) {
        for (int j = 0; j <= result.n; ++j) {
            const int k = alongU ? i : j;
            const double share = atEnd ? double(degree) / (degree - k) : double(degree) / (k + 1);
            const int shift = atEnd ? 0 : 1;
            result.at(i, j) = share * (alongU ? p.at(i + shift, j) : p.at(i, j + shift));
        }
    }
    return result;
}

double sideMagnitude(const Bernstein2& p, int side) {
    double result = 0;
    const int last = side < 2 ? p.n : p.m;
    for (int k = 0; k <= last; ++k) {
        const double value = side < 2 ? p.at(side == 0 ? 0 : p.m, k) : p.at(k, side == 2 ? 0 : p.n);
        result = std::max(result, std::abs(value));
    }
    return result;
}

Gradient2 evaluate(const Bernstein2& p, double u, double v) {
    const BernsteinBasis bu(p.m, u), bv(p.n, v);
    Gradient2 result;
    const double* coefficient = p.c.data();
    for (int i = 0; i <= p.m; ++i) {
        double value = 0, slope = 0;
        for (int j = 0; j <= p.n; ++j, ++coefficient) {
            value += *coefficient * bv.value(j);
            slope += *coefficient * bv.slope(j);
        }
        result.value += bu.value(i) * value;
        result.du += bu.slope(i) * value;
        result.dv += bu.value(i) * slope;
    }
    return result;
}

void appendRoots(std::vector<double> c, double a, double b, std::vector<double>& roots) {
    const bool first = isPositive(c.front()), last = isPositive(c.back());
    const auto sameSign = [&](double value) { return isPositive(value) == first; };
    if (first == last && std::all_of(c.begin(), c.end(), sameSign)) return;
    bool rises = false, falls = false;
    for (std::size_t i = 1; i < c.size(); ++i) {
        rises |= c[i] > c[i - 1];
        falls |= c[i] < c[i - 1];
    }
    if (rises != falls) {
        if (first != last) roots.push_back(monotoneRoot(c, a, b));
        return;
    }
    const double middle = 0.5 * (a + b);
    constexpr double kNarrowest = 1e-12;
    if (b - a < kNarrowest || middle == a || middle == b) {
        if (first != last) roots.push_back(middle);
        return;
    }
    std::vector<double> high(c.size());
    halve(c.data(), high.data(), static_cast<int>(c.size()) - 1, 1);
    appendRoots(std::move(c), a, middle, roots);
    appendRoots(std::move(high), middle, b, roots);
}

}  // namespace bandvox
