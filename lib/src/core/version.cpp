#include "core/version.h"

#include <bandvox/core/version.h>

namespace bandvox {

const char* version() {
    return kVersion;
}

}  // namespace bandvox
