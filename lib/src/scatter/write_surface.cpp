#include <bandvox/core/error.h>
#include <bandvox/scatter/write_surface.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace bandvox {
namespace {

void appendNumber(std::string& text, double number) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    text.append(digits.data(), end);
}

void writeText(std::ofstream& stream, std::string& text, const AtomicFile& file) {
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    text.clear();
    if (stream) return;
    throw Error(ErrorKind::Runtime, "\"" + file.target().string() + "\" could not be written");
}

/// Height and slopes of a surface on a grid, and its colours.
struct SampledField {
    std::array<int, 2> size;
    std::vector<double> height, dx, dy;
    std::array<std::vector<double>, 3> color;  // empty without

    SampledField(const BsplineSurface& surface, std::array<int, 2> samples, int column, int red,
                 const Progress& progress)
        : size(samples),
          height(surface.sample({samples[0], samples[1], column}, progress)),
          dx(surface.sample({samples[0], samples[1], column, 1, 0}, progress)),
          dy(surface.sample({samples[0], samples[1], column, 0, 1}, progress)) {
        for (int c = 0; red >= 0 && c < 3; ++c) {
            color[static_cast<std::size_t>(c)] =
                surface.sample({samples[0], samples[1], red + c}, progress);
        }
    }

    std::array<float, 3> normal(std::size_t i) const {
        const auto n = SurfaceJet{.dx = dx[i], .dy = dy[i]}.normal();
        return {static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])};
    }
    openvdb::Vec3f colorAt(std::size_t i) const {
        openvdb::Vec3f result;
        for (int c = 0; c < 3; ++c) {
            result[c] = std::max(0.0F, static_cast<float>(color[static_cast<std::size_t>(c)][i]));
        }
        return result;
    }
};

double along(double from, double to, int i, int count) {
    return from + (to - from) * i / (count - 1);
}

/// Adds samples, [x][y], to a picture that is seen from above.
void appendPlanes(Image& image, const std::vector<std::vector<double>>& numbers,
                  SurfaceQuantity quantity) {
    const auto height = static_cast<std::size_t>(image.height);
    const auto width = static_cast<std::size_t>(image.width);
    for (std::size_t n = 0; n < numbers.size(); ++n) {
        ImagePlane plane{nameOf(quantity), {}};
        if (numbers.size() > 1) plane.name += std::array{".X", ".Y", ".Z"}[n];
        plane.values.reserve(width * height);
        for (std::size_t row = 0; row < height; ++row) {
            for (std::size_t i = 0; i < width; ++i) {
                plane.values.push_back(
                    static_cast<float>(numbers[n][i * height + height - 1 - row]));
            }
        }
        image.planes.push_back(std::move(plane));
    }
}

}  // namespace

void writeBezierPatches(AtomicFile& file, const BsplineSurface& surface, int column,
                        Progress& progress) {
    const auto [nx, ny] = surface.cells();
    const Rectangle& r = surface.rectangle();
    std::ofstream stream = file.open();
    std::string text = std::to_string(static_cast<long long>(nx) * ny) + "\n";
    for (int i = 0; i < nx; ++i) {
        progress.throwIfInterrupted();
        for (int j = 0; j < ny; ++j) {
            text += "3 3\n";
            const auto ordinates = surface.bezierOrdinates(i, j, column);
            auto ordinate = ordinates.begin();
            for (int a = 0; a < 4; ++a) {
                for (int b = 0; b < 4; ++b) {
                    appendNumber(text, r.x0 + r.width() * (3 * i + a) / (3.0 * nx));
                    text += ' ';
                    appendNumber(text, r.y0 + r.height() * (3 * j + b) / (3.0 * ny));
                    text += ' ';
                    appendNumber(text, *ordinate++);
                    text += '\n';
                }
            }
        }
        writeText(stream, text, file);
    }
}

void writeSamples(AtomicFile& file, const BsplineSurface& surface, std::array<int, 2> samples,
                  const std::vector<SurfaceQuantity>& quantities, Progress& progress) {
    int numbers = 0;
    for (const SurfaceQuantity quantity : quantities) numbers += numbersOf(quantity);
    std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (";
    header += std::to_string(samples[0]) + ", ";
    header += std::to_string(samples[1]) + ", ";
    header += std::to_string(surface.columns() * numbers) + "), }";
    // What comes before the numbers fills whole blocks of 64 bytes, and ends in a newline.
    constexpr std::size_t kBlock = 64;
    constexpr std::size_t kStart = 10;
    header.append(kBlock - (kStart + header.size() + 1) % kBlock, ' ');
    header += '\n';
    std::string text("\x93NUMPY\x01\x00", 8);
    text += static_cast<char>(header.size() % 256);
    text += static_cast<char>(header.size() / 256);
    text += header;
    std::ofstream stream = file.open();
    writeText(stream, text, file);
    std::vector<std::vector<double>> columns;
    for (int c = 0; c < surface.columns(); ++c) {
        for (const SurfaceQuantity quantity : quantities) {
            for (auto& made : sampleQuantity(surface, samples, c, quantity, progress)) {
                columns.push_back(std::move(made));
            }
        }
    }
    const auto row = static_cast<std::size_t>(samples[1]);
    for (std::size_t i = 0; i < static_cast<std::size_t>(samples[0]); ++i) {
        progress.throwIfInterrupted();
        for (std::size_t j = 0; j < row; ++j) {
            for (const auto& column : columns) {
                text.append(reinterpret_cast<const char*>(&column[i * row + j]), sizeof(double));
            }
        }
        writeText(stream, text, file);
    }
}

SurfaceMesh heightFieldMesh(const BsplineSurface& surface, std::array<int, 2> samples, int column,
                            int red, const Progress& progress) {
    const SampledField field(surface, samples, column, red, progress);
    const Rectangle& r = surface.rectangle();
    SurfaceMesh result;
    for (int i = 0; i < samples[0]; ++i) {
        progress.throwIfInterrupted();
        for (int j = 0; j < samples[1]; ++j) {
            const std::size_t at = result.mesh.points.size();
            result.mesh.points.emplace_back(along(r.x0, r.x1, i, samples[0]),
                                            along(r.y0, r.y1, j, samples[1]), field.height[at]);
            const auto normal = field.normal(at);
            result.normals.emplace_back(normal[0], normal[1], normal[2]);
            if (red >= 0) result.colors.push_back(field.colorAt(at));
            if (i + 1 == samples[0] || j + 1 == samples[1]) continue;
            const auto corner = static_cast<openvdb::Int32>(at);
            const openvdb::Int32 right = corner + samples[1];
            result.mesh.triangles.emplace_back(corner, right, right + 1);
            result.mesh.triangles.emplace_back(corner, right + 1, corner + 1);
        }
    }
    return result;
}

Image heightFieldImage(const BsplineSurface& surface, std::array<int, 2> samples, int column,
                       int red, const std::vector<SurfaceQuantity>& quantities,
                       const Progress& progress) {
    const SampledField field(surface, samples, column, red, progress);
    const Rectangle& r = surface.rectangle();
    Image image;
    image.width = samples[0];
    image.height = samples[1];
    for (int row = 0; row < samples[1]; ++row) {
        progress.throwIfInterrupted();
        const int j = samples[1] - 1 - row;
        for (int i = 0; i < samples[0]; ++i) {
            const auto at = static_cast<std::size_t>(i) * static_cast<std::size_t>(samples[1]) +
                            static_cast<std::size_t>(j);
            const auto height = static_cast<float>(field.height[at]);
            const openvdb::Vec3f color = red >= 0 ? field.colorAt(at) : openvdb::Vec3f(height);
            image.color.insert(image.color.end(), {color[0], color[1], color[2], 1.0F});
            image.depth.push_back(height);
            const auto normal = field.normal(at);
            image.normal.insert(image.normal.end(), normal.begin(), normal.end());
            image.position.insert(image.position.end(),
                                  {static_cast<float>(along(r.x0, r.x1, i, samples[0])),
                                   static_cast<float>(along(r.y0, r.y1, j, samples[1])), height});
        }
    }
    for (const SurfaceQuantity quantity : quantities) {
        appendPlanes(image, sampleQuantity(surface, samples, column, quantity, progress), quantity);
    }
    return image;
}

}  // namespace bandvox
