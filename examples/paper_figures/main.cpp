// Draws the figures of N. Chiba, T. Aoki, N. Saito: "A Voxel Based Geometric Modeling" (1990), and
// measures them against the solids' formulas. docs/paper.md reads what it leaves.
//
//     paper_figures OUTPUT_FOLDER [--quick]

#include "figures.h"

#include <bandvox/core/error.h>

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

int main(int argc, char** argv) {
    const bool isQuick = argc == 3 && argv[2] == std::string("--quick");
    if (argc < 2 || argc > 3 || (argc == 3 && !isQuick) || argv[1][0] == '-') {
        std::cerr << "usage: paper_figures OUTPUT_FOLDER [--quick]\n"
                     "  --quick   figure 10 with fewer pixels and voxels\n";
        return static_cast<int>(bandvox::ErrorKind::Usage);
    }
    try {
        const std::filesystem::path folder = argv[1];
        std::filesystem::create_directories(folder);
        const std::vector<paper_figures::Solid> solids = paper_figures::solids();
        paper_figures::writeOlderMethods(folder, solids.at(0));
        paper_figures::writeBandLimited(folder, solids);
        paper_figures::writeSampling(folder, solids.at(2));
        paper_figures::writeMelting(
            folder, isQuick ? paper_figures::MeltingSize{128, 64} : paper_figures::MeltingSize{});
        paper_figures::writeMeasures(folder, solids);
        paper_figures::writeVariants(folder);
        std::cout << "figures 1 to 5, 8, 9 and 10, normal_errors, roughness and variants are in "
                  << folder << '\n';
        return EXIT_SUCCESS;
    } catch (const bandvox::Error& error) {
        std::cerr << error.what() << '\n';
        return error.exitStatus();
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return EXIT_FAILURE;
    }
}
