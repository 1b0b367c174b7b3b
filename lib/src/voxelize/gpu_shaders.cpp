#include "voxelize/gpu_shaders.h"

#include "voxelize/lattice_points.h"

namespace bandvox {

namespace {

const char* const kVertexText = R"(
layout(std430, binding = 0) readonly buffer Patches { uvec4 patches[]; };
uniform ivec2 size;
uniform int plane;
flat out ivec3 a, b, c;
flat out int change;

void main() {
    int at = 3 * (gl_VertexID / 6), corner = gl_VertexID % 6;
    uvec4 p = patches[at], q = patches[at + 1], r = patches[at + 2];
    a = ivec3(p.xyz);
    b = ivec3(p.w, q.xy);
    c = ivec3(q.zw, r.x);
    change = int(r.w);

    // The rectangle's pixels are exact; as two triangles, it covers each once.
    bool far = corner >= 1 && corner <= 3, high = corner >= 2 && corner <= 4;
    uvec2 low = r.yz & 0xffffu, end = r.yz >> 16;
    vec2 pixel = vec2(far ? end.x : low.x, high ? end.y : low.y);
    gl_Position = vec4(2.0 * pixel / vec2(size) - 1.0, 0.0, 1.0);

    // No crossing lies behind the first sample after the triangle.
    int last = max(a.x, max(b.x, c.x)) >> FRACTION_BITS;
    if (last + 1 < plane) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
)";

// The arithmetic that all methods share. Coordinates are below 2^31, so differences of products
// of two fit into 64 bits.
const char* const kCrossingText = R"(
uniform ivec3 first;
flat in ivec3 a, b, c;
flat in int change;

int64_t cross2(ivec2 u, ivec2 v) {
    return int64_t(u.x) * int64_t(v.y) - int64_t(u.y) * int64_t(v.x);
}

// The side of an edge on which a row lies. One on the edge stands for the row next to it at
// (y + e, z + e e) for a small e, so neighbours along an edge never both have it, nor both not.
bool isLeft(int64_t w, ivec2 edge) {
    return w > 0L || (w == 0L && (edge.y < 0 || (edge.y == 0 && edge.x > 0)));
}

// True if a sample on the triangle's plane counts as behind it; see isBehindItself.
bool isBehindItself() {
    ivec3 u = b - a, v = c - a;
    int64_t n0 = cross2(u.yz, v.yz), n1 = cross2(u.zx, v.zx), n2 = cross2(u.xy, v.xy);
    if (AXIS != 0 && n1 != 0L) return (n1 > 0L) == (n0 > 0L);
    if (AXIS == 2 && n2 != 0L) return (n2 > 0L) == (n0 > 0L);
    return true;
}

// True if the triangle crosses the row; `x` is then the first sample behind it.
bool crosses(ivec2 row, out int x) {
    ivec2 s = row << FRACTION_BITS;
    ivec2 ab = b.yz - a.yz, bc = c.yz - b.yz, ca = a.yz - c.yz;
    int64_t wa = cross2(bc, s - b.yz), wb = cross2(ca, s - c.yz), wc = cross2(ab, s - a.yz);
    bool left = isLeft(wa, bc);
    if (isLeft(wb, ca) != left || isLeft(wc, ab) != left) return false;
    if (!left) { wa = -wa; wb = -wb; wc = -wc; }

    // The weighted mean of the corners. Doubles know it to 2^-36 voxels; that tells the sample
    // unless it is nearer than 2^-27 to one.
    double mean = (double(wa) * double(a.x) + double(wb) * double(b.x) + double(wc) * double(c.x)) /
                  double(wa + wb + wc) * PER_VOXEL;
    double whole = floor(mean + 0.5LF);
    x = int(whole);
    if (abs(mean - whole) > NEAR) {
        if (mean > whole) ++x;
        return true;
    }
    // Then the sum's distance from the sample is below 2^53, and is exact whatever overflows on
    // the way there.
    ivec3 from = ivec3(a.x, b.x, c.x) - (x << FRACTION_BITS);
    int64_t beyond = wa * int64_t(from.x) + wb * int64_t(from.y) + wc * int64_t(from.z);
    if (beyond > 0L || (beyond == 0L && !isBehindItself())) ++x;
    return true;
}
)";

// One toggle for each crossing, in the order of blocks: 64 bits for the 8 × 8 rows at a place.
const char* const kBitsText = R"(
layout(std430, binding = 1) buffer Toggles { uint toggles[]; };
uniform int depth, columns;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int x;
    if (!crosses(first.yz + pixel, x)) return;
    x -= first.x;
    if (x < 0 || x >= depth) return;
    int column = (pixel.x >> 3) * columns + (pixel.y >> 3);
    int row = 8 * (pixel.x & 7) + (pixel.y & 7);
    atomicXor(toggles[2 * (column * depth + x) + (row >> 5)], 1u << (row & 31));
}
)";

// What lies beyond the plane is added up: back faces count 1, front faces -1. The paper lets the
// depth buffer find the nearest face instead; where a front and a back face meet in a pixel, which
// of them that is comes by chance, and makes streaks. Drawing and reading back cost the same.
const char* const kSlicesText = R"(
uniform int plane;
layout(location = 0) out float winding;

void main() {
    int x;
    if (!crosses(first.yz + ivec2(gl_FragCoord.xy), x) || x <= plane) discard;
    winding = -float(change);
}
)";

std::string shaderHead(ScanAxis axis) {
    const auto define = [](const char* name, const std::string& value) {
        return "#define " + std::string(name) + " " + value + "\n";
    };
    return "#version 430 core\n"
           "#extension GL_ARB_gpu_shader_int64 : require\n" +
           define("AXIS", std::to_string(static_cast<int>(axis))) +
           define("FRACTION_BITS", std::to_string(kFractionBits)) +
           define("PER_VOXEL", "(1.0LF / " + std::to_string(kVoxel) + ".0LF)") +
           define("NEAR", "(1.0LF / " + std::to_string(1 << 27) + ".0LF)");
}

}  // namespace

std::string patchVertexShader() {
    return shaderHead(ScanAxis::X) + kVertexText;
}

std::string crossingFragmentShader(ScanAxis axis, GpuMethod method) {
    return shaderHead(axis) + kCrossingText + (method == GpuMethod::Bits ? kBitsText : kSlicesText);
}

}  // namespace bandvox
