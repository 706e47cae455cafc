// OpenEXR through its C++ interface, from and to memory.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfName.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "base/error.h"
#include "io/file.h"
#include "io/image_file.h"
#include "io/printable.h"

namespace lightband::io {
namespace {

// Decode on the calling thread.
constexpr int no_threads = 0;

// ---- Streams ------------------------------------------------------------------------------------

class BytesIn : public Imf::IStream {
public:
    BytesIn(const std::vector<uint8_t>& bytes, const std::string& name) : IStream(name.c_str()), bytes_(bytes) {}

    bool read(char* out, int count) override {
        if (count < 0 || position_ > bytes_.size() || bytes_.size() - position_ < uint64_t(count))
            throw std::runtime_error("the file ends early");
        if (count > 0) std::memcpy(out, bytes_.data() + position_, size_t(count));
        position_ += uint64_t(count);
        return position_ < bytes_.size();
    }
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override { position_ = position; }

private:
    const std::vector<uint8_t>& bytes_;
    uint64_t position_ = 0;
};

class BytesOut : public Imf::OStream {
public:
    explicit BytesOut(const std::string& name) : OStream(name.c_str()) {}

    void write(const char* data, int count) override {
        const size_t end = position_ + size_t(count);
        if (bytes_.size() < end) bytes_.resize(end);
        std::memcpy(bytes_.data() + position_, data, size_t(count));
        position_ = end;
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = position; }

    const std::vector<uint8_t>& bytes() const { return bytes_; }

private:
    std::vector<uint8_t> bytes_;
    size_t position_ = 0;
};

// ---- Reading ------------------------------------------------------------------------------------

enum class Colour { none, rgb, grey, luminance_chroma };

bool has_channel(const Imf::Header& header, const char* name, int sampling) {
    const Imf::Channel* channel = header.channels().findChannel(name);
    return channel && channel->xSampling == sampling && channel->ySampling == sampling;
}

Colour colour_of(const Imf::Header& header) {
    if (header.hasType() && Imf::isDeepData(header.type())) return Colour::none;
    if (has_channel(header, "R", 1) && has_channel(header, "G", 1) && has_channel(header, "B", 1)) return Colour::rgb;
    if (!has_channel(header, "Y", 1)) return Colour::none;
    if (has_channel(header, "RY", 2) && has_channel(header, "BY", 2)) return Colour::luminance_chroma;
    const bool has_other_chroma = header.channels().findChannel("RY") || header.channels().findChannel("BY");
    return has_other_chroma ? Colour::none : Colour::grey;
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

// OpenEXR reserves an attribute's announced size, up to 2 GiB, before it looks whether the file holds as much. This
// walk over the headers ("OpenEXR File Layout", sections "Version Field" and "Header") looks first; all other faults of
// the headers are left to OpenEXR.
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

// Sizes are checked before OpenEXR or we reserve memory in proportion to them.
void check_size(const Imf::Header& header, const std::string& name) {
    const Imath::Box2i& window = header.dataWindow();
    const int64_t width = int64_t(window.max.x) - window.min.x + 1;
    const int64_t height = int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > max_map_width || height > max_map_height)
        throw Error(LB_ERROR_FORMAT,
                    text(name, ": data window of ", width, " x ", height, " texels is outside the limits 1 x 1 and ",
                         max_map_width, " x ", max_map_height));
    if (!header.hasTileDescription()) return;
    const Imf::TileDescription& tile = header.tileDescription();
    if (tile.xSize > max_map_width || tile.ySize > max_map_height)
        throw Error(LB_ERROR_FORMAT, text(name, ": tiles of ", tile.xSize, " x ", tile.ySize,
                                          " texels exceed the limit of ", max_map_width, " x ", max_map_height));
}

RgbImage empty_image(const Imath::Box2i& window) {
    RgbImage image;
    image.width = uint32_t(window.max.x - window.min.x + 1);
    image.height = uint32_t(window.max.y - window.min.y + 1);
    image.rgb.resize(size_t(image.width) * image.height * 3);
    return image;
}

// OpenEXR converts half and uint to float on the way.
RgbImage read_part(Imf::MultiPartInputFile& file, int part, Colour colour) {
    const Imath::Box2i window = file.header(part).dataWindow();
    RgbImage image = empty_image(window);
    const size_t texel_stride = 3 * sizeof(float);
    const auto slice = [&](size_t channel) {
        return Imf::Slice::Make(Imf::FLOAT, image.rgb.data() + channel, window, texel_stride,
                                texel_stride * image.width);
    };
    Imf::FrameBuffer buffer;
    if (colour == Colour::rgb) {
        buffer.insert("R", slice(0));
        buffer.insert("G", slice(1));
        buffer.insert("B", slice(2));
    } else {
        buffer.insert("Y", slice(0));
    }
    Imf::InputPart input(file, part);
    input.setFrameBuffer(buffer);
    input.readPixels(window.min.y, window.max.y);
    if (colour == Colour::grey)
        for (size_t i = 0; i < image.rgb.size(); i += 3) image.rgb[i + 1] = image.rgb[i + 2] = image.rgb[i];
    return image;
}

// OpenEXR fills in the missing chroma and converts to RGB, at half precision, as such files are written.
RgbImage read_luminance_chroma(const std::vector<uint8_t>& bytes, const std::string& name) {
    BytesIn stream(bytes, name);
    Imf::RgbaInputFile file(stream, no_threads);
    const Imath::Box2i window = file.dataWindow();
    RgbImage image = empty_image(window);
    std::vector<Imf::Rgba> pixels(size_t(image.width) * image.height);
    file.setFrameBuffer(Imf::ComputeBasePointer(pixels.data(), window), 1, image.width);
    file.readPixels(window.min.y, window.max.y);
    for (size_t i = 0; i < pixels.size(); ++i) {
        image.rgb[i * 3 + 0] = pixels[i].r;
        image.rgb[i * 3 + 1] = pixels[i].g;
        image.rgb[i * 3 + 2] = pixels[i].b;
    }
    return image;
}

RgbImage read_first_colour(const std::vector<uint8_t>& bytes, const std::string& name) {
    check_attribute_sizes(bytes, name);
    BytesIn stream(bytes, name);
    constexpr bool mend_chunk_table = false;  // an incomplete file is an error, not something to make the best of
    Imf::MultiPartInputFile file(stream, no_threads, mend_chunk_table);
    for (int part = 0; part < file.parts(); ++part) {
        const Colour colour = colour_of(file.header(part));
        // RgbaInputFile knows the first part alone.
        if (colour == Colour::none || (colour == Colour::luminance_chroma && part > 0)) continue;
        check_size(file.header(part), name);
        RgbImage image =
            colour == Colour::luminance_chroma ? read_luminance_chroma(bytes, name) : read_part(file, part, colour);
        const Imf::Compression compression = file.header(part).compression();
        image.lossy = compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
        return image;
    }
    throw Error(LB_ERROR_FORMAT, text(name,
                                      ": no colour: expected channels R, G, B or Y at full resolution, or Y with "
                                      "RY, BY at half resolution in the first part; found: ",
                                      printable(channel_names(file))));
}

}  // namespace

RgbImage parse_exr(const std::vector<uint8_t>& bytes, const std::string& name) {
    try {
        return read_first_colour(bytes, name);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& reason) {
        throw Error(LB_ERROR_FORMAT, text(name, ": OpenEXR cannot read it: ", reason.what()));
    }
}

// ---- Writing ------------------------------------------------------------------------------------

namespace {

void check_channels(const std::string& path, uint32_t width, uint32_t height,
                    const std::vector<NamedChannel>& channels) {
    const auto reject = [&](const std::string& what) { throw Error(LB_ERROR_INVALID_ARGUMENT, path + ": " + what); };
    constexpr size_t longest_name = Imf::Name::MAX_LENGTH;
    constexpr uint32_t largest = 1u << 30;  // OpenEXR's limit on coordinates, half of the range of int
    if (width == 0 || height == 0 || width > largest || height > largest)
        reject(text("a picture of ", width, " x ", height, " pixels cannot be written"));
    if (channels.empty()) reject("a picture without channels cannot be written");
    for (const NamedChannel& channel : channels) {
        if (channel.name.empty() || channel.name.size() > longest_name)
            reject(text("channel name '", channel.name, "' is not of 1 to ", longest_name, " characters"));
        if (channel.values.size() != size_t(width) * height)
            reject(text("channel ", channel.name, " has ", channel.values.size(), " values, expected ", width, " x ",
                        height));
        const auto same_name = [&](const NamedChannel& other) { return other.name == channel.name; };
        if (std::count_if(channels.begin(), channels.end(), same_name) > 1)
            reject(text("channel ", channel.name, " is given twice"));
    }
}

}  // namespace

void write_exr(const std::string& path, uint32_t width, uint32_t height, const std::vector<NamedChannel>& channels) {
    check_channels(path, width, height, channels);
    BytesOut stream(path);
    try {
        Imf::Header header{int(width), int(height)};
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::FrameBuffer buffer;
        for (const NamedChannel& channel : channels) {  // both lists keep themselves sorted by name
            header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
            buffer.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), header.dataWindow()));
        }
        Imf::OutputFile file(stream, header, no_threads);
        file.setFrameBuffer(buffer);
        file.writePixels(int(height));
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& reason) {
        throw Error(LB_ERROR_FILE, text(path, ": OpenEXR cannot encode it: ", reason.what()));
    }
    write_file(path, stream.bytes());
}

}  // namespace lightband::io
