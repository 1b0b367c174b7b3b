#include "scatter/column_scale.h"

#include <bandvox/core/error.h>
#include <bandvox/scatter/scattered_points.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

namespace bandvox {
namespace {

std::string shownPlace(const ScatteredPoints& points, std::size_t i) {
    std::ostringstream text;
    text.precision(10);
    text << "(" << points.x[i] << ", " << points.y[i];
    if (points.isInSpace()) text << ", " << points.z[i];
    text << ")";
    return text.str();
}

void checkPoints(const ScatteredPoints& points) {
    const std::size_t expected =
        points.x.size() * static_cast<std::size_t>(std::max(points.columns, 0));
    const bool isInSpace = points.isInSpace();
    if (points.columns < 1 || points.y.size() != points.x.size() ||
        (isInSpace && points.z.size() != points.x.size()) || points.values.size() != expected) {
        std::string message = "points have ";
        message += std::to_string(points.x.size()) + " x, ";
        message += std::to_string(points.y.size()) + " y, ";
        if (isInSpace) message += std::to_string(points.z.size()) + " z, ";
        message += std::to_string(points.values.size()) + " values in ";
        message += std::to_string(points.columns) + " columns; expected as many in each column";
        throw Error(ErrorKind::Usage, message);
    }
    const auto isFinite = [](double number) { return std::isfinite(number); };
    for (const auto* numbers : {&points.x, &points.y, &points.z, &points.values}) {
        if (std::all_of(numbers->begin(), numbers->end(), isFinite)) continue;
        throw Error(ErrorKind::Input, "points have a number that is not finite; expected none");
    }
}

std::vector<double> columnRanges(const ScatteredPoints& points) {
    std::vector<double> ranges;
    for (int column = 0; column < points.columns; ++column) {
        double low = points.value(0, column);
        double high = low;
        for (std::size_t i = 1; i < points.size(); ++i) {
            low = std::min(low, points.value(i, column));
            high = std::max(high, points.value(i, column));
        }
        ranges.push_back(high - low);
    }
    return ranges;
}

/// The points by x, those alike by y and z, and those in one place by their order.
std::vector<std::size_t> orderOfPlaces(const ScatteredPoints& points) {
    // What is compared lies side by side, which takes a third of the time.
    struct Place {
        double x, y, z;
        std::size_t index;
    };
    std::vector<Place> places(points.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        places[i] = {points.x[i], points.y[i], points.isInSpace() ? points.z[i] : 0, i};
    }
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
        if (a.x != b.x) return a.x < b.x;
        if (a.y != b.y) return a.y < b.y;
        return a.z != b.z ? a.z < b.z : a.index < b.index;
    });
    std::vector<std::size_t> order(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) order[i] = places[i].index;
    return order;
}

/// Appends the average of the points order[begin, end), which are in one place.
void appendAverage(const ScatteredPoints& points, const std::vector<std::size_t>& order,
                   std::size_t begin, std::size_t end, MergedPoints& merged) {
    merged.points.x.push_back(points.x[order[begin]]);
    merged.points.y.push_back(points.y[order[begin]]);
    if (points.isInSpace()) merged.points.z.push_back(points.z[order[begin]]);
    if (!points.lines.empty()) merged.points.lines.push_back(points.lines[order[begin]]);
    merged.weight.push_back(static_cast<double>(end - begin));
    merged.duplicates += end - begin - 1;
    for (int column = 0; column < points.columns; ++column) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i) sum += points.value(order[i], column);
        // One value stays what it is, bit for bit.
        merged.points.values.push_back(sum / static_cast<double>(end - begin));
    }
}

bool isSamePlace(const ScatteredPoints& points, std::size_t i, std::size_t j) {
    return points.x[i] == points.x[j] && points.y[i] == points.y[j] &&
           (!points.isInSpace() || points.z[i] == points.z[j]);
}

std::string nameOfColumn(const ScatteredPoints& points, int column) {
    const auto index = static_cast<std::size_t>(column);
    if (index < points.names.size()) return points.names[index];
    return "value " + std::to_string(column + 1);
}

void checkAgreement(const ScatteredPoints& points, const std::vector<std::size_t>& order,
                    std::size_t begin, std::size_t end, const std::vector<double>& allowed) {
    for (int column = 0; column < points.columns; ++column) {
        std::size_t least = order[begin];
        std::size_t most = least;
        for (std::size_t i = begin + 1; i < end; ++i) {
            if (points.value(order[i], column) < points.value(least, column)) least = order[i];
            if (points.value(order[i], column) > points.value(most, column)) most = order[i];
        }
        const double low = points.value(least, column);
        const double high = points.value(most, column);
        if (high - low <= allowed[static_cast<std::size_t>(column)]) continue;
        std::ostringstream text;
        text.precision(10);
        text << "the place " << shownPlace(points, order[begin]) << " has values from " << low
             << lineOfPoint(points, least) << " to " << high << lineOfPoint(points, most) << " in "
             << nameOfColumn(points, column)
             << "; expected one value, or such as differ by no more than "
             << allowed[static_cast<std::size_t>(column)];
        throw Error(ErrorKind::Input, text.str());
    }
}

}  // namespace

std::string lineOfPoint(const ScatteredPoints& points, std::size_t i) {
    if (points.lines.empty()) return {};
    return " (" + points.lineWord + " " + std::to_string(points.lines[i]) + ")";
}

ColumnScale scaleOfColumn(const ScatteredPoints& points, int column) {
    double low = points.value(0, column);
    double high = low;
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double value = points.value(i, column);
        low = std::min(low, value);
        high = std::max(high, value);
        sum += value / static_cast<double>(points.size());
    }
    const double range = high > low ? high - low : 1;
    if (!std::isfinite(range) || !std::isfinite(sum)) {
        throw Error(ErrorKind::Input,
                    "the values of column " + std::to_string(column + 1) +
                        " are so far apart that their range is no number; expected less than "
                        "1.8e308");
    }
    return {sum, range};
}

MergedPoints mergeDuplicates(const ScatteredPoints& points, double tolerance) {
    checkPoints(points);
    MergedPoints merged;
    merged.points.columns = points.columns;
    merged.points.lineWord = points.lineWord;
    if (points.size() == 0) return merged;
    std::vector<double> allowed = columnRanges(points);
    for (double& range : allowed) range *= tolerance;
    const std::vector<std::size_t> order = orderOfPlaces(points);
    merged.points.x.reserve(points.size());
    merged.points.y.reserve(points.size());
    merged.points.values.reserve(points.values.size());
    merged.weight.reserve(points.size());
    for (std::size_t begin = 0; begin < order.size();) {
        std::size_t end = begin + 1;
        while (end < order.size() && isSamePlace(points, order[begin], order[end])) ++end;
        if (tolerance >= 0 && end - begin > 1) checkAgreement(points, order, begin, end, allowed);
        appendAverage(points, order, begin, end, merged);
        begin = end;
    }
    return merged;
}

Rectangle boundingRectangle(const ScatteredPoints& points) {
    if (points.size() == 0) throw Error(ErrorKind::Input, "there are no points; expected some");
    const auto [x0, x1] = std::minmax_element(points.x.begin(), points.x.end());
    const auto [y0, y1] = std::minmax_element(points.y.begin(), points.y.end());
    Rectangle rectangle{*x0, *y0, *x1, *y1};
    const double longest = std::max(rectangle.width(), rectangle.height());
    if (!(longest > 0)) {
        throw Error(ErrorKind::Input, "the points are all at " + shownPlace(points, 0) +
                                          "; expected two places at least");
    }
    constexpr double kFlattest = 1.0 / 1024;
    const auto widen = [&](double& low, double& high) {
        const double lacks = longest * kFlattest - (high - low);
        if (lacks <= 0) return;
        low -= lacks / 2;
        high += lacks / 2;
    };
    widen(rectangle.x0, rectangle.x1);
    widen(rectangle.y0, rectangle.y1);
    return rectangle;
}

}  // namespace bandvox
