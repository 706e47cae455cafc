// What interpolation costs is held against the bandwidth in tiles of the picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lightband {

struct Tiles {
    size_t count = 0;
    std::vector<uint32_t> of;  // of each pixel
};

// Factors on the bandwidth under which levels are chosen: in each tile; and in all before anything was seen of them.
struct Scales {
    std::vector<float> of;
    float first = 1;
};

// Squares of so many pixels a side.
constexpr uint32_t tile_side = 16;
constexpr uint32_t tiles_along(uint32_t pixels) { return (pixels + tile_side - 1) / tile_side; }

inline Tiles tiles_of_picture(uint32_t width, uint32_t height) {
    Tiles tiles{size_t(tiles_along(width)) * tiles_along(height), {}};
    tiles.of.reserve(size_t(width) * height);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) tiles.of.push_back(y / tile_side * tiles_along(width) + x / tile_side);
    return tiles;
}

}  // namespace lightband
