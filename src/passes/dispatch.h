// One invocation per pixel in groups of 8 x 8, and the bindings that passes share.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/text.h"
#include "gl/objects.h"
#include "sampling/lamps.h"

namespace lightband::passes {

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

// What shaders/lamps.glsl is compiled for, and reads.
inline std::string lamp_definitions(const std::vector<Lamp>& lamps) { return text("\nLAMPS ", lamps.size()); }
inline void set_lamps(const gl::Program& program, const std::vector<Lamp>& lamps) {
    for (size_t i = 0; i < lamps.size(); ++i)
        program.set(text("lamps[", i, "]").c_str(), {float(lamps[i].direction.x), float(lamps[i].direction.y),
                                                      float(lamps[i].direction.z), float(std::sin(lamps[i].size))});
}

// Pixels that are shaded whatever is decided for others (shaders/witnesses.glsl): parts of all, 0 .. 1, drawn by chance. Those that are
// audited are the same in every round (frame/audit.h); witnesses are others, as levels follow what those before them saw.
struct Witnesses {
    double part = 0, audited = 0;
    uint32_t seed = 0, round = 1;

    void set(const gl::Program& program) const {
        const auto of_all = [](double some) { return uint32_t(std::max(some * 0x1p32 - 1, 0.0)); };
        constexpr uint32_t golden_ratio = 2654435769u;  // its fraction in 32 bits
        program.set("witnesses", of_all(std::max(part, audited)));
        program.set("witness_seed", seed + golden_ratio * (round - 1));
        program.set("audited", of_all(audited));
        program.set("audit_seed", seed);
    }
};

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

}  // namespace lightband::passes
