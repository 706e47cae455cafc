#include "out_of_memory_files.h"

#include <IexBaseExc.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfRgbaFile.h>
#include <ImfTestFile.h>

#include <fstream>
#include <iterator>

namespace {

Bytes file_bytes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return Bytes(std::istreambuf_iterator<char>(file), {});
}

Bytes exr_pixels(const std::string& path) {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    const size_t width = size_t(window.max.x + 1), height = size_t(window.max.y + 1);
    Bytes pixels;
    for (auto channel = file.header().channels().begin(); channel != file.header().channels().end(); ++channel) {
        std::vector<float> values(width * height);
        Imf::FrameBuffer target;
        target.insert(channel.name(), Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float),
                                                 sizeof(float) * width));
        file.setFrameBuffer(target);
        file.readPixels(window.min.y, window.max.y);
        const auto* first = reinterpret_cast<const uint8_t*>(values.data());
        pixels.insert(pixels.end(), first, first + values.size() * sizeof(float));
    }
    return pixels;
}

// Smooth, with a brighter patch.
float radiance(uint32_t x, uint32_t y, uint32_t channel) {
    const bool patch = x / 8 == 2 && y / 8 == 1;
    return (patch ? 40.0f : 1.0f) + float(x + 2 * y + 3 * channel) / 64.0f;
}

}  // namespace

Bytes file_contents(const std::string& path) {
    if (!Imf::isOpenExrFile(path.c_str())) return file_bytes(path);
    try {
        return exr_pixels(path);
    } catch (const Iex::InputExc&) {
        return {};
    }
}

std::vector<float> map_in_memory() {
    std::vector<float> rgb;
    for (uint32_t y = 0; y < map_height; ++y)
        for (uint32_t x = 0; x < map_width; ++x)
            for (uint32_t channel = 0; channel < 3; ++channel) rgb.push_back(radiance(x, y, channel));
    return rgb;
}

std::string write_exr(const std::string& path, Imf::Compression compression) {
    Imf::Header header{int(map_width), int(map_height)};
    header.compression() = compression;
    std::vector<Imf::Rgba> pixels;
    for (uint32_t y = 0; y < map_height; ++y)
        for (uint32_t x = 0; x < map_width; ++x)
            pixels.emplace_back(radiance(x, y, 0), radiance(x, y, 1), radiance(x, y, 2));
    Imf::RgbaOutputFile file(path.c_str(), header, Imf::WRITE_RGB);
    file.setFrameBuffer(pixels.data(), 1, map_width);
    file.writePixels(int(map_height));
    return path;
}

std::string write_hdr(const std::string& path) {
    std::ofstream file(path, std::ios::binary);
    file << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 4\n";
    for (int texel = 0; texel < 16; ++texel) file << char(20 + texel) << char(40) << char(60) << char(128);
    return path;
}

void write_merl(const std::string& path) {
    constexpr int32_t cells[3] = {90, 90, 180}, measured = 85;
    constexpr double value = 10, unmeasured = -1;
    std::vector<double> values;
    for (int row = 0; row < 3 * cells[0] * cells[1]; ++row)
        values.insert(values.end(), size_t(cells[2]), row % cells[1] < measured ? value : unmeasured);
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(cells), sizeof cells);
    file.write(reinterpret_cast<const char*>(values.data()), std::streamsize(values.size() * sizeof(double)));
}
