// Pictures on disk: OpenEXR and Radiance HDR read, OpenEXR and PNG written.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/image.h"

namespace lightband::io {

// Largest latitude-longitude map that is accepted, in texels along each side.
constexpr uint32_t max_map_width = 16384;
constexpr uint32_t max_map_height = 8192;

// Reads an .exr or .hdr file, told apart by its first bytes. RGB; a luminance-only EXR gives grey.
// LB_ERROR_FILE, LB_ERROR_FORMAT (corrupt, too large, no colour channels).
// Values are as stored: they may be negative or not finite; the environment judges them.
RgbImage read_image(const std::string& path);
RgbImage parse_exr(const std::vector<uint8_t>& bytes, const std::string& name);
RgbImage parse_hdr(const std::vector<uint8_t>& bytes, const std::string& name);

// One named float channel of a picture: width * height values, rows top-down.
struct NamedChannel {
    std::string name;
    std::vector<float> values;
};

// Writes float32 channels (ZIP compression), or 8-bit RGBA as PNG; each to a temporary file that is then renamed.
void write_exr(const std::string& path, uint32_t width, uint32_t height, const std::vector<NamedChannel>& channels);
void write_png(const std::string& path, uint32_t width, uint32_t height, const std::vector<uint8_t>& rgba);

}  // namespace lightband::io
