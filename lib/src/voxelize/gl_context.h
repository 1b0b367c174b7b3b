#pragma once

#include <string>

namespace bandvox {

/// What the list of EGL's devices says, which is quick to look at.
enum class EglDevices { NoEgl, Unknown, SoftwareOnly, Hardware };

EglDevices lookAtEglDevices();

/// An OpenGL context without a window, current in the thread that made it until it is destroyed
/// there; then the one that was current before is again. Prefers hardware to software.
class GlContext {
  public:
    /// Throws Error(ErrorKind::Runtime) if there is no EGL or no OpenGL of version 4.3, and names
    /// the extension if one that the shaders need is missing.
    GlContext();
    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    /// OpenGL's name for what it runs on.
    const std::string& device() const { return mDevice; }
    bool isHardware() const;

  private:
    struct Previous {
        void *display, *context, *draw, *read;
        unsigned api;
    };

    bool open(void* display, std::string& failure);
    void close();
    void requireExtensions();

    Previous mPrevious{};
    void* mDisplay = nullptr;
    void* mContext = nullptr;
    std::string mDevice;
};

}  // namespace bandvox
