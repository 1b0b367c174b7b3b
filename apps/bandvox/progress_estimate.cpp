#include "progress_estimate.h"

#include <algorithm>

namespace bandvox::app {

void ProgressEstimate::expect(const std::vector<ExpectedStage>& stages) {
    mSlots.clear();
    mNext = 0;
    mDone = 0;
    double total = 0;
    for (const ExpectedStage& stage : stages) {
        for (int i = 0; i < stage.times; ++i) {
            mSlots.push_back({stage.name, total, total + stage.weight});
            total += stage.weight;
        }
    }
    for (Slot& slot : mSlots) {
        slot.begin /= total;
        slot.end /= total;
    }
}

void ProgressEstimate::begin(std::string_view stage) {
    const auto found =
        std::find_if(mSlots.begin() + static_cast<std::ptrdiff_t>(mNext), mSlots.end(),
                     [&](const Slot& slot) { return slot.name == stage; });
    if (found == mSlots.end()) {
        mOpen.emplace_back();
        return;
    }
    const auto index = static_cast<std::size_t>(found - mSlots.begin());
    mNext = index + 1;
    mOpen.emplace_back(index);
    mDone = std::max(mDone, found->begin);
}

void ProgressEstimate::end() {
    if (mOpen.empty()) return;
    if (mOpen.back()) mDone = std::max(mDone, mSlots[*mOpen.back()].end);
    mOpen.pop_back();
}

std::optional<std::size_t> ProgressEstimate::openStage() const {
    for (std::size_t i = mOpen.size(); i-- > 0;) {
        if (mOpen[i]) return i;
    }
    return std::nullopt;
}

double ProgressEstimate::at(double part) {
    if (const auto open = openStage()) {
        const Slot& slot = mSlots[*mOpen[*open]];
        mDone = std::max(mDone, slot.begin + (slot.end - slot.begin) * std::clamp(part, 0.0, 1.0));
    }
    return mDone;
}

}  // namespace bandvox::app
