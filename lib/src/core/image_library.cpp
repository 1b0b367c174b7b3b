#include "core/image_library.h"

#include <bandvox/core/error.h>

#ifdef BANDVOX_IMAGE_MODULE
#include <dlfcn.h>
#endif

namespace bandvox {

#ifdef BANDVOX_IMAGE_MODULE

namespace {

// The module beside this library, or else wherever the loader looks for it.
void* openModule() {
    Dl_info info;
    if (dladdr(reinterpret_cast<void*>(&openModule), &info) != 0 && info.dli_fname) {
        const auto beside =
            std::filesystem::path(info.dli_fname).parent_path() / BANDVOX_IMAGE_MODULE;
        if (void* module = dlopen(beside.c_str(), RTLD_NOW | RTLD_LOCAL)) return module;
    }
    return dlopen(BANDVOX_IMAGE_MODULE, RTLD_NOW | RTLD_LOCAL);
}

}  // namespace

const ImageLibrary& imageLibrary() {
    // Once loaded it stays, since the libraries behind it cannot be unloaded.
    static const ImageLibrary* const library = [] {
        void* module = openModule();
        using Entry = const ImageLibrary* (*)();
        const auto entry =
            module ? reinterpret_cast<Entry>(dlsym(module, "bandvoxImageLibrary")) : nullptr;
        if (!entry) {
            const char* why = dlerror();
            throw Error(ErrorKind::Runtime,
                        std::string("image files cannot be read or written: ") +
                            (why ? why : BANDVOX_IMAGE_MODULE " is no module of this library"));
        }
        return entry();
    }();
    return *library;
}

#else

extern "C" const ImageLibrary* bandvoxImageLibrary();

const ImageLibrary& imageLibrary() {
    return *bandvoxImageLibrary();
}

#endif

}  // namespace bandvox
