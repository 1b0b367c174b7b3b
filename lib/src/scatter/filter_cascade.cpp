#include "scatter/filter_cascade.h"

#include <utility>

namespace bandvox {
namespace {

constexpr double kMiddle = 2.0 / 3;
constexpr double kBeside = 1.0 / 6;

void addRow(std::vector<double>& sum, double weight, const std::vector<double>& row) {
    sum.resize(row.size());
    for (std::size_t i = 0; i < row.size(); ++i) sum[i] += weight * row[i];
}

}  // namespace

std::vector<double> filterLine(std::vector<double> line, std::size_t cells) {
    while (line.size() - 1 > cells) {
        const std::size_t last = line.size() - 1;
        std::vector<double> half(last / 2 + 1);
        for (std::size_t j = 0; j < half.size(); ++j) {
            const double before = line[j == 0 ? 0 : 2 * j - 1];
            const double after = line[2 * j == last ? last : 2 * j + 1];
            half[j] = kBeside * before + kMiddle * line[2 * j] + kBeside * after;
        }
        line = std::move(half);
    }
    return line;
}

RowCascade::RowCascade(std::size_t cells, std::size_t fewer, Sink sink) : mSink(std::move(sink)) {
    for (; cells > fewer; cells /= 2) mStages.push_back({.cells = cells});
}

void RowCascade::push(std::size_t stage, const std::vector<double>& row) {
    if (stage == mStages.size()) {
        mSink(row);
        return;
    }
    Stage& own = mStages[stage];
    const std::size_t number = own.next++;
    const auto emit = [&] {
        const std::vector<double> made = std::exchange(own.sum, {});
        push(stage + 1, made);
    };
    if (number % 2 == 1) {
        addRow(own.sum, kBeside, row);
        own.before = row;
        emit();
        return;
    }
    addRow(own.sum, kMiddle, row);
    addRow(own.sum, kBeside, number == 0 ? row : own.before);
    if (number == own.cells) {
        addRow(own.sum, kBeside, row);
        emit();
    }
}

}  // namespace bandvox
