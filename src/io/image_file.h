// Pictures on disk: OpenEXR and Radiance HDR read, OpenEXR and PNG written.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "base/image.h"

namespace lightband::io {

// Largest latitude-longitude map that is accepted, in texels along each side.
constexpr uint32_t max_map_width = 16384;
constexpr uint32_t max_map_height = 8192;

// Reads an .exr or .hdr file, told apart by its first bytes, as latitude and longitude in Rec. 709. RGB; a luminance-only
// EXR gives grey. "map.exr#Combined" is the layer or part Combined of map.exr, unless a file has that whole name.
// LB_ERROR_FILE, LB_ERROR_FORMAT (corrupt, too large, no colour channels, no such layer).
// Values may be negative or not finite where the file's are; the environment judges them.
RgbImage read_image(const std::string& path);
RgbImage parse_exr(const std::vector<uint8_t>& bytes, const std::string& name, const std::string& layer = "");
RgbImage parse_hdr(const std::vector<uint8_t>& bytes, const std::string& name);

// One named float channel of a picture: width * height values, rows top-down.
struct NamedChannel {
    std::string name;
    std::vector<float> values;
};

// One entry of an EXR file's header.
struct Attribute {
    std::string name;
    std::variant<double, std::string> value;
};

// Writes float32 channels (ZIP compression, chromaticities of Rec. 709), or 8-bit RGBA as PNG; each as write_file does.
void write_exr(const std::string& path, uint32_t width, uint32_t height, const std::vector<NamedChannel>& channels,
               const std::vector<Attribute>& attributes = {});
void write_png(const std::string& path, uint32_t width, uint32_t height, const std::vector<uint8_t>& rgba);

}  // namespace lightband::io
