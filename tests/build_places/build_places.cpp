#include "build_places.h"

namespace bandvox::build_places {

const char* sources() {
    return BANDVOX_SOURCE_DIR;
}

const char* command() {
    return BANDVOX_EXECUTABLE;
}

const char* paperFigures() {
    return BANDVOX_PAPER_FIGURES;
}

const char* shapeToScreen() {
    return BANDVOX_SHAPE_TO_SCREEN;
}

}  // namespace bandvox::build_places
