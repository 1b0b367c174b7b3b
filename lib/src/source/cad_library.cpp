#include "source/cad_library.h"

#include <bandvox/core/error.h>

#ifdef BANDVOX_CAD_MODULE
#include "core/load_module.h"
#endif

namespace bandvox {

#if defined(BANDVOX_CAD_MODULE)

const CadLibrary& cadLibrary() {
    static const auto* const library = static_cast<const CadLibrary*>(loadModule(
        BANDVOX_CAD_MODULE, "bandvoxCadLibrary", "STEP, IGES and BREP files cannot be read"));
    return *library;
}

#elif defined(BANDVOX_CAD_INSIDE)

extern "C" const CadLibrary* bandvoxCadLibrary();

const CadLibrary& cadLibrary() {
    return *bandvoxCadLibrary();
}

#else

const CadLibrary& cadLibrary() {
    throw Error(ErrorKind::Input,
                "needs Open CASCADE, which this build of Bandvox is without; expected a build with "
                "the option -DBANDVOX_WITH_OPENCASCADE=ON (scripts/setup --cad installs what it "
                "needs), or a file of another kind");
}

#endif

}  // namespace bandvox
