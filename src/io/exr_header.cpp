#include "io/exr_header.h"

#include <ImfChannelList.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>

#include <algorithm>
#include <set>

#include "base/error.h"
#include "io/image_file.h"
#include "io/printable.h"

namespace lightband::io {
namespace {

Colour colour_of(const Imf::Header& header, const ColourChannels& names) {
    if (header.hasType() && Imf::isDeepData(header.type())) return Colour::none;
    const auto find = [&](const char* component) {
        return header.channels().findChannel(names.channel(component));
    };
    const auto has = [&](const char* component, int sampling) {
        const Imf::Channel* channel = find(component);
        return channel && channel->xSampling == sampling && channel->ySampling == sampling;
    };
    if (has("R", 1) && has("G", 1) && has("B", 1)) return Colour::rgb;
    if (!has("Y", 1)) return Colour::none;
    if (has("RY", 2) && has("BY", 2)) return Colour::luminance_chroma;
    return find("RY") || find("BY") ? Colour::none : Colour::grey;
}

std::string listed(const std::set<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + printable(name);
    return list.empty() ? "none" : list;
}

std::string channel_names(const Imf::MultiPartInputFile& file) {
    std::string names;
    for (int part = 0; part < file.parts(); ++part) {
        const Imf::ChannelList& channels = file.header(part).channels();
        for (auto channel = channels.begin(); channel != channels.end(); ++channel)
            names += text(names.empty() ? "" : ", ", channel.name());
    }
    return names;
}

// The layers and parts in which find_colour finds colour.
std::set<std::string> layer_names(const Imf::MultiPartInputFile& file) {
    std::set<std::string> names;
    for (int part = 0; part < file.parts(); ++part) {
        const Imf::Header& header = file.header(part);
        if (header.hasName() && colour_of(header, {}) != Colour::none) names.insert(header.name());
        const Imf::ChannelList& channels = header.channels();
        for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
            const std::string full = channel.name();
            const size_t dot = full.rfind('.');
            if (dot == std::string::npos || dot == 0) continue;
            const std::string layer = full.substr(0, dot);
            if (colour_of(header, {part, Colour::none, layer}) != Colour::none) names.insert(layer);
        }
    }
    return names;
}

// Steps over the attribute (name, type, size, value) that begins at position, and returns where the next one begins;
// the end of the bytes where they end before the value does.
size_t next_attribute(const std::vector<uint8_t>& bytes, size_t position, const std::string& name) {
    const auto end_of_string = [&](size_t start) {
        return size_t(std::find(bytes.begin() + start, bytes.end(), 0) - bytes.begin());
    };
    constexpr size_t size_field = 4;
    const size_t name_end = end_of_string(position);
    const size_t type_end = end_of_string(std::min(name_end + 1, bytes.size()));
    if (bytes.size() - type_end < 1 + size_field) return bytes.size();
    const size_t value = type_end + 1 + size_field;
    uint32_t size = 0;
    for (size_t i = 1; i <= size_field; ++i) size = size << 8 | bytes[value - i];
    if (size > bytes.size() - value)
        throw Error(LB_ERROR_FORMAT, text(name, ": header attribute ",
                                          printable(std::string(bytes.begin() + position, bytes.begin() + name_end)),
                                          " announces ", size, " bytes, but only ", bytes.size() - value, " follow"));
    return value + size;
}

void check_window(const Imath::Box2i& window, const char* which, const std::string& name) {
    const int64_t width = int64_t(window.max.x) - window.min.x + 1;
    const int64_t height = int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > max_map_width || height > max_map_height)
        throw Error(LB_ERROR_FORMAT, text(name, ": ", which, " window of ", width, " x ", height,
                                          " texels is outside the limits 1 x 1 and ", max_map_width, " x ", max_map_height));
}

}  // namespace

ColourChannels find_colour(const Imf::MultiPartInputFile& file, const std::string& layer, const std::string& name) {
    for (int part = 0; part < file.parts(); ++part) {
        const Imf::Header& header = file.header(part);
        const bool is_named = layer.empty() || (header.hasName() && header.name() == layer);
        for (const std::string& prefix : {layer, std::string()}) {
            if (prefix.empty() && !is_named) continue;
            ColourChannels found{part, Colour::none, prefix};
            found.colour = colour_of(header, found);
            // RgbaInputFile, which reads luminance and chroma, knows the first part alone.
            if (found.colour == Colour::luminance_chroma && part > 0) continue;
            if (found.colour != Colour::none) return found;
        }
    }
    if (!layer.empty())
        throw Error(LB_ERROR_FORMAT, text(name, ": there is no layer or part \"", printable(layer),
                                          "\" with colour; there are: ", listed(layer_names(file))));
    throw Error(LB_ERROR_FORMAT,
                text(name,
                     ": no colour: expected channels R, G, B or Y at full resolution, or Y with RY, BY at half "
                     "resolution in the first part, not deep; found: ",
                     printable(channel_names(file)), "; layers that \"path#layer\" reads: ", listed(layer_names(file))));
}

// Sections "Version Field" and "Header" of "OpenEXR File Layout". All other faults of the headers are left to OpenEXR.
void check_attribute_sizes(const std::vector<uint8_t>& bytes, const std::string& name) {
    constexpr size_t version_field = 4, first_header = 8;
    constexpr uint8_t multi_part_flag = 0x10;  // in the second byte of the version field
    size_t position = first_header;
    while (position < bytes.size() && bytes[position] != 0) {
        while (position < bytes.size() && bytes[position] != 0) position = next_attribute(bytes, position, name);
        ++position;  // the zero that ends a header; a second one ends all headers of a multi-part file
        if (!(bytes[version_field + 1] & multi_part_flag)) return;
    }
}

void check_sizes(const Imf::Header& header, size_t file_bytes, const std::string& name) {
    check_window(header.dataWindow(), "data", name);
    check_window(header.displayWindow(), "display", name);
    const int64_t width = int64_t(header.dataWindow().max.x) - header.dataWindow().min.x + 1;
    const int64_t height = int64_t(header.dataWindow().max.y) - header.dataWindow().min.y + 1;
    int64_t chunk_width = width, chunk_height = lines_per_chunk(header.compression());
    if (header.hasTileDescription()) {
        const Imf::TileDescription& tile = header.tileDescription();
        if (tile.xSize < 1 || tile.ySize < 1 || tile.xSize > max_map_width || tile.ySize > max_map_height)
            throw Error(LB_ERROR_FORMAT, text(name, ": tiles of ", tile.xSize, " x ", tile.ySize,
                                              " texels are outside the limits 1 x 1 and ", max_map_width, " x ", max_map_height));
        chunk_width = tile.xSize;
        chunk_height = tile.ySize;
    }
    int64_t texel_bytes = 0;
    const Imf::ChannelList& channels = header.channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
        texel_bytes += channel.channel().type == Imf::HALF ? 2 : 4;
    // OpenEXR decodes a chunk as a whole, with all its channels: 256 lines of 16384 texels of 30 floats. Its own working
    // memory is about as much again.
    constexpr int64_t largest_chunk = int64_t(512) << 20;
    if (chunk_width * chunk_height * texel_bytes > largest_chunk)
        throw Error(LB_ERROR_FORMAT,
                    text(name, ": a chunk of ", chunk_width, " x ", chunk_height, " texels of ", texel_bytes,
                         " bytes is larger than the limit of ", largest_chunk, " bytes"));
    constexpr int64_t table_entry = 8;  // bytes of the chunk's place in the file
    const int64_t chunks = ((width - 1) / chunk_width + 1) * ((height - 1) / chunk_height + 1);
    if (chunks * table_entry > int64_t(file_bytes))
        throw Error(LB_ERROR_FORMAT, text(name, ": the table of its ", chunks, " chunks alone is larger than the file"));
}

int lines_per_chunk(Imf::Compression compression) {
    switch (compression) {
        case Imf::ZIP_COMPRESSION:
        case Imf::PXR24_COMPRESSION: return 16;
        case Imf::PIZ_COMPRESSION:
        case Imf::B44_COMPRESSION:
        case Imf::B44A_COMPRESSION:
        case Imf::DWAA_COMPRESSION: return 32;
        case Imf::DWAB_COMPRESSION: return 256;
        default: return 1;
    }
}

// As OpenEXR's AcesInputFile does: the white that is to look white is adoptedNeutral, where the file has it.
std::optional<glm::dmat3> colour_conversion(const Imf::Header& header, const std::string& name) {
    const auto pair = [](const Imath::V2f& xy) { return Vec2(xy.x, xy.y); };
    Chromaticities from = rec709;
    std::optional<Vec2> neutral;
    if (Imf::hasChromaticities(header)) {
        const Imf::Chromaticities& c = Imf::chromaticities(header);
        from = {pair(c.red), pair(c.green), pair(c.blue), pair(c.white)};
    }
    if (Imf::hasAdoptedNeutral(header)) neutral = pair(Imf::adoptedNeutral(header));
    return to_rec709(from, neutral, name);
}

}  // namespace lightband::io
