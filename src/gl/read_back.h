// Textures of one texel a pixel, read back into host memory.
#pragma once

#include <cstdint>
#include <vector>

#include "gl/objects.h"

namespace lightband {

inline std::vector<float> read_floats(const gl::Texture& texture, GLenum format, size_t texels, size_t components) {
    std::vector<float> values(texels * components);
    texture.read(0, format, GL_FLOAT, values.size() * sizeof(float), values.data());
    return values;
}

inline std::vector<uint8_t> read_bytes(const gl::Texture& texture, size_t texels) {
    std::vector<uint8_t> values(texels);
    texture.read(0, GL_RED_INTEGER, GL_UNSIGNED_BYTE, values.size(), values.data());
    return values;
}

inline std::vector<uint32_t> read_words(const gl::Texture& texture, size_t texels) {
    std::vector<uint32_t> values(texels);
    texture.read(0, GL_RED_INTEGER, GL_UNSIGNED_INT, texels * sizeof(uint32_t), values.data());
    return values;
}

}  // namespace lightband
