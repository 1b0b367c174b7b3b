#include <bandvox/core/error.h>
#include <bandvox/core/progress.h>

namespace bandvox {

void Progress::begin(std::string_view /*stage*/, std::int64_t /*steps*/) {}
void Progress::advance(std::int64_t /*steps*/) {}
void Progress::end() {}
bool Progress::interrupted() const {
    return false;
}

void Progress::throwIfInterrupted() const {
    if (interrupted()) throw Error(ErrorKind::Interrupted, "interrupted");
}

Progress& silentProgress() {
    static Progress silent;
    return silent;
}

}  // namespace bandvox
