#include "picture/targets.h"

#include "picture/decision.h"

namespace lightband {

using gl::Texture;

GBuffer::GBuffer(const gl::Functions& gl, uint32_t width, uint32_t height)
    : surface(Texture::image(gl, GL_RGBA32F, width, height)),
      material(Texture::image(gl, GL_R8UI, width, height)),
      depth(Texture::image(gl, GL_DEPTH_COMPONENT32F, width, height)) {}

Pyramids::Pyramids(const gl::Functions& gl, uint32_t width, uint32_t picture_height, uint32_t coarsest_level,
                   bool with_variances) {
    for (uint32_t level = 0, h = picture_height; level <= coarsest_level; ++level, h = (h + 1) / 2) {
        rows.push_back(height);
        height += h;
    }
    levels = Texture::image(gl, GL_R8UI, width, height);
    if (with_variances) variances = Texture::image(gl, GL_R32F, width, height);
    weights = Texture::image(gl, GL_RGBA16, width, picture_height);
}

Prediction::Prediction(const gl::Functions& gl, uint32_t width, uint32_t height)
    : bandwidth(Texture::image(gl, GL_RGBA32F, width, height)),
      prediction(Texture::image(gl, GL_RG32F, width, height)) {}

Shading::Shading(const gl::Functions& gl, uint32_t width, uint32_t height)
    : radiance(Texture::image(gl, GL_RGBA32F, width, height)),
      spread(Texture::image(gl, GL_RGBA32F, width, height)),
      sample_count(Texture::image(gl, GL_R32UI, width, height)),
      decision(Texture::image(gl, GL_R8UI, width, height)) {}

void Shading::clear(const gl::Functions& gl) const {
    const float zeros[4] = {0, 0, 0, 0};
    gl.ClearTexImage(radiance.name(), 0, GL_RGBA, GL_FLOAT, zeros);
    gl.ClearTexImage(spread.name(), 0, GL_RGBA, GL_FLOAT, zeros);
    forget(gl);
}

void Shading::forget(const gl::Functions& gl) const {
    const uint32_t none = 0;
    gl.ClearTexImage(sample_count.name(), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, &none);
}

void Shading::decide_nothing(const gl::Functions& gl) const {
    gl.ClearTexImage(decision.name(), 0, GL_RED_INTEGER, GL_UNSIGNED_BYTE, nullptr);
}

void Shading::decide_all(const gl::Functions& gl) const {
    gl.ClearTexImage(decision.name(), 0, GL_RED_INTEGER, GL_UNSIGNED_BYTE, &first_bin);
}

}  // namespace lightband
