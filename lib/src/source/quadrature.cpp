#include <bandvox/source/quadrature.h>

#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

namespace bandvox {
namespace {

/// Points that follow from one another by permuting their barycentric coordinates, each with
/// the same weight. Three coordinates that differ give six points, two equal ones three.
struct Orbit {
    double weight;
    double a, b;
};

constexpr double kThird = 1.0 / 3.0;

std::vector<TrianglePoint> expand(const std::vector<Orbit>& orbits) {
    std::vector<TrianglePoint> points;
    for (const Orbit& o : orbits) {
        const double c = 1.0 - o.a - o.b;
        if (o.a == kThird && o.b == kThird) {
            points.push_back({kThird, kThird, kThird, o.weight});
        } else if (o.a == o.b) {
            points.push_back({c, o.a, o.a, o.weight});
            points.push_back({o.a, c, o.a, o.weight});
            points.push_back({o.a, o.a, c, o.weight});
        } else {
            points.push_back({o.a, o.b, c, o.weight});
            points.push_back({o.a, c, o.b, o.weight});
            points.push_back({o.b, o.a, c, o.weight});
            points.push_back({o.b, c, o.a, o.weight});
            points.push_back({c, o.a, o.b, o.weight});
            points.push_back({c, o.b, o.a, o.weight});
        }
    }
    return points;
}

constexpr Orbit centroid(double weight) {
    return {weight, kThird, kThird};
}
constexpr Orbit three(double weight, double b) {
    return {weight, b, b};
}
constexpr Orbit six(double weight, double a, double b) {
    return {weight, a, b};
}

constexpr std::array<int, kTriangleRules> kTriangleDegrees = {1, 2, 4, 5, 6, 8, 10, 12};

std::array<std::vector<TrianglePoint>, kTriangleRules> makeTriangleRules() {
    return {
        expand({centroid(1.0)}),
        expand({three(kThird, 1.0 / 6.0)}),
        expand({three(0.223381589678011, 0.445948490915965),
                three(0.109951743655322, 0.091576213509771)}),
        expand({centroid(0.225), three(0.132394152788506, 0.470142064105115),
                three(0.125939180544827, 0.101286507323456)}),
        expand({three(0.116786275726379, 0.249286745170910),
                three(0.050844906370207, 0.063089014491502),
                six(0.082851075618374, 0.310352451033785, 0.053145049844816)}),
        expand({centroid(0.144315607677787), three(0.095091634267285, 0.459292588292723),
                three(0.103217370534718, 0.170569307751760),
                three(0.032458497623198, 0.050547228317031),
                six(0.027230314174435, 0.008394777409958, 0.263112829634638)}),
        expand({centroid(0.090817990382754), three(0.036725957756467, 0.485577633383657),
                three(0.045321059435528, 0.109481575485037),
                six(0.072757916845420, 0.141707219414880, 0.307939838764121),
                six(0.028327242531057, 0.025003534762686, 0.246672560639903),
                six(0.009421666963733, 0.009540815400299, 0.066803251012200)}),
        expand({three(0.025731066440455, 0.488217389773805),
                three(0.043692544538038, 0.439724392294460),
                three(0.062858224217885, 0.271210385012116),
                three(0.034796112930709, 0.127576145541586),
                three(0.006166261051559, 0.021317350453210),
                six(0.040371557766381, 0.115343494534698, 0.275713269685514),
                six(0.022356773202303, 0.022838332222257, 0.281325580989940),
                six(0.017316231108659, 0.025734050548330, 0.116251915907597)}),
    };
}

/// The Legendre polynomial of the given degree and its derivative at x, |x| < 1.
std::array<double, 2> legendre(int degree, double x) {
    double previous = 1.0;
    double value = x;
    for (int n = 2; n <= degree; ++n) {
        const double next = ((2 * n - 1) * x * value - (n - 1) * previous) / n;
        previous = value;
        value = next;
    }
    return {value, degree * (previous - x * value) / (1.0 - x * x)};
}

std::vector<IntervalPoint> makeIntervalRule(int count) {
    std::vector<IntervalPoint> points;
    for (int i = 0; i < count; ++i) {
        // Chebyshev's estimate of the root is near enough for Newton's method to converge.
        double x = -std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5));
        if (2 * i + 1 == count) x = 0.0;
        for (int iteration = 0; iteration < 6; ++iteration) {
            const auto [value, slope] = legendre(count, x);
            x -= value / slope;
        }
        const double slope = legendre(count, x)[1];
        points.push_back({0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope)});
    }
    return points;
}

std::array<std::vector<IntervalPoint>, kIntervalRules> makeIntervalRules() {
    std::array<std::vector<IntervalPoint>, kIntervalRules> rules;
    for (int rule = 0; rule < kIntervalRules; ++rule) rules[rule] = makeIntervalRule(rule + 1);
    return rules;
}

}  // namespace

int triangleRuleDegree(int rule) {
    assert(rule >= 0 && rule < kTriangleRules);
    return kTriangleDegrees[rule];
}

std::span<const TrianglePoint> triangleRule(int rule) {
    static const auto rules = makeTriangleRules();
    assert(rule >= 0 && rule < kTriangleRules);
    return rules[rule];
}

std::span<const IntervalPoint> intervalRule(int rule) {
    static const auto rules = makeIntervalRules();
    assert(rule >= 0 && rule < kIntervalRules);
    return rules[rule];
}

}  // namespace bandvox
