// A picture in host memory: rows top-down, channels interleaved.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lightband {

struct RgbImage {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<float> rgb;  // height * width * 3, linear radiance
    std::vector<std::string> notes = {};  // what a reader had to change in it, for the log; one sentence each

    const float* texel(uint32_t x, uint32_t y) const { return &rgb[(size_t(y) * width + x) * 3]; }
};

}  // namespace lightband
