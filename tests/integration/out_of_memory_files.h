// The files that the scenarios of failing memory read, and what is in those that they write.
#pragma once

#include <ImfCompression.h>

#include <cstdint>
#include <string>
#include <vector>

using Bytes = std::vector<uint8_t>;

constexpr uint32_t map_width = 64, map_height = 32;

// Smooth, with a brighter patch; RGB.
std::vector<float> map_in_memory();

// The same map. Returns path.
std::string write_exr(const std::string& path, Imf::Compression compression);

// A Radiance map without run lengths: four bytes a texel. Returns path.
std::string write_hdr(const std::string& path);

// A MERL file whose cells of the last five degrees of theta_d are unmeasured: they are filled when it is loaded.
void write_merl(const std::string& path);

// What a file shows. The header of an OpenEXR file says how many milliseconds its render took: only its pixels count,
// of which there are none where OpenEXR finds lines missing.
Bytes file_contents(const std::string& path);
