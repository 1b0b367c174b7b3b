// Pixar: "Universal Scene Description", its schemas Volume, FieldAsset and OpenVDBAsset of UsdVol.
#include <bandvox/core/atomic_file.h>
#include <bandvox/core/error.h>
#include <bandvox/grid/write_usd_volume.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <locale>
#include <set>
#include <sstream>
#include <vector>

namespace bandvox {
namespace {

struct UsdField {
    std::string identifier;
    openvdb::GridBase::ConstPtr grid;
};

std::string identifierOf(const std::string& name) {
    std::string identifier;
    for (const char c : name) {
        identifier += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    }
    const bool isBegun =
        !identifier.empty() && std::isdigit(static_cast<unsigned char>(identifier.front())) == 0;
    return isBegun ? identifier : "_" + identifier;
}

std::vector<UsdField> fieldsOf(const openvdb::GridCPtrVec& grids) {
    std::vector<UsdField> fields;
    std::set<std::string> taken;
    for (const auto& grid : grids) {
        const std::string stem = identifierOf(grid->getName());
        std::string identifier = stem;
        for (int i = 2; !taken.insert(identifier).second; ++i) {
            identifier = stem + "_" + std::to_string(i);
        }
        fields.push_back({identifier, grid});
    }
    return fields;
}

/// A text in quotes.
std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        if (c == '\n') {
            result += "\\n";
        } else {
            result += c;
        }
    }
    return result + "\"";
}

/// A path between the marks of an asset, of which three allow for one within.
std::string assetPath(const std::string& path) {
    if (path.find('\n') != std::string::npos || path.find("@@@") != std::string::npos) {
        throw Error(ErrorKind::Usage, "the name '" + path +
                                          "' cannot stand in a .usda file; expected one without "
                                          "line ends and \"@@@\"");
    }
    const bool isRelative = !path.starts_with("/");
    const std::string marks = path.find('@') == std::string::npos ? "@" : "@@@";
    return marks + (isRelative ? "./" : "") + path + marks;
}

/// What FieldAsset calls the type of the values; empty if it has no word for it.
std::string dataType(const openvdb::GridBase& grid, bool half) {
    std::string type = grid.valueType();
    const bool isHalf = half || grid.saveFloatAsHalf();
    if (type == "float") return isHalf ? "half" : type;
    if (type == "vec3s") return isHalf ? "half3" : "float3";
    if (type == "vec3d") return "double3";
    if (type == "vec3i") return "int3";
    if (type == "int32") return "int";
    if (type == "double" || type == "bool" || type == "int64" || type == "mask") return type;
    return "";
}

std::string fieldClass(const openvdb::GridBase& grid) {
    switch (grid.getGridClass()) {
        case openvdb::GRID_LEVEL_SET:
            return "levelSet";
        case openvdb::GRID_FOG_VOLUME:
            return "fogVolume";
        case openvdb::GRID_STAGGERED:
            return "staggered";
        default:
            return "unknown";
    }
}

/// What the vectors of a grid are; empty for numbers.
std::string vectorRole(const openvdb::GridBase& grid) {
    if (!grid.valueType().starts_with("vec3")) return "";
    if (grid.getName() == "Cd") return "Color";
    switch (grid.getVectorType()) {
        case openvdb::VEC_COVARIANT:
        case openvdb::VEC_COVARIANT_NORMALIZE:
            return "Normal";
        case openvdb::VEC_CONTRAVARIANT_ABSOLUTE:
            return "Point";
        case openvdb::VEC_CONTRAVARIANT_RELATIVE:
            return "Vector";
        default:
            return "None";
    }
}

openvdb::BBoxd boxInWorld(const openvdb::GridCPtrVec& grids) {
    openvdb::BBoxd world;
    for (const auto& grid : grids) {
        const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
        if (box.empty()) continue;
        const openvdb::Vec3d low = box.min().asVec3d() - openvdb::Vec3d(0.5);
        const openvdb::Vec3d high = box.max().asVec3d() + openvdb::Vec3d(0.5);
        for (int corner = 0; corner < 8; ++corner) {
            const openvdb::Vec3d place((corner & 1) != 0 ? high[0] : low[0],
                                       (corner & 2) != 0 ? high[1] : low[1],
                                       (corner & 4) != 0 ? high[2] : low[2]);
            world.expand(grid->indexToWorld(place));
        }
    }
    if (world.empty()) {
        throw Error(ErrorKind::Result, "no grid has an active voxel; expected one that has");
    }
    return world;
}

/// Numbers that are read as floats, rounded outward.
void writeCorner(std::ostream& stream, const openvdb::Vec3d& place, bool isHigh) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        auto number = static_cast<float>(place[axis]);
        const bool isWithin = isHigh ? number < place[axis] : number > place[axis];
        if (isWithin) number = std::nextafter(number, isHigh ? kInfinity : -kInfinity);
        stream << (axis == 0 ? "(" : ", ") << number;
    }
    stream << ')';
}

void writeField(std::ostream& stream, const UsdField& field, const std::string& asset, bool half) {
    const openvdb::GridBase& grid = *field.grid;
    stream << "\n    def OpenVDBAsset \"" << field.identifier << "\"\n    {\n"
           << "        asset filePath = " << asset << '\n'
           << "        token fieldName = " << quoted(grid.getName()) << '\n'
           << "        token fieldClass = \"" << fieldClass(grid) << "\"\n";
    if (const std::string type = dataType(grid, half); !type.empty()) {
        stream << "        token fieldDataType = \"" << type << "\"\n";
    }
    if (const std::string role = vectorRole(grid); !role.empty()) {
        stream << "        token vectorDataRoleHint = \"" << role << "\"\n";
    }
    stream << "    }\n";
}

}  // namespace

void writeUsdVolume(AtomicFile& file, const std::string& vdb, const openvdb::GridCPtrVec& grids,
                    bool half) {
    if (grids.empty()) throw Error(ErrorKind::Usage, "found no grid; expected one at least");
    const std::string asset = assetPath(vdb);
    const openvdb::BBoxd box = boxInWorld(grids);
    const std::vector<UsdField> fields = fieldsOf(grids);
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(std::numeric_limits<float>::max_digits10);
    text << "#usda 1.0\n(\n    defaultPrim = \"Volume\"\n    metersPerUnit = 1\n"
         << "    upAxis = \"Y\"\n)\n\ndef Volume \"Volume\"\n{\n    float3[] extent = [";
    writeCorner(text, box.min(), false);
    text << ", ";
    writeCorner(text, box.max(), true);
    text << "]\n";
    for (const UsdField& field : fields) {
        text << "    rel field:" << field.identifier << " = </Volume/" << field.identifier << ">\n";
    }
    for (const UsdField& field : fields) writeField(text, field, asset, half);
    text << "}\n";
    std::ofstream stream = file.open();
    stream << text.str();
    stream.close();
    if (!stream) {
        throw Error(ErrorKind::Runtime,
                    "cannot write '" + file.target().string() + "'; is there room?");
    }
}

}  // namespace bandvox
