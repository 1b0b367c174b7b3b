#include "outline/drawing/fit_cubics.h"

#include "outline/drawing/join_curves.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace bandvox {
namespace {

using Place = std::array<double, 2>;

Place operator+(const Place& a, const Place& b) {
    return {a[0] + b[0], a[1] + b[1]};
}
Place operator-(const Place& a, const Place& b) {
    return {a[0] - b[0], a[1] - b[1]};
}
Place operator*(double s, const Place& a) {
    return {s * a[0], s * a[1]};
}
double dot(const Place& a, const Place& b) {
    return a[0] * b[0] + a[1] * b[1];
}
double lengthOf(const Place& a) {
    return std::sqrt(a[0] * a[0] + a[1] * a[1]);
}

struct Cubic {
    std::array<Place, 4> p;

    Place at(double t) const {
        const double s = 1 - t;
        return s * s * s * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t * t * t * p[3];
    }
    Place slope(double t) const {
        const double s = 1 - t;
        return 3 * s * s * (p[1] - p[0]) + 6 * s * t * (p[2] - p[1]) + 3 * t * t * (p[3] - p[2]);
    }
    Place bend(double t) const {
        return 6 * (1 - t) * (p[2] - 2.0 * p[1] + p[0]) + 6 * t * (p[3] - 2.0 * p[2] + p[1]);
    }
};

struct FittedCubic {
    Cubic cubic;
    double error = 0;
};

/// A smooth part of a curve.
struct SmoothRun {
    std::vector<Place> points;
    std::vector<Place> directions;  // along the run, length 1
    std::vector<double> lengths;    // up to each point
};

/// What is known of a cubic: ends, directions there, length.
struct CubicFrame {
    Place a, b, da, db;
    double length;
};

// A cubic with given ends and end directions, whose handles have the lengths that fit best. With a
// cubic that is near already, distances along it count little, since parameters will give way
// there: that takes a few rounds where plain least squares take hundreds.
Cubic leastSquares(const CubicFrame& frame, const std::vector<Place>& points,
                   const std::vector<double>& parameters, const Cubic* near) {
    constexpr double kWeightAlong = 0.02;
    const auto& [a, b, da, db, length] = frame;
    double aa = 0, ab = 0, bb = 0, ra = 0, rb = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const double t = parameters[k], s = 1 - t;
        const double b1 = 3 * s * s * t, b2 = 3 * s * t * t;
        Place rest = points[k] - ((s * s * s + b1) * a + (t * t * t + b2) * b);
        Place va = b1 * da, vb = -b2 * db;
        if (near != nullptr) {
            const Place slope = near->slope(t);
            const Place along = (1 / std::max(lengthOf(slope), 1e-300)) * slope;
            for (Place* v : {&rest, &va, &vb}) {
                *v = *v - (1 - kWeightAlong) * dot(*v, along) * along;
            }
        }
        aa += dot(va, va);
        ab += dot(va, vb);
        bb += dot(vb, vb);
        ra += dot(va, rest);
        rb += dot(vb, rest);
    }
    const double determinant = aa * bb - ab * ab;
    const double chord = lengthOf(b - a);
    double alpha = (ra * bb - rb * ab) / determinant, beta = (rb * aa - ra * ab) / determinant;
    // Longer handles would take the curve back and forth between its points.
    const double most = 0.75 * std::max(length, chord);
    const bool isGood = alpha > 1e-3 * chord && beta > 1e-3 * chord && alpha < most && beta < most;
    if (!isGood) alpha = beta = chord / 3;
    return {{a, a + alpha * da, b - beta * db, b}};
}

// The parameter whose place is nearest, from a guess.
double projected(const Cubic& cubic, const Place& point, double t) {
    const Place gap = cubic.at(t) - point, slope = cubic.slope(t);
    const double numerator = dot(gap, slope);
    const double denominator = dot(slope, slope) + dot(gap, cubic.bend(t));
    if (!(denominator > 0)) return t;
    return std::clamp(t - numerator / denominator, 0.0, 1.0);
}

FittedCubic fitOne(const SmoothRun& run, std::size_t first, std::size_t last, double enough) {
    constexpr std::size_t kMostPoints = 32;
    constexpr int kRounds = 8;
    const std::size_t inner = last - first - 1;
    const std::size_t count = std::min(inner, kMostPoints);
    std::vector<Place> points;
    std::vector<double> parameters;
    const double whole = run.lengths[last] - run.lengths[first];
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = first + 1 + (count == inner ? k : k * (inner - 1) / (count - 1));
        points.push_back(run.points[i]);
        parameters.push_back((run.lengths[i] - run.lengths[first]) / whole);
    }
    const CubicFrame frame{run.points[first], run.points[last], run.directions[first],
                           run.directions[last], whole};
    FittedCubic best{.cubic = leastSquares(frame, points, parameters, nullptr),
                     .error = std::numeric_limits<double>::infinity()};
    double before = best.error;
    Cubic cubic = best.cubic;
    for (int round = 0; round < kRounds; ++round) {
        if (round > 0) cubic = leastSquares(frame, points, parameters, &cubic);
        double error = 0;
        for (std::size_t k = 0; k < count; ++k) {
            parameters[k] = projected(cubic, points[k], parameters[k]);
            error = std::max(error, lengthOf(cubic.at(parameters[k]) - points[k]));
        }
        if (error < best.error) best = {cubic, error};
        if (best.error < enough || error > 0.95 * before) break;
        // Reparametrization may halve an error again and again, but not help where it is large.
        if (round == 2 && error > 20 * enough) break;
        before = error;
    }
    return best;
}

double distanceFromChord(const Place& place, const Place& a, const Place& b) {
    const Place chord = b - a;
    const double square = dot(chord, chord);
    const double share = square > 0 ? std::clamp(dot(place - a, chord) / square, 0.0, 1.0) : 0;
    return lengthOf(place - (a + share * chord));
}

// Whether all points between are near, not only those that were fitted, and the cubic does not
// leave their chords, by `bulge` at most.
bool isNearAll(const SmoothRun& run, std::size_t first, std::size_t last, const Cubic& cubic,
               double tolerance, double bulge) {
    const double whole = run.lengths[last] - run.lengths[first];
    double before = 0;
    for (std::size_t i = first + 1; i <= last; ++i) {
        double t = (run.lengths[i] - run.lengths[first]) / whole;
        for (int step = 0; step < 4 && i < last; ++step) t = projected(cubic, run.points[i], t);
        if (lengthOf(cubic.at(t) - run.points[i]) > tolerance) return false;
        const Place between = cubic.at(0.5 * (before + t));
        if (distanceFromChord(between, run.points[i - 1], run.points[i]) > bulge) return false;
        before = t;
    }
    return true;
}

// As long as possible, one after the other; gives up beyond `most` cubics.
std::vector<Cubic> fitGreedily(const SmoothRun& run, double tolerance, double bulge,
                               std::size_t most) {
    std::vector<Cubic> cubics;
    const std::size_t end = run.points.size() - 1;
    std::size_t guess = end;
    for (std::size_t first = 0; first < end;) {
        if (cubics.size() == most) return {};
        std::size_t good = first + 1, bad = end + 1;
        FittedCubic best = fitOne(run, first, good, tolerance);
        std::size_t trial = std::min(end, first + guess);
        while (good + 1 < bad) {
            if (trial <= good || trial >= bad) trial = (good + bad) / 2;
            const FittedCubic fitted = fitOne(run, first, trial, tolerance);
            const bool isGood = fitted.error <= tolerance &&
                                isNearAll(run, first, trial, fitted.cubic, 1.02 * tolerance, bulge);
            if (isGood) {
                good = trial;
                best = fitted;
                trial = std::min(end, first + (trial - first) * 2);
            } else {
                bad = trial;
                trial = good + (bad - good) / 2;
            }
            // A few points more or less do not matter.
            if (bad <= end && bad - good <= 1 + (good - first) / 32) break;
        }
        cubics.push_back(best.cubic);
        guess = good - first;
        first = good;
    }
    return cubics;
}

// The fewest cubics, then the smallest tolerance that does not need more.
std::vector<Cubic> fitRun(const SmoothRun& run, double tolerance, double bulge) {
    std::vector<Cubic> best = fitGreedily(run, tolerance, bulge, run.points.size());
    if (best.size() == 1) return best;
    double low = 0.1 * tolerance, high = tolerance;
    for (int step = 0; step < 3; ++step) {
        const double middle = std::sqrt(low * high);
        std::vector<Cubic> tighter = fitGreedily(run, middle, bulge, best.size());
        if (tighter.empty()) {
            low = middle;
        } else {
            high = middle;
            best = std::move(tighter);
        }
    }
    return best;
}

void appendPoint(SmoothRun& run, const Place& point, const Place& direction) {
    if (run.points.empty()) {
        run.lengths.push_back(0);
    } else {
        run.lengths.push_back(run.lengths.back() + lengthOf(point - run.points.back()));
    }
    run.points.push_back(point);
    run.directions.push_back(direction);
}

// A cubic is not to leave the curve between its points. Those and the directions tell where it is
// there, far more exactly than the chord. `apart`: of what is appended, about.
void appendBetween(SmoothRun& run, const SmoothRun& ends, double apart, int fewest) {
    constexpr int kMost = 8;
    const Place a = ends.points[0], b = ends.points[1];
    const double length = lengthOf(b - a), handle = length / 3;
    const Cubic cubic{{a, a + handle * ends.directions[0], b - handle * ends.directions[1], b}};
    const int count = std::clamp(static_cast<int>(length / apart), fewest, kMost);
    for (int k = 1; k <= count; ++k) {
        const double t = double(k) / (count + 1);
        const Place slope = cubic.slope(t);
        const double speed = lengthOf(slope);
        if (speed > 0) appendPoint(run, cubic.at(t), (1 / speed) * slope);
    }
}

// Points that are not in the same place, each with its direction.
SmoothRun runOf(const std::vector<CurvePoint>& points, std::size_t first, std::size_t last,
                double gap) {
    SmoothRun run;
    std::vector<const CurvePoint*> apart;
    double extent = 0;
    for (std::size_t i = first; i <= last; ++i) {
        extent = std::max(extent,
                          std::hypot(points[i].x - points[first].x, points[i].y - points[first].y));
    }
    for (std::size_t i = first; i <= last; ++i) {
        const CurvePoint& p = points[i];
        const bool isSame = !apart.empty() && std::hypot(p.x - apart.back()->x,
                                                         p.y - apart.back()->y) <= 1e-7 * extent;
        if (isSame) {
            // At a corner the last of several points in one place knows how the run begins, and the
            // first one how it ends.
            if (apart.size() == 1) apart.back() = &p;
            continue;
        }
        apart.push_back(&p);
    }
    if (apart.size() < 2) return run;
    // Where there are many points, and the curve turns little, a cubic is held by several of them.
    constexpr std::size_t kMany = 24;
    constexpr double kStraightOn = 0.995;
    SmoothRun pair;
    for (std::size_t k = 0; k < apart.size(); ++k) {
        const bool isLast = k + 1 == apart.size();
        const auto [x, y] = directionTowards(*apart[k], *apart[isLast ? k - 1 : k + 1]);
        const Place point{apart[k]->x, apart[k]->y};
        appendPoint(pair, point, isLast ? Place{-x, -y} : Place{x, y});
        if (k > 0) {
            const bool isHeld =
                apart.size() >= kMany && dot(pair.directions[0], pair.directions[1]) > kStraightOn;
            appendBetween(run, pair, gap, isHeld ? 0 : 1);
            pair.points.erase(pair.points.begin());
            pair.directions.erase(pair.directions.begin());
            pair.lengths.erase(pair.lengths.begin());
        }
        appendPoint(run, point, pair.directions.back());
    }
    return run;
}

// A closed curve begins at a corner if it has one.
std::vector<CurvePoint> fromCorner(const Curve& curve) {
    std::vector<CurvePoint> points = curve.points;
    if (!curve.closed) return points;
    const auto corner =
        std::find_if(points.begin(), points.end(), [](const CurvePoint& p) { return p.corner; });
    if (corner == points.end() || corner == points.begin()) return points;
    const bool isRepeated =
        points.front().x == points.back().x && points.front().y == points.back().y;
    const auto shift = corner - points.begin();
    if (isRepeated) points.pop_back();
    std::rotate(points.begin(), points.begin() + shift, points.end());
    points.push_back(points.front());
    return points;
}

}  // namespace

std::vector<std::array<double, 2>> fitCubics(const Curve& curve, double tolerance) {
    // What is not seen between points is little.
    constexpr double kShare = 0.75, kShareOfBulge = 0.8, kGap = 100;
    const double least = kShare * tolerance;
    const std::vector<CurvePoint> points = fromCorner(curve);
    std::vector<std::array<double, 2>> path;
    std::size_t first = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        if (!points[i].corner && i + 1 < points.size()) continue;
        SmoothRun run = runOf(points, first, i, kGap * tolerance);
        first = i;
        // Between corners that nobody can tell apart there is nothing to draw.
        if (run.points.size() < 2 || run.lengths.back() < 1e-3 * tolerance) continue;
        const bool isLoop =
            curve.closed && path.empty() && i + 1 == points.size() && !points.front().corner;
        // The end of a smooth loop is its start.
        if (isLoop) run.directions.back() = run.directions.front();
        for (const Cubic& cubic : fitRun(run, least, kShareOfBulge * tolerance)) {
            if (path.empty()) path.push_back(cubic.p[0]);
            path.insert(path.end(), cubic.p.begin() + 1, cubic.p.end());
        }
    }
    if (curve.closed && !path.empty()) path.back() = path.front();
    return path;
}

}  // namespace bandvox
