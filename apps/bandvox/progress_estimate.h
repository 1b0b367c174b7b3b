#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bandvox::app {

/// A stage that a command is expected to go through.
struct ExpectedStage {
    std::string name;
    double weight = 1;  ///< share of the time that it usually takes, in any unit
    int times = 1;      ///< one after another, each of this weight
};

/// How far a command is as a whole, from the stages that it is expected to go through, in their
/// order. Stages that do not come are passed over when a later one begins; those that nobody
/// expected, or more often than expected, leave it where it is. It never goes back.
class ProgressEstimate {
  public:
    /// The stages from now on, of a command that begins.
    void expect(const std::vector<ExpectedStage>& stages);

    /// A stage begins, or the innermost one ends.
    void begin(std::string_view stage);
    void end();

    /// The innermost expected stage that goes on, counted from the outermost stage of all.
    std::optional<std::size_t> openStage() const;

    /// Part of the command that is done, 0 to 1, when `part` of openStage() is.
    double at(double part);

  private:
    struct Slot {
        std::string name;
        double begin = 0, end = 0;
    };
    std::vector<Slot> mSlots;
    std::size_t mNext = 0;                          // the first slot that has not begun
    std::vector<std::optional<std::size_t>> mOpen;  // slots of the stages that go on
    double mDone = 0;
};

}  // namespace bandvox::app
