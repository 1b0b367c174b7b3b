// Autodesk's Drawing Exchange Format of AutoCAD 2004 (AC1018), as far as splines on layers need it.
// Autodesk, "DXF Reference", 2011.

#include "outline/files/paint_layers.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace bandvox {
namespace {

// Records that others refer to: their handles are given in advance.
constexpr std::string_view kBlockTable = "1", kModelRecord = "2", kPaperRecord = "3";
constexpr std::string_view kRoot = "4", kGroups = "5";
constexpr unsigned kFirstHandle = 0x10;

constexpr std::string_view kDashes = "HIDDEN_LINES";

/// The lines of a file: group codes, each with its value.
class DxfText {
  public:
    void put(int code, std::string_view value) {
        mText += std::to_string(code) + "\n";
        mText += value;
        mText += '\n';
    }
    void put(int code, int value) { put(code, std::to_string(value)); }
    void put(int code, double value) { put(code, plainNumber(value)); }

    void point(int code, double x, double y, double z = 0) {
        put(code, x);
        put(code + 10, y);
        put(code + 20, z);
    }

    // A record with a handle of its own, and the classes that it is of.
    void record(std::string_view type, std::string_view owner,
                std::initializer_list<std::string_view> classes, std::string_view handle = {}) {
        put(0, type);
        put(5, handle.empty() ? nextHandle() : std::string(handle));
        put(330, owner);
        for (const std::string_view name : classes) put(100, name);
    }

    // The start of a table; its handle, to which its records belong.
    std::string table(std::string_view type, int count, std::string_view known = {}) {
        put(0, "TABLE");
        put(2, type);
        std::string handle = known.empty() ? nextHandle() : std::string(known);
        put(5, handle);
        put(330, "0");
        put(100, "AcDbSymbolTable");
        put(70, count);
        return handle;
    }
    void endTable() { put(0, "ENDTAB"); }

    void section(std::string_view name) {
        put(0, "SECTION");
        put(2, name);
    }
    void endSection() { put(0, "ENDSEC"); }

    std::string nextHandle() {
        std::array<char, 16> digits{};
        char* const end =
            std::to_chars(digits.data(), digits.data() + digits.size(), mHandle++, 16).ptr;
        std::string handle(digits.data(), end);
        std::transform(handle.begin(), handle.end(), handle.begin(),
                       [](char c) { return c >= 'a' ? static_cast<char>(c - 'a' + 'A') : c; });
        return handle;
    }

    const std::string& text() const { return mText; }

  private:
    std::string mText;
    unsigned mHandle = kFirstHandle;
};

// Names of layers have no characters that search patterns or lists have, and no bytes beyond ASCII.
std::string layerName(const Outline& outline, const PaintLayer& layer) {
    std::string name = objectName(outline, layer.object);
    for (char& c : name) {
        const auto code = static_cast<unsigned char>(c);
        const bool isPlain = code >= 0x20 && code < 0x7F &&
                             std::string_view("<>/\\\":;?*|=,'`").find(c) == std::string_view::npos;
        if (!isPlain) c = '_';
    }
    constexpr std::size_t kLongest = 200;
    name = name.substr(0, kLongest);
    // Objects may have the same name.
    name += " " + std::to_string(layer.object + 1);
    name += " " + layer.sightName();
    name += " " + layer.kindName();
    return name;
}

int trueColor(const std::string& color) {
    int value = 0;
    for (const double c : parsedColor(color)) {
        value = 256 * value + static_cast<int>(std::lround(255 * c));
    }
    return value;
}

// The width of a line in hundredths of a millimetre: one of those that the format has.
int lineWeight(double width) {
    constexpr std::array kWeights{0,  5,  9,  13, 15, 18,  20,  25,  30,  35,  40,  50,
                                  53, 60, 70, 80, 90, 100, 106, 120, 140, 158, 200, 211};
    const auto away = [&](int weight) { return std::abs(weight - 100 * width); };
    return *std::min_element(kWeights.begin(), kWeights.end(),
                             [&](int a, int b) { return away(a) < away(b); });
}

void putHeader(DxfText& dxf, const Outline& outline) {
    dxf.section("HEADER");
    const auto variable = [&](std::string_view name, int code, std::string_view value) {
        dxf.put(9, name);
        dxf.put(code, value);
    };
    variable("$ACADVER", 1, "AC1018");
    variable("$DWGCODEPAGE", 3, "ANSI_1252");
    variable("$INSUNITS", 70, "4");  // millimetres
    variable("$MEASUREMENT", 70, "1");
    variable("$LWDISPLAY", 290, "1");
    dxf.put(9, "$EXTMIN");
    dxf.point(10, 0, 0);
    dxf.put(9, "$EXTMAX");
    dxf.point(10, outline.width, outline.height);
    variable("$HANDSEED", 5, "FFFFFFF");  // above all that are in use
    dxf.endSection();
}

void putView(DxfText& dxf, const Outline& outline) {
    const std::string table = dxf.table("VPORT", 1);
    dxf.record("VPORT", table, {"AcDbSymbolTableRecord", "AcDbViewportTableRecord"});
    dxf.put(2, "*Active");
    dxf.put(70, 0);
    const auto corner = [&](int code, double x, double y) {
        dxf.put(code, x);
        dxf.put(code + 10, y);
    };
    corner(10, 0, 0);
    corner(11, 1, 1);
    corner(12, 0.5 * outline.width, 0.5 * outline.height);
    dxf.point(16, 0, 0, 1);
    dxf.point(17, 0, 0);
    dxf.put(40, outline.height);
    dxf.put(41, outline.width / outline.height);
    dxf.endTable();
}

void putLineTypes(DxfText& dxf, const StrokeOptions& options) {
    const std::string table = dxf.table("LTYPE", 4);
    const auto begin = [&](std::string_view name) {
        dxf.record("LTYPE", table, {"AcDbSymbolTableRecord", "AcDbLinetypeTableRecord"});
        dxf.put(2, name);
        dxf.put(70, 0);
        dxf.put(3, "");
        dxf.put(72, 65);
    };
    for (const std::string_view name : {"ByBlock", "ByLayer", "Continuous"}) {
        begin(name);
        dxf.put(73, 0);
        dxf.put(40, 0);
    }
    // Gaps are lengths below 0. Of an odd number of lengths every other turn begins with a gap.
    std::vector<double> dashes = parsedDash(options.dash);
    if (dashes.size() % 2 == 1) {
        const std::vector<double> turn = dashes;
        dashes.insert(dashes.end(), turn.begin(), turn.end());
    }
    begin(kDashes);
    dxf.put(73, static_cast<int>(dashes.size()));
    double whole = 0;
    for (const double length : dashes) whole += length;
    dxf.put(40, whole);
    for (std::size_t k = 0; k < dashes.size(); ++k) {
        dxf.put(49, k % 2 == 0 ? dashes[k] : -dashes[k]);
        dxf.put(74, 0);
    }
    dxf.endTable();
}

void putLayers(DxfText& dxf, const Outline& outline, const std::vector<PaintLayer>& layers,
               const StrokeOptions& options) {
    const std::string table = dxf.table("LAYER", static_cast<int>(layers.size()) + 1);
    const auto begin = [&](std::string_view name) {
        dxf.record("LAYER", table, {"AcDbSymbolTableRecord", "AcDbLayerTableRecord"});
        dxf.put(2, name);
        dxf.put(70, 0);
        dxf.put(62, 7);  // for those who do not know true colours
    };
    begin("0");
    dxf.put(6, "Continuous");
    for (const PaintLayer& layer : layers) {
        begin(layerName(outline, layer));
        dxf.put(420, trueColor(layer.visible ? options.color : options.hiddenColor));
        dxf.put(6, layer.visible ? std::string_view("Continuous") : kDashes);
        dxf.put(370, lineWeight(layer.visible ? options.width : options.hiddenWidth));
    }
    dxf.endTable();
}

void putSmallTables(DxfText& dxf) {
    const std::string styles = dxf.table("STYLE", 1);
    dxf.record("STYLE", styles, {"AcDbSymbolTableRecord", "AcDbTextStyleTableRecord"});
    dxf.put(2, "Standard");
    dxf.put(70, 0);
    dxf.put(40, 0);
    dxf.put(41, 1);
    dxf.put(3, "txt");
    dxf.put(4, "");
    dxf.endTable();
    for (const std::string_view name : {"VIEW", "UCS"}) {
        dxf.table(name, 0);
        dxf.endTable();
    }
    const std::string names = dxf.table("APPID", 1);
    dxf.record("APPID", names, {"AcDbSymbolTableRecord", "AcDbRegAppTableRecord"});
    dxf.put(2, "ACAD");
    dxf.put(70, 0);
    dxf.endTable();
    dxf.table("DIMSTYLE", 0);
    dxf.put(100, "AcDbDimStyleTable");
    dxf.endTable();
    dxf.table("BLOCK_RECORD", 2, kBlockTable);
    const auto blockRecord = [&](std::string_view name, std::string_view handle) {
        dxf.record("BLOCK_RECORD", kBlockTable, {"AcDbSymbolTableRecord", "AcDbBlockTableRecord"},
                   handle);
        dxf.put(2, name);
    };
    blockRecord("*Model_Space", kModelRecord);
    blockRecord("*Paper_Space", kPaperRecord);
    dxf.endTable();
}

void putBlocks(DxfText& dxf) {
    dxf.section("BLOCKS");
    const auto block = [&](std::string_view name, std::string_view owner) {
        dxf.record("BLOCK", owner, {"AcDbEntity"});
        dxf.put(8, "0");
        dxf.put(100, "AcDbBlockBegin");
        dxf.put(2, name);
        dxf.put(70, 0);
        dxf.point(10, 0, 0);
        dxf.put(3, name);
        dxf.put(1, "");
        dxf.record("ENDBLK", owner, {"AcDbEntity"});
        dxf.put(8, "0");
        dxf.put(100, "AcDbBlockEnd");
    };
    block("*Model_Space", kModelRecord);
    block("*Paper_Space", kPaperRecord);
    dxf.endSection();
}

// Cubics one after the other are a spline whose knots within are threefold. y goes upward.
void putSpline(DxfText& dxf, const OutlinePath& path, const std::string& layer, double height) {
    dxf.record("SPLINE", kModelRecord, {"AcDbEntity"});
    dxf.put(8, layer);
    dxf.put(100, "AcDbSpline");
    dxf.point(210, 0, 0, 1);
    dxf.put(70, path.closed ? 9 : 8);  // planar
    dxf.put(71, 3);
    const auto cubics = static_cast<int>(path.points.size() / 3);
    dxf.put(72, 3 * cubics + 5);
    dxf.put(73, 3 * cubics + 1);
    dxf.put(74, 0);
    for (int k = 0; k <= cubics; ++k) {
        const int repeats = k == 0 || k == cubics ? 4 : 3;
        for (int r = 0; r < repeats; ++r) dxf.put(40, k);
    }
    for (const auto& [x, y] : path.points) dxf.point(10, x, height - y);
}

void putObjects(DxfText& dxf) {
    dxf.section("OBJECTS");
    dxf.record("DICTIONARY", "0", {"AcDbDictionary"}, kRoot);
    dxf.put(281, 1);
    dxf.put(3, "ACAD_GROUP");
    dxf.put(350, kGroups);
    dxf.record("DICTIONARY", kRoot, {"AcDbDictionary"}, kGroups);
    dxf.put(281, 1);
    dxf.endSection();
}

}  // namespace

void writeDxf(AtomicFile& file, const Outline& outline, const StrokeOptions& options) {
    requireValid(options);
    if (!outline.fills.empty()) {
        throw Error(ErrorKind::Usage,
                    "a .dxf has lines only; expected a drawing without fills, or .svg, .pdf, .eps");
    }
    const std::vector<PaintLayer> layers = paintLayers(outline);
    DxfText dxf;
    putHeader(dxf, outline);
    dxf.section("TABLES");
    putView(dxf, outline);
    putLineTypes(dxf, options);
    putLayers(dxf, outline, layers, options);
    putSmallTables(dxf);
    dxf.endSection();
    putBlocks(dxf);
    dxf.section("ENTITIES");
    for (const PaintLayer& layer : layers) {
        const std::string name = layerName(outline, layer);
        for (const OutlinePath* path : layer.paths) putSpline(dxf, *path, name, outline.height);
    }
    dxf.endSection();
    putObjects(dxf);
    dxf.put(0, "EOF");
    writeWhole(file, dxf.text());
}

}  // namespace bandvox
