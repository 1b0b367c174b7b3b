#pragma once

#include <cmath>

namespace bandvox {

/// A sum of many numbers whose rounding error does not grow with their count.
/// A. Neumaier: "Rundungsfehleranalyse einiger Verfahren zur Summation endlicher Summen" (1974).
class CompensatedSum {
  public:
    void add(double x) {
        const double sum = mSum + x;
        mRest += std::abs(mSum) >= std::abs(x) ? (mSum - sum) + x : (x - sum) + mSum;
        mSum = sum;
    }
    void add(const CompensatedSum& other) {
        add(other.mSum);
        mRest += other.mRest;
    }
    double value() const { return mSum + mRest; }

  private:
    double mSum = 0;
    double mRest = 0;
};

}  // namespace bandvox
