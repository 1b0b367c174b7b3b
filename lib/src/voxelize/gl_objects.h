#pragma once

#include <epoxy/gl.h>

#include <cstdint>
#include <span>
#include <string>

// What a context holds, freed with the objects here. They live while it is current.
namespace bandvox {

/// Throws Error(ErrorKind::Runtime), with OpenGL's name for it and what it happened at, if an error
/// is pending or the context was lost; Error(ErrorKind::Memory) if OpenGL had not enough memory.
void checkGl(const char* doing);

/// Bytes on the device.
class GlBuffer {
  public:
    GlBuffer();
    ~GlBuffer();
    GlBuffer(GlBuffer&& other) noexcept : mName(other.mName) { other.mName = 0; }
    GlBuffer(const GlBuffer&) = delete;
    GlBuffer& operator=(const GlBuffer&) = delete;

    /// Makes room for `bytes` bytes, or copies as many from `data`.
    void allocate(std::int64_t bytes, const void* data, GLenum usage);
    /// Sets the first `bytes` bytes to 0.
    void clear(std::int64_t bytes);
    void read(std::int64_t bytes, void* to) const;
    /// Shaders see it as the buffer of this binding.
    void bind(unsigned binding) const;

  private:
    GLuint mName = 0;
};

/// A vertex and a fragment shader.
class GlProgram {
  public:
    /// Throws Error(ErrorKind::Runtime) with the compiler's words if it will not have them.
    GlProgram(const std::string& vertex, const std::string& fragment);
    ~GlProgram();
    GlProgram(const GlProgram&) = delete;
    GlProgram& operator=(const GlProgram&) = delete;

    void use() const;
    /// Sets a uniform of whole numbers, of which there may be one to three.
    void set(const char* uniform, std::span<const int> values) const;

  private:
    GLuint mName = 0;
};

/// What is drawn to: as wide and high as asked for, with one float for each pixel, or none.
class GlTarget {
  public:
    GlTarget(int width, int height, bool hasFloats);
    ~GlTarget();
    GlTarget(const GlTarget&) = delete;
    GlTarget& operator=(const GlTarget&) = delete;

  private:
    GLuint mFramebuffer = 0, mRenderbuffer = 0;
};

/// The state that a context needs to draw without vertex attributes.
class GlVertexArray {
  public:
    GlVertexArray();
    ~GlVertexArray();
    GlVertexArray(const GlVertexArray&) = delete;
    GlVertexArray& operator=(const GlVertexArray&) = delete;

  private:
    GLuint mName = 0;
};

}  // namespace bandvox
