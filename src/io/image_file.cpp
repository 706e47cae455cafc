#include "io/image_file.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "io/file.h"
#include "io/printable.h"

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

RgbImage read_layer(const std::string& path, const std::string& layer) {
    const std::vector<uint8_t> bytes = read_file(path, max_image_bytes);
    if (begins_with(bytes, exr_start)) return parse_exr(bytes, path, layer);
    if (!begins_with(bytes, hdr_start))
        throw Error(LB_ERROR_FORMAT,
                    text(path, ": neither an OpenEXR file (first bytes 76 2f 31 01) nor a Radiance file (first bytes #?)"));
    if (!layer.empty())
        throw Error(LB_ERROR_FORMAT, text(path, ": a Radiance file has no layers, and so none named \"", printable(layer), "\""));
    return parse_hdr(bytes, path);
}

}  // namespace

RgbImage read_image(const std::string& path) {
    const size_t mark = path.rfind('#');
    const bool names_layer = mark != std::string::npos && mark + 1 < path.size() && !exists(path);
    return names_layer ? read_layer(path.substr(0, mark), path.substr(mark + 1)) : read_layer(path, "");
}

}  // namespace lightband::io
