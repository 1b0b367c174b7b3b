#include "core/load_module.h"

#include <bandvox/core/error.h>

#include <dlfcn.h>

#include <filesystem>
#include <string>

namespace bandvox {
namespace {

void* openModule(const char* file) {
    Dl_info info;
    if (dladdr(reinterpret_cast<void*>(&openModule), &info) != 0 && info.dli_fname) {
        const auto beside = std::filesystem::path(info.dli_fname).parent_path() / file;
        if (void* module = dlopen(beside.c_str(), RTLD_NOW | RTLD_LOCAL)) return module;
    }
    return dlopen(file, RTLD_NOW | RTLD_LOCAL);
}

}  // namespace

const void* loadModule(const char* file, const char* entry, const char* failure) {
    // Once loaded it stays, since the libraries behind it cannot be unloaded.
    void* const module = openModule(file);
    using Entry = const void* (*)();
    const auto found = module ? reinterpret_cast<Entry>(dlsym(module, entry)) : nullptr;
    if (!found) {
        const char* why = dlerror();
        throw Error(
            ErrorKind::Runtime,
            std::string(failure) + ": " +
                (why ? std::string(why) : std::string(file) + " is no module of this library"));
    }
    return found();
}

}  // namespace bandvox
