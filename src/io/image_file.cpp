#include "io/image_file.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "io/file.h"

namespace lightband::io {
namespace {

// The largest accepted map as uncompressed half floats takes 0.75 GiB; as floats it needs a compression.
constexpr uint64_t max_image_bytes = uint64_t(1) << 30;

template <size_t count>
bool begins_with(const std::vector<uint8_t>& bytes, const std::array<uint8_t, count>& start) {
    return bytes.size() >= count && std::equal(start.begin(), start.end(), bytes.begin());
}

// OpenEXR File Layout, "Magic number": 20000630, little-endian.
constexpr std::array<uint8_t, 4> exr_start = {0x76, 0x2f, 0x31, 0x01};
constexpr std::array<uint8_t, 2> hdr_start = {'#', '?'};

}  // namespace

RgbImage read_image(const std::string& path) {
    const std::vector<uint8_t> bytes = read_file(path, max_image_bytes);
    if (begins_with(bytes, exr_start)) return parse_exr(bytes, path);
    if (begins_with(bytes, hdr_start)) return parse_hdr(bytes, path);
    throw Error(LB_ERROR_FORMAT,
                text(path, ": neither an OpenEXR file (first bytes 76 2f 31 01) nor a Radiance file (first bytes #?)"));
}

}  // namespace lightband::io
