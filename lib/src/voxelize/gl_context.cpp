#include "voxelize/gl_context.h"

#include <bandvox/core/error.h>

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace bandvox {

namespace {

constexpr int kOldestOpenGl = 43;

std::string eglErrorName() {
    const EGLint error = eglGetError();
    switch (error) {
        case EGL_NOT_INITIALIZED:
            return "EGL_NOT_INITIALIZED";
        case EGL_BAD_ACCESS:
            return "EGL_BAD_ACCESS";
        case EGL_BAD_ALLOC:
            return "EGL_BAD_ALLOC";
        case EGL_BAD_ATTRIBUTE:
            return "EGL_BAD_ATTRIBUTE";
        case EGL_BAD_CONFIG:
            return "EGL_BAD_CONFIG";
        case EGL_BAD_CONTEXT:
            return "EGL_BAD_CONTEXT";
        case EGL_BAD_DISPLAY:
            return "EGL_BAD_DISPLAY";
        case EGL_BAD_MATCH:
            return "EGL_BAD_MATCH";
        case EGL_BAD_PARAMETER:
            return "EGL_BAD_PARAMETER";
        case EGL_CONTEXT_LOST:
            return "EGL_CONTEXT_LOST";
        default:
            break;
    }
    std::ostringstream name;
    name << "EGL error 0x" << std::hex << error;
    return name.str();
}

// True if a list of names, separated by spaces, holds one.
bool lists(const char* names, std::string_view name) {
    std::istringstream words(names ? names : "");
    for (std::string word; words >> word;) {
        if (word == name) return true;
    }
    return false;
}

bool clientHas(std::string_view extension) {
    return lists(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), extension);
}

// The loader of OpenGL's functions ends the process if one of these libraries is missing.
bool hasOpenGlLibrary() {
    for (const char* name : {"libOpenGL.so.0", "libGL.so.1"}) {
        if (void* library = dlopen(name, RTLD_LAZY | RTLD_LOCAL)) {
            dlclose(library);
            return true;
        }
    }
    return false;
}

bool hasDeviceList() {
    return clientHas("EGL_EXT_platform_device") &&
           (clientHas("EGL_EXT_device_base") ||
            (clientHas("EGL_EXT_device_enumeration") && clientHas("EGL_EXT_device_query")));
}

std::vector<EGLDeviceEXT> eglDevices() {
    EGLint count = 0;
    if (!hasDeviceList() || !eglQueryDevicesEXT(0, nullptr, &count)) return {};
    std::vector<EGLDeviceEXT> devices(count);
    if (!eglQueryDevicesEXT(count, devices.data(), &count)) return {};
    devices.resize(count);
    return devices;
}

bool isSoftwareDevice(EGLDeviceEXT device) {
    return lists(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
}

// The displays to try, the most promising ones first.
std::vector<EGLDisplay> eglDisplays() {
    std::vector<EGLDisplay> displays;
    const auto add = [&](EGLDisplay display) {
        if (display != EGL_NO_DISPLAY) displays.push_back(display);
    };
    const std::vector<EGLDeviceEXT> devices = eglDevices();
    for (const bool software : {false, true}) {
        for (EGLDeviceEXT device : devices) {
            if (isSoftwareDevice(device) != software) continue;
            add(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
        }
    }
    if (clientHas("EGL_MESA_platform_surfaceless") && clientHas("EGL_EXT_platform_base")) {
        add(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
    }
    add(eglGetDisplay(EGL_DEFAULT_DISPLAY));
    return displays;
}

EGLContext createGlContext(EGLDisplay display) {
    // Ask to be told of lost contexts; do without if that cannot be.
    const bool canTell = epoxy_egl_version(display) >= 15 ||
                         epoxy_has_egl_extension(display, "EGL_EXT_create_context_robustness");
    const EGLint strategyName = epoxy_egl_version(display) >= 15
                                    ? EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY
                                    : EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT;
    for (const bool tell : {true, false}) {
        if (tell && !canTell) continue;
        const std::array<EGLint, 9> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                               kOldestOpenGl / 10,
                                               EGL_CONTEXT_MINOR_VERSION,
                                               kOldestOpenGl % 10,
                                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                               tell ? strategyName : EGL_NONE,
                                               EGL_LOSE_CONTEXT_ON_RESET,
                                               EGL_NONE};
        const EGLContext context =
            eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
        if (context != EGL_NO_CONTEXT) return context;
    }
    return EGL_NO_CONTEXT;
}

[[noreturn]] void failGl(const std::string& message) {
    throw Error(ErrorKind::Runtime, message);
}

}  // namespace

EglDevices lookAtEglDevices() {
    if (!epoxy_has_egl()) return EglDevices::NoEgl;
    if (!hasDeviceList()) return EglDevices::Unknown;
    for (EGLDeviceEXT device : eglDevices()) {
        if (!isSoftwareDevice(device)) return EglDevices::Hardware;
    }
    return EglDevices::SoftwareOnly;
}

GlContext::GlContext() {
    if (!epoxy_has_egl()) {
        failGl("there is no EGL (libEGL.so.1) to reach a GPU by; expected one, or the CPU");
    }
    if (!hasOpenGlLibrary()) {
        failGl(
            "there is no OpenGL library (libOpenGL.so.0 or libGL.so.1); expected one, or the "
            "CPU");
    }
    mPrevious = {eglGetCurrentDisplay(), eglGetCurrentContext(), eglGetCurrentSurface(EGL_DRAW),
                 eglGetCurrentSurface(EGL_READ), eglQueryAPI()};
    std::string failures;
    for (EGLDisplay display : eglDisplays()) {
        std::string failure;
        if (open(display, failure)) break;
        if (failures.find(failure) == std::string::npos) failures += "; " + failure;
    }
    if (!mContext) {
        eglBindAPI(mPrevious.api);
        failGl("EGL offers no OpenGL 4.3 without a window" +
               (failures.empty() ? "; it knows no display, so there is no driver" : failures));
    }
    try {
        mDevice = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
        requireExtensions();
    } catch (...) {
        close();
        throw;
    }
}

GlContext::~GlContext() {
    close();
}

bool GlContext::open(void* display, std::string& failure) {
    // A display is one for the whole process, and others may use it: it is never terminated.
    if (!eglInitialize(display, nullptr, nullptr)) {
        failure = "eglInitialize: " + eglErrorName();
        return false;
    }
    const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
    const bool bare = lists(extensions, "EGL_KHR_surfaceless_context") &&
                      (lists(extensions, "EGL_KHR_no_config_context") ||
                       lists(extensions, "EGL_MESA_configless_context"));
    if (!bare) {
        failure = "a display lacks EGL_KHR_surfaceless_context or EGL_KHR_no_config_context";
    } else if (!eglBindAPI(EGL_OPENGL_API)) {
        failure = "eglBindAPI(EGL_OPENGL_API): " + eglErrorName();
    } else if (mContext = createGlContext(display); !mContext) {
        failure = "eglCreateContext: " + eglErrorName();
    } else if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, mContext)) {
        failure = "eglMakeCurrent: " + eglErrorName();
        eglDestroyContext(display, mContext);
        mContext = nullptr;
    }
    mDisplay = display;
    return mContext != nullptr;
}

void GlContext::close() {
    eglMakeCurrent(mDisplay, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(mDisplay, mContext);
    eglBindAPI(mPrevious.api);
    if (mPrevious.context != EGL_NO_CONTEXT) {
        eglMakeCurrent(mPrevious.display, mPrevious.draw, mPrevious.read, mPrevious.context);
    } else {
        eglReleaseThread();
    }
}

void GlContext::requireExtensions() {
    if (epoxy_gl_version() < kOldestOpenGl) {
        failGl(mDevice + ": its OpenGL is version " + std::to_string(epoxy_gl_version() / 10) +
               "." + std::to_string(epoxy_gl_version() % 10) + "; expected 4.3");
    }
    // Doubles are part of OpenGL 4.0.
    const char* const name = "GL_ARB_gpu_shader_int64";
    if (!epoxy_has_gl_extension(name)) {
        failGl(mDevice + ": its OpenGL lacks the extension " + name +
               ", which exact crossings need");
    }
}

bool GlContext::isHardware() const {
    for (const char* program : {"llvmpipe", "softpipe", "swrast", "Software", "software"}) {
        if (mDevice.find(program) != std::string::npos) return false;
    }
    return true;
}

}  // namespace bandvox
