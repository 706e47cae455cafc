#include "gl/objects.h"

#include <algorithm>

#include "base/error.h"

namespace lightband::gl {
namespace {

size_t texel_bytes(GLenum format) {
    switch (format) {
        case GL_R8UI: return 1;
        case GL_R32F: case GL_R32UI: case GL_RG16F: case GL_DEPTH_COMPONENT32F: return 4;
        case GL_RG32F: case GL_RG32UI: case GL_RGBA16F: case GL_RGBA16: return 8;
        case GL_RGBA32F: return 16;
        default: throw Error(LB_ERROR_INTERNAL, text("texel size of OpenGL format ", format, " is not known"));
    }
}

template <typename... Parts>
void check_storage(const Functions& gl, const Parts&... what) {
    const GLenum error = gl.GetError();
    if (error == GL_NO_ERROR) return;
    if (error == GL_OUT_OF_MEMORY) throw Error(LB_ERROR_LIMIT, text("the device has no memory for ", what...));
    throw Error(LB_ERROR_DEVICE, text("OpenGL error ", error, " where it was to make ", what...));
}

}  // namespace

// Delegates to the default constructor, so that the destructor runs where the storage fails.
Buffer::Buffer(const Functions& gl, size_t bytes, const void* data) : Buffer() {
    gl_ = &gl;
    bytes_ = bytes;
    gl.CreateBuffers(1, &name_);
    gl.NamedBufferStorage(name_, GLsizeiptr(bytes), data, GL_DYNAMIC_STORAGE_BIT);
    check_storage(gl, "a buffer of ", bytes, " bytes");
}

Buffer::~Buffer() {
    if (name_ != 0) gl_->DeleteBuffers(1, &name_);
}

void Buffer::write(size_t offset, size_t bytes, const void* data) const {
    gl_->NamedBufferSubData(name_, GLintptr(offset), GLsizeiptr(bytes), data);
}

void Buffer::read(size_t offset, size_t bytes, void* data) const {
    gl_->GetNamedBufferSubData(name_, GLintptr(offset), GLsizeiptr(bytes), data);
}

void Buffer::clear() const {
    const GLuint zero = 0;
    gl_->ClearNamedBufferData(name_, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
}

Texture Texture::image(const Functions& gl, GLenum format, uint32_t width, uint32_t height, uint32_t levels) {
    Texture texture;
    texture.gl_ = &gl;
    gl.CreateTextures(GL_TEXTURE_2D, 1, &texture.name_);
    gl.TextureStorage2D(texture.name_, GLsizei(levels), format, GLsizei(width), GLsizei(height));
    check_storage(gl, "a texture of ", width, " x ", height);
    texture.describe(width, height, levels, texel_bytes(format));
    return texture;
}

Texture Texture::image_array(const Functions& gl, GLenum format, uint32_t width, uint32_t height, uint32_t layers, uint32_t levels) {
    Texture texture;
    texture.gl_ = &gl;
    gl.CreateTextures(GL_TEXTURE_2D_ARRAY, 1, &texture.name_);
    gl.TextureStorage3D(texture.name_, GLsizei(levels), format, GLsizei(width), GLsizei(height), GLsizei(layers));
    check_storage(gl, "a texture of ", layers, " times ", width, " x ", height);
    texture.describe(width, height, levels, layers * texel_bytes(format));
    return texture;
}

// Nearest lookup, held at the edges, until a pass asks for another.
void Texture::describe(uint32_t width, uint32_t height, uint32_t levels, size_t bytes_per_texel) {
    parameter(GL_TEXTURE_MIN_FILTER, levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST);
    parameter(GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    parameter(GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    parameter(GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    for (uint32_t level = 0; level < levels; ++level)
        bytes_ += size_t(std::max(width >> level, 1u)) * std::max(height >> level, 1u) * bytes_per_texel;
}

Texture Texture::of_buffer(const Functions& gl, GLenum format, const Buffer& buffer) {
    Texture texture;
    texture.gl_ = &gl;
    gl.CreateTextures(GL_TEXTURE_BUFFER, 1, &texture.name_);
    gl.TextureBuffer(texture.name_, format, buffer.name());
    check_storage(gl, "a texture of a buffer of ", buffer.bytes(), " bytes");
    return texture;
}

Texture::~Texture() {
    if (name_ != 0) gl_->DeleteTextures(1, &name_);
}

void Texture::upload(uint32_t width, uint32_t height, GLenum format, GLenum type, const void* pixels) const {
    upload_rows(0, width, height, format, type, pixels);
}

void Texture::upload_rows(uint32_t first, uint32_t width, uint32_t rows, GLenum format, GLenum type, const void* pixels) const {
    gl_->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl_->TextureSubImage2D(name_, 0, 0, GLint(first), GLsizei(width), GLsizei(rows), format, type, pixels);
}

void Texture::read(uint32_t level, GLenum format, GLenum type, size_t bytes, void* pixels) const {
    gl_->PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl_->GetTextureImage(name_, GLint(level), format, type, GLsizei(bytes), pixels);
}

void Texture::parameter(GLenum name, GLint value) const { gl_->TextureParameteri(name_, name, value); }

Framebuffer::Framebuffer(const Functions& gl) {
    gl_ = &gl;
    gl.CreateFramebuffers(1, &name_);
}

Framebuffer::~Framebuffer() {
    if (name_ != 0) gl_->DeleteFramebuffers(1, &name_);
}

VertexArray::VertexArray(const Functions& gl) {
    gl_ = &gl;
    gl.CreateVertexArrays(1, &name_);
}

VertexArray::~VertexArray() {
    if (name_ != 0) gl_->DeleteVertexArrays(1, &name_);
}

Program::~Program() {
    if (name_ != 0) gl_->DeleteProgram(name_);
}

// A uniform that a variant does not use has no location (-1); OpenGL ignores writes to it.
GLint Program::location(const char* uniform) const { return gl_->GetUniformLocation(name_, uniform); }

void Program::set(const char* uniform, float value) const { gl_->ProgramUniform1f(name_, location(uniform), value); }
void Program::set(const char* uniform, int32_t value) const { gl_->ProgramUniform1i(name_, location(uniform), value); }
void Program::set(const char* uniform, uint32_t value) const { gl_->ProgramUniform1ui(name_, location(uniform), value); }
void Program::set(const char* uniform, int32_t x, int32_t y) const {
    gl_->ProgramUniform2i(name_, location(uniform), x, y);
}
void Program::set(const char* uniform, const float (&v)[3]) const {
    gl_->ProgramUniform3f(name_, location(uniform), v[0], v[1], v[2]);
}
void Program::set(const char* uniform, const float (&v)[4]) const {
    gl_->ProgramUniform4f(name_, location(uniform), v[0], v[1], v[2], v[3]);
}
void Program::set_matrix3(const char* uniform, const float* columns) const {
    gl_->ProgramUniformMatrix3fv(name_, location(uniform), 1, GL_FALSE, columns);
}
void Program::set_matrix4(const char* uniform, const float* columns) const {
    gl_->ProgramUniformMatrix4fv(name_, location(uniform), 1, GL_FALSE, columns);
}
void Program::set_array(const char* uniform, const uint32_t* values, int32_t count) const {
    gl_->ProgramUniform1uiv(name_, location(uniform), count, values);
}

}  // namespace lightband::gl
