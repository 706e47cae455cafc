// One invocation per pixel in groups of 8 x 8, and the bindings that passes share.
#pragma once

#include "gl/objects.h"

namespace lightband {

// What one pass leaves may be read by the next, by any path.
constexpr GLbitfield everything = GL_ALL_BARRIER_BITS;

inline void dispatch_pixels(const gl::Functions& gl, uint32_t width, uint32_t height) {
    gl.DispatchCompute((width + 7) / 8, (height + 7) / 8, 1);
    gl.MemoryBarrier(everything);
}

inline void bind_texture(const gl::Functions& gl, GLuint unit, const gl::Texture& texture) {
    gl.BindTextureUnit(unit, texture.name());
}

inline void bind_image(const gl::Functions& gl, GLuint unit, const gl::Texture& texture, GLenum format,
                       uint32_t level = 0) {
    gl.BindImageTexture(unit, texture.name(), GLint(level), GL_FALSE, 0, GL_READ_WRITE, format);
}

// Workgroups that every OpenGL 4.5 device takes in one dispatch.
constexpr uint32_t most_groups = 65535;

// Every layer of an array of images.
inline void bind_images(const gl::Functions& gl, GLuint unit, const gl::Texture& texture, GLenum format, uint32_t level = 0) {
    gl.BindImageTexture(unit, texture.name(), GLint(level), GL_TRUE, 0, GL_READ_WRITE, format);
}

inline void bind_storage(const gl::Functions& gl, GLuint binding, const gl::Buffer& buffer) {
    gl.BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.name());
}

inline void bind_uniforms(const gl::Functions& gl, GLuint binding, const gl::Buffer& buffer) {
    gl.BindBufferBase(GL_UNIFORM_BUFFER, binding, buffer.name());
}

}  // namespace lightband
