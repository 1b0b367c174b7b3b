#include "core/image_library.h"

#ifdef BANDVOX_IMAGE_MODULE
#include "core/load_module.h"
#endif

namespace bandvox {

#ifdef BANDVOX_IMAGE_MODULE

const ImageLibrary& imageLibrary() {
    static const auto* const library = static_cast<const ImageLibrary*>(loadModule(
        BANDVOX_IMAGE_MODULE, "bandvoxImageLibrary", "image files cannot be read or written"));
    return *library;
}

#else

extern "C" const ImageLibrary* bandvoxImageLibrary();

const ImageLibrary& imageLibrary() {
    return *bandvoxImageLibrary();
}

#endif

}  // namespace bandvox
