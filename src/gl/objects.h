// OpenGL objects that delete themselves. Each holds a reference to its functions; its Device must outlive it.
#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include "gl/device.h"

namespace lightband::gl {

// A name of OpenGL's with its deleter; moves, never copies.
class Object {
public:
    Object() = default;
    Object(const Functions& gl, GLuint name) : gl_(&gl), name_(name) {}
    Object(Object&& other) noexcept : gl_(other.gl_), name_(std::exchange(other.name_, 0)) {}
    GLuint name() const { return name_; }
    explicit operator bool() const { return name_ != 0; }

protected:
    void swap(Object& other) {
        std::swap(gl_, other.gl_);
        std::swap(name_, other.name_);
    }
    const Functions* gl_ = nullptr;
    GLuint name_ = 0;
};

// Immutable storage. data may be null (undefined contents). Buffers and textures throw LB_ERROR_LIMIT where the device
// has no memory for them: reads of an object without storage give zero, and a picture made of them would be wrong.
class Buffer : public Object {
public:
    Buffer() = default;
    Buffer(const Functions& gl, size_t bytes, const void* data);
    Buffer(Buffer&&) = default;
    Buffer& operator=(Buffer&& other) noexcept {
        swap(other);
        std::swap(bytes_, other.bytes_);
        return *this;
    }
    ~Buffer();
    size_t bytes() const { return bytes_; }
    void write(size_t offset, size_t bytes, const void* data) const;
    void read(size_t offset, size_t bytes, void* data) const;
    void clear() const;  // to zero

private:
    size_t bytes_ = 0;
};

class Texture : public Object {
public:
    Texture() = default;
    Texture(Texture&&) = default;
    Texture& operator=(Texture&& other) noexcept {
        swap(other);
        std::swap(bytes_, other.bytes_);
        return *this;
    }
    ~Texture();

    static Texture image(const Functions& gl, GLenum format, uint32_t width, uint32_t height, uint32_t levels = 1);
    static Texture image_array(const Functions& gl, GLenum format, uint32_t width, uint32_t height, uint32_t layers, uint32_t levels);
    // A texture over a buffer: the fastest way to read a table in a shader.
    static Texture of_buffer(const Functions& gl, GLenum format, const Buffer& buffer);

    void upload(uint32_t width, uint32_t height, GLenum format, GLenum type, const void* pixels) const;
    void upload_rows(uint32_t first, uint32_t width, uint32_t rows, GLenum format, GLenum type, const void* pixels) const;
    void read(uint32_t level, GLenum format, GLenum type, size_t bytes, void* pixels) const;
    void parameter(GLenum name, GLint value) const;
    size_t bytes() const { return bytes_; }

private:
    void describe(uint32_t width, uint32_t height, uint32_t levels, size_t bytes_per_texel);
    size_t bytes_ = 0;
};

class Framebuffer : public Object {
public:
    explicit Framebuffer(const Functions& gl);
    ~Framebuffer();
};

class VertexArray : public Object {
public:
    VertexArray() = default;
    explicit VertexArray(const Functions& gl);
    VertexArray(VertexArray&&) = default;
    VertexArray& operator=(VertexArray&& other) noexcept {
        swap(other);
        return *this;
    }
    ~VertexArray();
};

class Program : public Object {
public:
    explicit Program(const Functions& gl) : Object(gl, gl.CreateProgram()) {}
    ~Program();
    void set(const char* uniform, float value) const;
    void set(const char* uniform, int32_t value) const;
    void set(const char* uniform, uint32_t value) const;
    void set(const char* uniform, int32_t x, int32_t y) const;
    void set(const char* uniform, const float (&v)[3]) const;
    void set(const char* uniform, const float (&v)[4]) const;
    void set_matrix3(const char* uniform, const float* columns) const;
    void set_matrix4(const char* uniform, const float* columns) const;
    void set_array(const char* uniform, const uint32_t* values, int32_t count) const;
    void use() const { gl_->UseProgram(name_); }

private:
    GLint location(const char* uniform) const;
};

}  // namespace lightband::gl
