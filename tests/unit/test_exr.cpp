// OpenEXR pictures of every kind, written by OpenEXR and read by parse_exr.
#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

#include "io/file.h"
#include "io/image_file.h"
#include "io_testing.h"

namespace {

using namespace lightband;
using namespace lightband::testing;

// Odd sizes, more than one tile and more than one block of scanlines; a window away from the origin.
constexpr int width = 37, height = 67, tile_size = 16;
const Imath::Box2i window({-5, 7}, {-5 + width - 1, 7 + height - 1});
const Imath::Box2i display({0, 0}, {99, 99});

RgbImage parse(const Bytes& bytes) {
    return io::parse_exr(bytes, "picture.exr");
}

using Value = std::function<double(int x, int y, int channel)>;

// Different at every place and exact in half, float, uint and the 24 bits of PXR24: at most 10 significant bits.
double counted(int x, int y, int channel) {
    return ((x + 8 * y) % 1024) << channel;
}

// Constant over large parts, in powers of two: the lossy compressions must not move a value by half an octave.
double quadrants(int x, int y, int channel) {
    return std::ldexp(1.0, (x < width / 2 ? 0 : 1) + (y < height / 2 ? 0 : 2) + 4 * channel);
}

// The values of one channel in the memory layout of a pixel type, rows top-down.
Bytes plane(Imf::PixelType type, int channel, const Value& value) {
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
};

Imf::Header header_of(const Kind& kind) {
    Imf::Header header(display, window);
    header.compression() = kind.compression;
    for (const std::string& name : kind.channels) header.channels().insert(name, Imf::Channel(kind.type));
    if (kind.tiled) header.setTileDescription(Imf::TileDescription(tile_size, tile_size));
    return header;
}

Bytes written(Imf::StdOSStream& stream) {
    const std::string text = stream.str();
    return Bytes(text.begin(), text.end());
}

Bytes make_exr(const Kind& kind, const Value& value) {
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

void expect_size(const RgbImage& image) {
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    assert_int_equal(image.rgb.size(), size_t(width) * height * 3);
}

void expect_values(const RgbImage& image, const Value& value) {
    expect_size(image);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int channel = 0; channel < 3; ++channel)
                assert_float_equal(image.texel(x, y)[channel], value(x, y, channel), 0);
}

// ---- Good pictures ------------------------------------------------------------------------------

void test_lossless(void**) {
    for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT, Imf::UINT})
        for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                                   Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION})
            for (const bool tiled : {false, true})
                expect_values(parse(make_exr({type, compression, tiled}, counted)), counted);
}

void test_lossy(void**) {
    for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT})
        for (const Imf::Compression compression :
             {Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION})
            for (const bool tiled : {false, true}) {
                const RgbImage image = parse(make_exr({type, compression, tiled}, quadrants));
                expect_size(image);
                for (int y = 0; y < height; ++y)
                    for (int x = 0; x < width; ++x)
                        for (int channel = 0; channel < 3; ++channel)
                            assert_float_equal(std::log2(image.texel(x, y)[channel]),
                                               std::log2(quadrants(x, y, channel)), 0.5);
            }
}

void test_other_channels_do_not_disturb(void**) {
    Kind kind;
    kind.channels = {"R", "G", "B", "A", "Z", "diffuse.R"};
    expect_values(parse(make_exr(kind, counted)), counted);
}

void test_values_are_as_stored(void**) {
    const auto odd = [](int x, int y, int channel) -> double {
        if (x == 0 && y == 0) return -1.5 * channel;
        return x == 1 ? INFINITY : x == 2 ? NAN : 1;
    };
    const RgbImage image = parse(make_exr({}, odd));
    assert_float_equal(image.texel(0, 0)[2], -3, 0);
    assert_true(std::isinf(image.texel(1, 5)[0]));
    assert_true(std::isnan(image.texel(2, 5)[1]));
}

void test_grey(void**) {
    Kind kind;
    kind.channels = {"Y"};
    expect_values(parse(make_exr(kind, counted)), [](int x, int y, int) { return counted(x, y, 0); });
}

void test_luminance_chroma(void**) {
    constexpr int even_width = 36, even_height = 66;  // chroma at half resolution takes even sizes
    const auto colour = [](int y) { return y < even_height / 2 ? Imf::Rgba(0.5f, 0.25f, 1) : Imf::Rgba(4, 2, 1); };
    std::vector<Imf::Rgba> pixels;
    for (int i = 0; i < even_width * even_height; ++i) pixels.push_back(colour(i / even_width));
    Imf::StdOSStream stream;
    {
        Imf::Header header(display, Imath::Box2i({2, 4}, {2 + even_width - 1, 4 + even_height - 1}));
        Imf::RgbaOutputFile file(stream, header, Imf::WRITE_YC);
        file.setYCRounding(10, 10);  // all bits of a half
        file.setFrameBuffer(Imf::ComputeBasePointer(pixels.data(), header.dataWindow()), 1, even_width);
        file.writePixels(even_height);
    }
    const RgbImage image = parse(written(stream));
    assert_int_equal(image.width, even_width);
    assert_int_equal(image.height, even_height);
    // Y, RY and BY are halves (relative error 2^-11). Green is what red and blue leave of the luminance and gathers the
    // most, at (0.5, 0.25, 1): a relative error of at most 8 * 2^-11. The chroma filter blurs over 27 rows.
    const double tolerance = 8 / 2048.0;
    for (const int y : {0, 1, even_height - 1}) {
        const Imf::Rgba expected = colour(y);
        for (int x = 0; x < even_width; ++x) {
            assert_float_equal(image.texel(x, y)[0], expected.r, expected.r * tolerance);
            assert_float_equal(image.texel(x, y)[1], expected.g, expected.g * tolerance);
            assert_float_equal(image.texel(x, y)[2], expected.b, expected.b * tolerance);
        }
    }
}

void test_first_part_with_colour(void**) {
    Kind depth, colour;
    depth.channels = {"Z"};
    std::vector<Imf::Header> headers = {header_of(depth), header_of(colour)};
    headers[0].setName("depth");
    headers[1].setName("colour");
    for (Imf::Header& header : headers) header.setType(Imf::SCANLINEIMAGE);

    Imf::StdOSStream stream;
    {
        Imf::MultiPartOutputFile file(stream, headers.data(), int(headers.size()));
        const Bytes planes[] = {plane(Imf::FLOAT, 0, counted), plane(Imf::FLOAT, 1, counted),
                                plane(Imf::FLOAT, 2, counted)};
        Imf::FrameBuffer depth_buffer, colour_buffer;
        depth_buffer.insert("Z", Imf::Slice::Make(Imf::FLOAT, planes[2].data(), window));
        for (int i = 0; i < 3; ++i)
            colour_buffer.insert(colour.channels[i], Imf::Slice::Make(Imf::FLOAT, planes[i].data(), window));
        Imf::OutputPart depth_part(file, 0), colour_part(file, 1);
        depth_part.setFrameBuffer(depth_buffer);
        depth_part.writePixels(height);
        colour_part.setFrameBuffer(colour_buffer);
        colour_part.writePixels(height);
    }
    const Bytes bytes = written(stream);
    expect_values(parse(bytes), counted);
    expect_truncation_is_an_error(bytes, 997, parse);
}

// ---- Bad pictures -------------------------------------------------------------------------------

void test_no_colour(void**) {
    Kind layers;
    layers.channels = {"diffuse.R", "diffuse.G", "diffuse.B"};
    expect_error(LB_ERROR_FORMAT, {"picture.exr", "no colour", "diffuse.B, diffuse.G, diffuse.R"},
                 [&] { parse(make_exr(layers, counted)); });
    Kind no_blue;
    no_blue.channels = {"R", "G"};
    expect_error(LB_ERROR_FORMAT, {"no colour", "found: G, R"}, [&] { parse(make_exr(no_blue, counted)); });
    Kind full_chroma;  // chroma at full resolution is not what the format defines
    full_chroma.channels = {"Y", "RY", "BY"};
    expect_error(LB_ERROR_FORMAT, {"no colour", "BY, RY, Y"}, [&] { parse(make_exr(full_chroma, counted)); });
}

void test_deep(void**) {
    Imf::StdOSStream stream;
    {
        Imf::Header header = header_of({Imf::FLOAT, Imf::ZIPS_COMPRESSION});
        header.setType(Imf::DEEPSCANLINE);
        Imf::DeepScanLineOutputFile file(stream, header);
    }
    expect_error(LB_ERROR_FORMAT, {"no colour"}, [&] { parse(written(stream)); });
}

// A file of the header alone, as large as it says: sizes must be refused before anything is reserved.
Bytes header_only(Imf::Header header) {
    Imf::StdOSStream stream;
    for (const char* name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    if (header.hasTileDescription())
        Imf::TiledOutputFile file(stream, header);
    else
        Imf::OutputFile file(stream, header);
    return written(stream);
}

void test_sizes(void**) {
    expect_error(LB_ERROR_FORMAT, {"16385 x 1", "16384 x 8192"}, [] { parse(header_only(Imf::Header(16385, 1))); });
    expect_error(LB_ERROR_FORMAT, {"1 x 8193", "16384 x 8192"}, [] { parse(header_only(Imf::Header(1, 8193))); });
    Imf::Header tiled(64, 64);
    tiled.setTileDescription(Imf::TileDescription(16385, 64));
    expect_error(LB_ERROR_FORMAT, {"tiles of 16385 x 64"}, [&] { parse(header_only(tiled)); });
}

void test_attribute_beyond_the_end(void**) {
    Imf::Header header(4, 4);
    const std::string value = "a recognisable value";
    header.insert("comments", Imf::StringAttribute(value));
    Bytes bytes = header_only(header);
    const auto found = std::search(bytes.begin(), bytes.end(), value.begin(), value.end());
    assert_true(found != bytes.end());
    std::fill(found - 4, found - 1, 0xff);  // the size, little-endian: 0x7fffffff
    *(found - 1) = 0x7f;
    expect_error(LB_ERROR_FORMAT, {"attribute comments announces 2147483647 bytes"}, [&] { parse(bytes); });
}

void test_unfinished_file(void**) {
    expect_error(LB_ERROR_FORMAT, {"picture.exr", "OpenEXR cannot read it"},
                 [] { parse(header_only(Imf::Header(4, 4))); });
}

// OpenEXR could look for the chunks by itself; but a file without its table was not finished.
void test_lost_chunk_table(void**) {
    Bytes bytes = make_exr({Imf::FLOAT, Imf::NO_COMPRESSION}, counted);
    constexpr size_t table_bytes = height * sizeof(uint64_t);  // one chunk per scanline; the first one comes next
    const auto chunk_offset = [&](size_t position) {
        uint64_t offset;
        std::memcpy(&offset, &bytes[position], sizeof offset);
        return offset;
    };
    size_t table = 0;
    while (chunk_offset(table) != table + table_bytes) ++table;
    std::fill_n(bytes.begin() + table, table_bytes, 0);
    expect_error(LB_ERROR_FORMAT, {"OpenEXR cannot read it"}, [&] { parse(bytes); });
}

std::vector<Bytes> one_of_each_compression() {
    std::vector<Bytes> files;
    for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression)
        for (const bool tiled : {false, true})
            files.push_back(make_exr({Imf::HALF, Imf::Compression(compression), tiled}, quadrants));
    return files;
}

void test_truncated(void**) {
    for (const Bytes& whole : one_of_each_compression()) expect_truncation_is_an_error(whole, 13, parse);
}

void test_damaged(void**) {
    for (const Bytes& whole : one_of_each_compression()) assert_true(parse_damaged_copies(whole, 300, parse) > 0);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_lossless),
        cmocka_unit_test(test_lossy),
        cmocka_unit_test(test_other_channels_do_not_disturb),
        cmocka_unit_test(test_values_are_as_stored),
        cmocka_unit_test(test_grey),
        cmocka_unit_test(test_luminance_chroma),
        cmocka_unit_test(test_first_part_with_colour),
        cmocka_unit_test(test_no_colour),
        cmocka_unit_test(test_deep),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_attribute_beyond_the_end),
        cmocka_unit_test(test_unfinished_file),
        cmocka_unit_test(test_lost_chunk_table),
        cmocka_unit_test(test_truncated),
        cmocka_unit_test(test_damaged),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
