#include "voxelize/gl_objects.h"

#include <bandvox/core/error.h>

#include <algorithm>
#include <array>
#include <sstream>

namespace bandvox {

namespace {

// OpenGL's names for what it returns, as far as they occur here.
std::string glName(GLenum value) {
    switch (value) {
        case GL_INVALID_ENUM:
            return "GL_INVALID_ENUM";
        case GL_INVALID_VALUE:
            return "GL_INVALID_VALUE";
        case GL_INVALID_OPERATION:
            return "GL_INVALID_OPERATION";
        case GL_INVALID_FRAMEBUFFER_OPERATION:
            return "GL_INVALID_FRAMEBUFFER_OPERATION";
        case GL_OUT_OF_MEMORY:
            return "GL_OUT_OF_MEMORY";
        case GL_CONTEXT_LOST:
            return "GL_CONTEXT_LOST";
        case GL_GUILTY_CONTEXT_RESET:
            return "GL_GUILTY_CONTEXT_RESET";
        case GL_INNOCENT_CONTEXT_RESET:
            return "GL_INNOCENT_CONTEXT_RESET";
        case GL_UNKNOWN_CONTEXT_RESET:
            return "GL_UNKNOWN_CONTEXT_RESET";
        case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT:
            return "GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT";
        case GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT:
            return "GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT";
        case GL_FRAMEBUFFER_UNSUPPORTED:
            return "GL_FRAMEBUFFER_UNSUPPORTED";
        default:
            break;
    }
    std::ostringstream name;
    name << "0x" << std::hex << value;
    return name.str();
}

// Why the context is of no more use; GL_NO_ERROR if it is.
GLenum resetStatus() {
    if (epoxy_gl_version() >= 45 || epoxy_has_gl_extension("GL_KHR_robustness")) {
        return glGetGraphicsResetStatus();
    }
    if (epoxy_has_gl_extension("GL_ARB_robustness")) return glGetGraphicsResetStatusARB();
    return GL_NO_ERROR;
}

std::string shaderLog(GLuint name, decltype(glGetShaderiv) get, decltype(glGetShaderInfoLog) read) {
    GLint length = 0;
    get(name, GL_INFO_LOG_LENGTH, &length);
    std::string text(static_cast<std::size_t>(std::max(length, 1)), '\0');
    GLsizei written = 0;
    read(name, static_cast<GLsizei>(text.size()), &written, text.data());
    text.resize(static_cast<std::size_t>(written));
    return text;
}

GLuint compileShader(GLenum kind, const std::string& source) {
    const GLuint shader = glCreateShader(kind);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (!good) {
        const std::string log = shaderLog(shader, glGetShaderiv, glGetShaderInfoLog);
        glDeleteShader(shader);
        throw Error(ErrorKind::Runtime, "OpenGL does not compile a shader: " + log);
    }
    return shader;
}

}  // namespace

void checkGl(const char* doing) {
    const GLenum error = glGetError();
    const GLenum reset = resetStatus();
    if (error == GL_CONTEXT_LOST || reset != GL_NO_ERROR) {
        throw Error(ErrorKind::Runtime, "the OpenGL context was lost (" +
                                            glName(reset != GL_NO_ERROR ? reset : error) +
                                            ") while " + doing);
    }
    if (error == GL_NO_ERROR) return;
    throw Error(error == GL_OUT_OF_MEMORY ? ErrorKind::Memory : ErrorKind::Runtime,
                "OpenGL failed with " + glName(error) + " while " + doing);
}

GlBuffer::GlBuffer() {
    glGenBuffers(1, &mName);
}

GlBuffer::~GlBuffer() {
    glDeleteBuffers(1, &mName);
}

void GlBuffer::allocate(std::int64_t bytes, const void* data, GLenum usage) {
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, mName);
    glBufferData(GL_SHADER_STORAGE_BUFFER, bytes, data, usage);
    checkGl("making a buffer");
}

void GlBuffer::clear(std::int64_t bytes) {
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, mName);
    glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, bytes, GL_RED_INTEGER,
                         GL_UNSIGNED_INT, nullptr);
}

void GlBuffer::read(std::int64_t bytes, void* to) const {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, mName);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, bytes, to);
}

void GlBuffer::bind(unsigned binding) const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, mName);
}

GlProgram::GlProgram(const std::string& vertex, const std::string& fragment) {
    const std::array shaders{compileShader(GL_VERTEX_SHADER, vertex),
                             compileShader(GL_FRAGMENT_SHADER, fragment)};
    mName = glCreateProgram();
    for (const GLuint shader : shaders) {
        glAttachShader(mName, shader);
        glDeleteShader(shader);  // once the program is
    }
    glLinkProgram(mName);
    GLint good = 0;
    glGetProgramiv(mName, GL_LINK_STATUS, &good);
    if (good) return;
    const std::string log = shaderLog(mName, glGetProgramiv, glGetProgramInfoLog);
    glDeleteProgram(mName);
    throw Error(ErrorKind::Runtime, "OpenGL does not link the shaders: " + log);
}

GlProgram::~GlProgram() {
    glDeleteProgram(mName);
}

void GlProgram::use() const {
    glUseProgram(mName);
}

void GlProgram::set(const char* uniform, std::span<const int> values) const {
    const GLint place = glGetUniformLocation(mName, uniform);
    if (values.size() == 1) glUniform1iv(place, 1, values.data());
    if (values.size() == 2) glUniform2iv(place, 1, values.data());
    if (values.size() == 3) glUniform3iv(place, 1, values.data());
}

GlTarget::GlTarget(int width, int height, bool hasFloats) {
    glGenFramebuffers(1, &mFramebuffer);
    glGenRenderbuffers(1, &mRenderbuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, mFramebuffer);
    if (hasFloats) {
        glBindRenderbuffer(GL_RENDERBUFFER, mRenderbuffer);
        glRenderbufferStorage(GL_RENDERBUFFER, GL_R32F, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                                  mRenderbuffer);
    } else {
        glFramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_WIDTH, width);
        glFramebufferParameteri(GL_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_HEIGHT, height);
    }
    glViewport(0, 0, width, height);
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status == GL_FRAMEBUFFER_COMPLETE) return;
    glDeleteFramebuffers(1, &mFramebuffer);
    glDeleteRenderbuffers(1, &mRenderbuffer);
    checkGl("making a framebuffer");
    throw Error(ErrorKind::Runtime, "OpenGL does not draw to a framebuffer of " +
                                        std::to_string(width) + " x " + std::to_string(height) +
                                        " pixels: " + glName(status));
}

GlTarget::~GlTarget() {
    glDeleteFramebuffers(1, &mFramebuffer);
    glDeleteRenderbuffers(1, &mRenderbuffer);
}

GlVertexArray::GlVertexArray() {
    glGenVertexArrays(1, &mName);
    glBindVertexArray(mName);
}

GlVertexArray::~GlVertexArray() {
    glDeleteVertexArrays(1, &mName);
}

}  // namespace bandvox
