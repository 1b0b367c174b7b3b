#include "choose_grid.h"

#include "words.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <type_traits>
#include <utility>
#include <vector>

namespace bandvox::app {
namespace {

// The names of a file's grids with their numbers among those of that name.
std::vector<std::string> numberedNames(const openvdb::GridPtrVec& grids) {
    std::map<std::string, int> numbers;
    std::vector<std::string> names;
    for (const auto& grid : grids) {
        std::string name = grid->getName();
        name += "[" + std::to_string(numbers[grid->getName()]++) + "]";
        names.push_back(name);
    }
    return names;
}

// The names that tell a file's grids from each other: with their numbers where there are several
// of a name, where a name is what another grid has with its number, and where there is none.
std::vector<std::string> uniqueNames(const openvdb::GridPtrVec& grids) {
    std::vector<std::string> names = numberedNames(grids);
    std::map<std::string, int> counts;
    for (const auto& grid : grids) ++counts[grid->getName()];
    std::set<std::string> taken{""};
    for (std::size_t i = 0; i < grids.size(); ++i) {
        if (counts[grids[i]->getName()] > 1) taken.insert(names[i]);
    }
    for (std::size_t i = 0; i < grids.size(); ++i) {
        const std::string name = grids[i]->getName();
        if (counts[name] == 1 && !taken.contains(name)) names[i] = name;
    }
    return names;
}

std::string listed(const openvdb::GridPtrVec& grids) {
    if (grids.empty()) return "no grids";
    const std::vector<std::string> unique = uniqueNames(grids);
    std::vector<std::string> names;
    for (std::size_t i = 0; i < grids.size(); ++i) {
        names.push_back("'" + unique[i] + "' (" + grids[i]->valueType() + ")");
    }
    return "the grids " + joined(names, ", ");
}

[[noreturn]] void fail(const openvdb::GridPtrVec& grids, const std::string& file,
                       const std::string& expected) {
    throw Error(ErrorKind::Input, "'" + file + "' has " + listed(grids) + "; expected " + expected);
}

openvdb::FloatGrid::Ptr asFloats(const openvdb::GridBase::Ptr& grid) {
    if (auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grid)) return floats;
    const auto doubles = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid);
    return doubles ? std::make_shared<openvdb::FloatGrid>(*doubles) : nullptr;
}

openvdb::Vec3SGrid::Ptr asColors(const openvdb::GridBase::Ptr& grid) {
    return openvdb::gridPtrCast<openvdb::Vec3SGrid>(grid);
}

// The one grid that `convert` takes and that has a name; null if there is none.
template <typename Convert>
auto named(const openvdb::GridPtrVec& grids, const std::string& name, const std::string& file,
           const Convert& convert) {
    const std::vector<std::string> unique = uniqueNames(grids), numbered = numberedNames(grids);
    decltype(convert(openvdb::GridBase::Ptr())) found;
    // What the name tells from all others comes first.
    const auto itself = std::find(unique.begin(), unique.end(), name);
    if (itself != unique.end()) found = convert(grids[std::size_t(itself - unique.begin())]);
    if (found) return found;
    for (std::size_t i = 0; i < grids.size(); ++i) {
        if (numbered[i] != name && grids[i]->getName() != name) continue;
        const auto grid = convert(grids[i]);
        if (!grid) continue;
        if (found) fail(grids, file, "one of them by its number, as in '" + unique[i] + "'");
        found = grid;
    }
    return found;
}

}  // namespace

openvdb::GridBase::Ptr chooseGrid(const openvdb::GridPtrVec& grids, const std::string& name,
                                  const std::string& file) {
    auto found = named(grids, name, file, [](const openvdb::GridBase::Ptr& grid) { return grid; });
    if (!found) fail(grids, file, "a grid '" + name + "'");
    return found;
}

openvdb::FloatGrid::Ptr asFloatGrid(const openvdb::GridBase::Ptr& grid) {
    if (auto floats = asFloats(grid)) return floats;
    openvdb::FloatGrid::Ptr result;
    const auto take = [&result](const auto& other) {
        using Tree = typename std::decay_t<decltype(other)>::TreeType;
        if constexpr (std::is_same_v<typename Tree::ValueType, bool>) {
            // OpenVDB copies values of trees of truths only to their own kind.
            auto tree = std::make_shared<openvdb::FloatTree>(other.tree(), 0.0F, 1.0F,
                                                             openvdb::TopologyCopy());
            result = openvdb::FloatGrid::create(tree);
        } else {
            result = std::make_shared<openvdb::FloatGrid>(other);
        }
    };
    if (const auto bools = openvdb::gridPtrCast<openvdb::BoolGrid>(grid)) take(*bools);
    if (const auto mask = openvdb::gridPtrCast<openvdb::MaskGrid>(grid)) take(*mask);
    if (const auto whole = openvdb::gridPtrCast<openvdb::Int32Grid>(grid)) take(*whole);
    if (result) {
        result->setTransform(grid->transformPtr());
        static_cast<openvdb::MetaMap&>(*result) = static_cast<const openvdb::MetaMap&>(*grid);
    }
    return result;
}

openvdb::FloatGrid::Ptr findFloatGrid(const openvdb::GridPtrVec& grids,
                                      const std::optional<std::string>& name,
                                      const std::string& standard, const std::string& file) {
    auto found = named(grids, name.value_or(standard), file, asFloats);
    if (!found && name) fail(grids, file, "a float grid '" + *name + "'");
    return found;
}

openvdb::FloatGrid::Ptr chooseFloatGrid(const openvdb::GridPtrVec& grids,
                                        const std::optional<std::string>& name,
                                        const std::string& standard, const std::string& file) {
    if (auto found = findFloatGrid(grids, name, standard, file)) return found;
    openvdb::FloatGrid::Ptr only;
    for (const auto& grid : grids) {
        auto floats = asFloats(grid);
        if (!floats) continue;
        if (only) {
            only = nullptr;
            break;
        }
        only = floats;
    }
    if (only) return only;
    fail(grids, file,
         "a float grid '" + standard + "', or one float grid only, or the name of one (grid)");
}

openvdb::Vec3SGrid::Ptr chooseColorGrid(const openvdb::GridPtrVec& grids,
                                        const std::optional<std::string>& name,
                                        const std::string& file) {
    auto found = named(grids, name.value_or("Cd"), file, asColors);
    if (!found && name) fail(grids, file, "a grid '" + *name + "' of vectors of floats");
    return found;
}

}  // namespace bandvox::app
