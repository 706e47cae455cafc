#include "io/exr_pixels.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfTiledInputPart.h>

#include <algorithm>
#include <exception>
#include <new>

#include "base/error.h"
#include "io/exr_streams.h"
#include "io/ringing.h"

namespace lightband::io {
namespace {

// Called with the RGB of one chunk, rows top-down.
using Chunk = std::function<void(const Imath::Box2i& place, float* rgb)>;

size_t width_of(const Imath::Box2i& box) {
    return size_t(box.max.x - box.min.x + 1);
}
size_t height_of(const Imath::Box2i& box) {
    return size_t(box.max.y - box.min.y + 1);
}

// OpenEXR converts half and uint to float on the way.
Imf::FrameBuffer frame_buffer(const ColourChannels& channels, const Imath::Box2i& place, float* rgb) {
    constexpr size_t texel_stride = 3 * sizeof(float);
    Imf::FrameBuffer buffer;
    const auto insert = [&](const char* component, size_t offset) {
        buffer.insert(channels.channel(component),
                      Imf::Slice::Make(Imf::FLOAT, rgb + offset, place, texel_stride, texel_stride * width_of(place)));
    };
    if (channels.colour == Colour::grey) {
        insert("Y", 0);
    } else {
        insert("R", 0);
        insert("G", 1);
        insert("B", 2);
    }
    return buffer;
}

void spread_grey(const ColourChannels& channels, std::vector<float>* rgb) {
    if (channels.colour != Colour::grey) return;
    for (size_t i = 0; i < rgb->size(); i += 3) (*rgb)[i + 1] = (*rgb)[i + 2] = (*rgb)[i];
}

// Runs a call of OpenEXR that decodes pixels. If it fails and memory is short, throws std::bad_alloc instead: where
// zlib fails, OpenEXR does not say whether for lack of memory. An allocation is tried here, before the callers free
// what they hold.
template <class Call>
void decode(const Call& call) {
    try {
        call();
    } catch (const std::exception&) {
        constexpr size_t more_than_zlib_needs = 1 << 16;          // zconf.h: about 44 kB to decompress
        ::operator delete(::operator new(more_than_zlib_needs));  // direct calls, which compilers do not leave out
        throw;
    }
}

// One chunk to a call of OpenEXR, in all that follows: where memory runs out within a chunk, OpenEXR 3.1 notes it, goes
// on to the next one with the same decoder, and that of DWAA and DWAB then writes into buffers that it did not get
// (before 3.3, whose decoders are others).

void read_scanlines(Imf::InputPart input, const ColourChannels& channels, const Imath::Box2i& window,
                    const Chunk& use) {
    const Imath::Box2i data = input.header().dataWindow();
    constexpr int shortest_strip = 16;  // of compressions whose chunks are single lines and hold no buffers
    const int lines = std::max(shortest_strip, lines_per_chunk(input.header().compression()));
    std::vector<float> rgb;
    for (int64_t y = data.min.y; y <= data.max.y; y += lines) {
        const Imath::Box2i place({data.min.x, int(y)}, {data.max.x, int(std::min<int64_t>(y + lines - 1, data.max.y))});
        if (!place.intersects(window)) continue;
        rgb.resize(width_of(place) * height_of(place) * 3);
        input.setFrameBuffer(frame_buffer(channels, place, rgb.data()));
        decode([&] { input.readPixels(place.min.y, place.max.y); });
        spread_grey(channels, &rgb);
        use(place, rgb.data());
    }
}

// Of files with several levels of detail, the finest.
void read_tiles(Imf::TiledInputPart input, const ColourChannels& channels, const Imath::Box2i& window,
                const Chunk& use) {
    constexpr int finest = 0;
    std::vector<float> rgb;
    for (int y = 0; y < input.numYTiles(finest); ++y)
        for (int x = 0; x < input.numXTiles(finest); ++x) {
            const Imath::Box2i place = input.dataWindowForTile(x, y, finest);
            if (!place.intersects(window)) continue;
            rgb.resize(width_of(place) * height_of(place) * 3);
            input.setFrameBuffer(frame_buffer(channels, place, rgb.data()));
            decode([&] { input.readTile(x, y, finest); });
            spread_grey(channels, &rgb);
            use(place, rgb.data());
        }
}

// OpenEXR fills in the missing chroma and converts to RGB, at half precision, as such files are written.
void read_luminance_chroma(const std::vector<uint8_t>& bytes, const std::string& name, const ColourChannels& channels,
                           const Imath::Box2i& window, const Chunk& use) {
    BytesIn stream(bytes, name);
    Imf::RgbaInputFile file(stream, channels.layer, no_threads);
    const Imath::Box2i data = file.dataWindow();
    std::vector<Imf::Rgba> line(width_of(data));
    std::vector<float> rgb(line.size() * 3);
    for (int y = std::max(data.min.y, window.min.y); y <= std::min(data.max.y, window.max.y); ++y) {
        const Imath::Box2i place({data.min.x, y}, {data.max.x, y});
        file.setFrameBuffer(Imf::ComputeBasePointer(line.data(), place), 1, line.size());
        decode([&] { file.readPixels(y); });
        for (size_t x = 0; x < line.size(); ++x) {
            rgb[x * 3 + 0] = line[x].r;
            rgb[x * 3 + 1] = line[x].g;
            rgb[x * 3 + 2] = line[x].b;
        }
        use(place, rgb.data());
    }
}

void copy_into(const Imath::Box2i& window, const Imath::Box2i& place, const float* rgb, RgbImage* image) {
    const int first = std::max(place.min.x, window.min.x), last = std::min(place.max.x, window.max.x);
    if (first > last) return;
    for (int y = std::max(place.min.y, window.min.y); y <= std::min(place.max.y, window.max.y); ++y) {
        const float* from = rgb + (size_t(y - place.min.y) * width_of(place) + size_t(first - place.min.x)) * 3;
        float* to = &image->rgb[(size_t(y - window.min.y) * image->width + size_t(first - window.min.x)) * 3];
        std::copy_n(from, size_t(last - first + 1) * 3, to);
    }
}

// Chroma is interpolated, luminance is not: beside an edge, a texel that is darker than its chroma comes out with a
// negative component. It is light all the same where its luminance is.
size_t clear_impossible_chroma(RgbImage* image) {
    size_t count = 0;
    for (size_t i = 0; i < image->rgb.size(); i += 3) {
        float* const texel = &image->rgb[i];
        const bool is_negative = texel[0] < 0 || texel[1] < 0 || texel[2] < 0;
        if (!is_negative || !(luminance(Vec3(texel[0], texel[1], texel[2])) >= 0)) continue;
        for (int c = 0; c < 3; ++c) texel[c] = std::max(texel[c], 0.0f);
        ++count;
    }
    return count;
}

}  // namespace

RgbImage read_window(Imf::MultiPartInputFile& file, const ColourChannels& channels, const std::vector<uint8_t>& bytes,
                     const std::string& name, const Imath::Box2i& window) {
    const Imf::Header& header = file.header(channels.part);
    RgbImage image;
    image.width = uint32_t(width_of(window));
    image.height = uint32_t(height_of(window));
    image.rgb.resize(size_t(image.width) * image.height * 3);

    if (channels.colour == Colour::luminance_chroma) {
        read_luminance_chroma(bytes, name, channels, window,
                              [&](const Imath::Box2i& place, float* rgb) { copy_into(window, place, rgb, &image); });
        if (const size_t count = clear_impossible_chroma(&image))
            image.notes.push_back(text("of ", count, " texels, chroma at half resolution gave negative components; ",
                                       "these were set to 0"));
        return image;
    }
    const bool single = channels.colour == Colour::grey;
    Ringing ringing(header.compression(), header.channels()[channels.channel(single ? "Y" : "G")], single);
    const Chunk use = [&](const Imath::Box2i& place, float* rgb) {
        ringing.remove(rgb, width_of(place), height_of(place));
        copy_into(window, place, rgb, &image);
    };
    if (header.type() == Imf::TILEDIMAGE)
        read_tiles(Imf::TiledInputPart(file, channels.part), channels, window, use);
    else
        read_scanlines(Imf::InputPart(file, channels.part), channels, window, use);
    if (ringing.count() > 0)
        image.notes.push_back(text(ringing.count(),
                                   " negative values, the ringing of its lossy compression (the least is ",
                                   ringing.least(), "), were set to 0"));
    return image;
}

}  // namespace lightband::io
