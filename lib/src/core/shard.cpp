#include <bandvox/core/error.h>
#include <bandvox/core/shard.h>

#include <string>

namespace bandvox {

void requireValid(const Shard& shard) {
    constexpr int kMostShards = 100'000;
    if (shard.index >= 1 && shard.index <= shard.count && shard.count <= kMostShards) return;
    throw Error(ErrorKind::Usage,
                "part " + std::to_string(shard.index) + " of " + std::to_string(shard.count) +
                    " parts; expected one of 1 to " + std::to_string(kMostShards));
}

}  // namespace bandvox
