#pragma once

#include <cstdint>
#include <string_view>

namespace bandvox {

/// How long work tells its caller how far it is, and asks whether to go on.
///
/// The base class is silent and never stops; the command line and the language bindings derive
/// from it. `advance` and `interrupted` are called from many threads at once, `begin` and `end`
/// from one.
class Progress {
  public:
    Progress() = default;
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    virtual ~Progress() = default;

    /// A stage of the work starts. `steps` is how many times one is added to it until it is
    /// done; 0 if that is not known.
    virtual void begin(std::string_view stage, std::int64_t steps);
    virtual void advance(std::int64_t steps = 1);
    virtual void end();

    /// True as soon as the caller wants the work to stop.
    virtual bool interrupted() const;

    /// Throws Error(ErrorKind::Interrupted) if the caller wants the work to stop.
    void throwIfInterrupted() const;
};

/// A Progress for callers that do not care.
Progress& silentProgress();

/// Names a stage of the work for as long as it lives.
class ProgressStage {
  public:
    ProgressStage(Progress& progress, std::string_view stage, std::int64_t steps)
        : mProgress(progress) {
        mProgress.begin(stage, steps);
    }
    ProgressStage(const ProgressStage&) = delete;
    ProgressStage& operator=(const ProgressStage&) = delete;
    ~ProgressStage() { mProgress.end(); }

  private:
    Progress& mProgress;
};

}  // namespace bandvox
