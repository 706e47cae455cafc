// EXR pictures made by OpenEXR, for the tests of the reader.
#pragma once

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfTileDescription.h>
#include <ImfTiledOutputFile.h>

#include <cmath>
#include <functional>

#include "io/image_file.h"
#include "io_testing.h"

namespace lightband::testing {

// Odd sizes, more than one tile and more than one block of scanlines; a window away from the origin.
constexpr int width = 37, height = 67, tile_size = 16;
const Imath::Box2i window({-5, 7}, {-5 + width - 1, 7 + height - 1});
const Imath::Box2i display = window;

inline RgbImage parse(const Bytes& bytes) {
    return io::parse_exr(bytes, "picture.exr");
}

using Value = std::function<double(int x, int y, int channel)>;

// Different at every place and exact in half, float, uint and the 24 bits of PXR24: at most 10 significant bits.
inline double counted(int x, int y, int channel) {
    return ((x + 8 * y) % 1024) << channel;
}

// Constant over large parts, in powers of two: the lossy compressions must not move a value by half an octave.
inline double quadrants(int x, int y, int channel) {
    return std::ldexp(1.0, (x < width / 2 ? 0 : 1) + (y < height / 2 ? 0 : 2) + 4 * channel);
}

// The values of one channel in the memory layout of a pixel type, rows top-down.
inline Bytes plane(Imf::PixelType type, int channel, const Value& value) {
    Bytes bytes;
    const auto append = [&](auto number) {
        const auto* first = reinterpret_cast<const uint8_t*>(&number);
        bytes.insert(bytes.end(), first, first + sizeof number);
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double v = value(x, y, channel);
            if (type == Imf::UINT) append(uint32_t(v));
            if (type == Imf::HALF) append(Imath::half(float(v)));
            if (type == Imf::FLOAT) append(float(v));
        }
    return bytes;
}

struct Kind {
    Imf::PixelType type = Imf::FLOAT;
    Imf::Compression compression = Imf::ZIP_COMPRESSION;
    bool tiled = false;
    std::vector<std::string> channels = {"R", "G", "B"};
    std::function<void(Imf::Header&)> change = [](Imf::Header&) {};
};

inline Imf::Header header_of(const Kind& kind) {
    Imf::Header header(display, window);
    header.compression() = kind.compression;
    for (const std::string& name : kind.channels) header.channels().insert(name, Imf::Channel(kind.type));
    if (kind.tiled) header.setTileDescription(Imf::TileDescription(tile_size, tile_size));
    kind.change(header);
    return header;
}

inline Bytes written(Imf::StdOSStream& stream) {
    const std::string text = stream.str();
    return Bytes(text.begin(), text.end());
}

inline Bytes make_exr(const Kind& kind, const Value& value) {
    Imf::StdOSStream stream;
    {
        const Imf::Header header = header_of(kind);
        std::vector<Bytes> planes;
        for (size_t i = 0; i < kind.channels.size(); ++i) planes.push_back(plane(kind.type, int(i), value));
        Imf::FrameBuffer buffer;
        for (size_t i = 0; i < kind.channels.size(); ++i)
            buffer.insert(kind.channels[i], Imf::Slice::Make(kind.type, planes[i].data(), window));
        if (kind.tiled) {
            Imf::TiledOutputFile file(stream, header);
            file.setFrameBuffer(buffer);
            file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
        } else {
            Imf::OutputFile file(stream, header);
            file.setFrameBuffer(buffer);
            file.writePixels(height);
        }
    }
    return written(stream);
}

inline void expect_size(const RgbImage& image) {
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    assert_int_equal(image.rgb.size(), size_t(width) * height * 3);
}

inline void expect_values(const RgbImage& image, const Value& value) {
    expect_size(image);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int channel = 0; channel < 3; ++channel)
                assert_float_equal(image.texel(x, y)[channel], value(x, y, channel), 0);
}

}  // namespace lightband::testing
