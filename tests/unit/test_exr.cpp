// OpenEXR pictures of every kind, written by OpenEXR and read by parse_exr.
#include <ImfArray.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <cstring>

#include "exr_testing.h"
#include "io/file.h"

namespace {

using namespace lightband;
using namespace lightband::testing;

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
        const Imath::Box2i even({2, 4}, {2 + even_width - 1, 4 + even_height - 1});
        Imf::Header header(even, even);
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
    expect_values(io::parse_exr(bytes, "picture.exr", "colour"), counted);
    expect_error(LB_ERROR_FORMAT, {"\"depth\"", "there are: colour"}, [&] { io::parse_exr(bytes, "picture.exr", "depth"); });
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
    Imf::Header display_window(Imath::Box2i({0, 0}, {16384, 0}), Imath::Box2i({0, 0}, {3, 3}));
    expect_error(LB_ERROR_FORMAT, {"display window of 16385 x 1"}, [&] { parse(header_only(display_window)); });
    // A tile is decoded as a whole, with all its channels, whatever is asked of it.
    Imf::Header one_tile(8192, 8192);
    one_tile.setTileDescription(Imf::TileDescription(8192, 8192));
    expect_error(LB_ERROR_FORMAT, {"chunk of 8192 x 8192 texels of 12 bytes"}, [&] { parse(header_only(one_tile)); });
    Imf::Header specks(8192, 8192);
    specks.setTileDescription(Imf::TileDescription(64, 64));
    Bytes bytes = header_only(specks);
    bytes.resize(bytes.size() - 4096);
    expect_error(LB_ERROR_FORMAT, {}, [&] { parse(bytes); });
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
