// OpenEXR pictures, written to memory and then to a file.
#include <IexBaseExc.h>
#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfName.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "base/error.h"
#include "io/exr_streams.h"
#include "io/file.h"
#include "io/image_file.h"

namespace lightband::io {
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

Imf::Header header_of(uint32_t width, uint32_t height, const std::vector<Attribute>& attributes) {
    Imf::Header header{int(width), int(height)};  // its pixel aspect ratio is 1
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::addChromaticities(header, Imf::Chromaticities());  // those of Rec. 709
    for (const Attribute& attribute : attributes) {
        if (const double* number = std::get_if<double>(&attribute.value))
            header.insert(attribute.name, Imf::DoubleAttribute(*number));
        else
            header.insert(attribute.name, Imf::StringAttribute(std::get<std::string>(attribute.value)));
    }
    return header;
}

// Whether the file holds the values, bit by bit: where the compressor of a chunk gets no memory, OpenEXR 3.1 forgets it as soon
// as the next chunk is compressed, and leaves a file without the pixels.
bool holds(const std::vector<uint8_t>& bytes, const std::string& path, const std::vector<NamedChannel>& channels) {
    BytesIn stream(bytes, path);
    Imf::InputFile file(stream, no_threads);
    const Imath::Box2i window = file.header().dataWindow();
    const size_t width = size_t(window.max.x) + 1;
    constexpr int lines = 16;  // of a ZIP chunk
    std::vector<float> strip(width * lines * channels.size());
    for (int first = 0; first <= window.max.y; first += lines) {
        const Imath::Box2i place({0, first}, {window.max.x, std::min(first + lines - 1, window.max.y)});
        const size_t count = width * size_t(place.max.y - first + 1);
        Imf::FrameBuffer buffer;
        for (size_t i = 0; i < channels.size(); ++i)
            buffer.insert(channels[i].name, Imf::Slice::Make(Imf::FLOAT, &strip[i * count], place));
        file.setFrameBuffer(buffer);
        file.readPixels(place.min.y, place.max.y);
        for (size_t i = 0; i < channels.size(); ++i)
            if (std::memcmp(&strip[i * count], &channels[i].values[width * size_t(first)], count * sizeof(float)) != 0)
                return false;
    }
    return true;
}

}  // namespace

void write_exr(const std::string& path, uint32_t width, uint32_t height, const std::vector<NamedChannel>& channels,
               const std::vector<Attribute>& attributes) {
    check_channels(path, width, height, channels);
    BytesOut stream(path);
    bool complete = false;
    try {
        Imf::Header header = header_of(width, height, attributes);
        Imf::FrameBuffer buffer;
        for (const NamedChannel& channel : channels) {  // both lists keep themselves sorted by name
            header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
            buffer.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), header.dataWindow()));
        }
        {
            Imf::OutputFile file(stream, header, no_threads);
            file.setFrameBuffer(buffer);
            file.writePixels(int(height));
        }
        complete = holds(stream.bytes(), path, channels);
    } catch (const Iex::ArgExc& reason) {
        throw Error(LB_ERROR_INTERNAL, text(path, ": OpenEXR refuses the picture: ", reason.what()));
    } catch (const std::exception&) {
    }
    // The arguments were checked, and all was written to memory: nothing but memory can have been missing.
    if (!complete) throw std::bad_alloc();
    write_file(path, stream.bytes());
}

}  // namespace lightband::io
