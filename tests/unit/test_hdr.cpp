// Radiance pictures, made byte by byte.
#include <array>
#include <cmath>
#include <functional>

#include "io/image_file.h"
#include "io_testing.h"

namespace {

using namespace lightband;
using namespace lightband::testing;
using io::parse_hdr;

using Rgbe = std::array<uint8_t, 4>;

const std::string usual_header = "#?RADIANCE\n# a comment\nGAMMA=1\nFORMAT=32-bit_rle_rgbe\n\n";

Bytes operator+(const std::string& header, const Bytes& data) {
    Bytes bytes(header.begin(), header.end());
    bytes.insert(bytes.end(), data.begin(), data.end());
    return bytes;
}

Bytes operator+(Bytes bytes, const Bytes& more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
    return bytes;
}

RgbImage parse(const Bytes& bytes) {
    return parse_hdr(bytes, "picture.hdr");
}

// colr_color of Radiance's color.c: (mantissa + 0.5) * 2^(exponent - 136), black for exponent 0.
float expected_component(uint8_t mantissa, uint8_t exponent) {
    return exponent == 0 ? 0.0f : std::ldexp(float(mantissa) + 0.5f, int(exponent) - 136);
}

void expect_texel(const RgbImage& image, uint32_t x, uint32_t y, const Rgbe& stored) {
    for (size_t channel = 0; channel < 3; ++channel)
        assert_float_equal(image.texel(x, y)[channel], expected_component(stored[channel], stored[3]), 0);
}

// A texel of its own at every place; it looks neither like a repetition nor like the start of a run-length encoding.
Rgbe texel_at(uint32_t x, uint32_t y) {
    return {uint8_t(10 + x), uint8_t(60 + y), uint8_t(200 - x), uint8_t(126 + y)};
}

void expect_texel_at_every_place(const RgbImage& image, uint32_t width, uint32_t height) {
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    assert_int_equal(image.rgb.size(), width * height * 3);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) expect_texel(image, x, y, texel_at(x, y));
}

Bytes flat_rows(uint32_t width, uint32_t height) {
    Bytes bytes;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const Rgbe texel = texel_at(x, y);
            bytes.insert(bytes.end(), texel.begin(), texel.end());
        }
    return bytes;
}

// Each component as two packets: a run where all its values are equal, else as they are.
Bytes component_rows(uint32_t width, uint32_t height) {
    Bytes bytes;
    for (uint32_t y = 0; y < height; ++y) {
        bytes = bytes + Bytes{2, 2, uint8_t(width >> 8), uint8_t(width)};
        for (size_t component = 0; component < 4; ++component) {
            const bool varies = component == 0 || component == 2;
            const uint32_t middle = width / 2;
            for (uint32_t start = 0; start < width; start = start == 0 ? middle : width) {
                const uint32_t end = start == 0 ? middle : width;
                bytes.push_back(uint8_t(varies ? end - start : 128 + end - start));
                for (uint32_t x = start; x < (varies ? end : start + 1); ++x)
                    bytes.push_back(texel_at(x, y)[component]);
            }
        }
    }
    return bytes;
}

// ---- Good pictures ------------------------------------------------------------------------------

void test_values(void**) {
    const Bytes data = {128, 64, 255, 129, 7, 8, 9, 0, 255, 255, 255, 255, 255, 0, 1, 1};
    const RgbImage image = parse(usual_header + std::string("-Y 1 +X 4\n") + data);
    assert_float_equal(image.texel(0, 0)[0], 128.5 / 256 * 2, 0);
    assert_float_equal(image.texel(0, 0)[1], 64.5 / 256 * 2, 0);
    assert_float_equal(image.texel(0, 0)[2], 255.5 / 256 * 2, 0);
    for (size_t channel = 0; channel < 3; ++channel) assert_float_equal(image.texel(1, 0)[channel], 0, 0);
    assert_true(image.texel(2, 0)[0] == std::ldexp(255.5f, 255 - 136));
    assert_true(image.texel(3, 0)[1] == std::ldexp(0.5f, 1 - 136));
}

void test_exposure_is_divided_out(void**) {
    const std::string header =
        "#?RGBE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\nEXPOSURE= 0.25\nCOLORCORR=1 2 4\n\n-Y 1 +X 1\n";
    const RgbImage image = parse(header + Bytes{128, 128, 128, 129});
    const float stored = 128.5f / 128;
    assert_float_equal(image.rgb[0], stored / 0.5f, 0);
    assert_float_equal(image.rgb[1], stored / 1.0f, 0);
    assert_float_equal(image.rgb[2], stored / 2.0f, 0);
}

// What Radiance's own getinfo and checkheader take.
void test_headers_of_many_programs(void**) {
    const std::string format = "FORMAT=32-bit_rle_rgbe";
    const std::vector<std::string> headers = {
        "#?RADIANCE\r\n" + format + "\r\n\r\n-Y 1 +X 1\r\n",
        "#?RADIANCE\n" + format + "\n\r\n-Y 1 +X 1\n",
        "#?RADIANCE\nEXPOSURE=+1\n" + format + "\n\n-Y 1 +X 1\n",
        "#?RADIANCE\nEXPOSURE= +1e0\r\n" + format + "\n\n-Y 1 +X 1\n",
        "#?RADIANCE\n\n-Y 1 +X 1\n",
        "#?STITCHER\n" + format + "\n\n-Y 1 +X 1\n",
        "#?\nCOLORCORR=+1 1 1\n\n-Y 1 +X 1\n",
        "#?RADIANCE\n" + format + "\nEXPOSURE=0\n\n-Y 1 +X 1\n",
    };
    for (const std::string& header : headers)
        expect_texel(parse(header + Bytes{128, 64, 32, 129}), 0, 0, {128, 64, 32, 129});
    assert_int_equal(parse(headers.back() + Bytes{128, 64, 32, 129}).notes.size(), 1);
}

RgbImage parse_texel(const std::string& lines) {
    return parse("#?RADIANCE\n" + lines + "\n\n-Y 1 +X 1\n" + Bytes{128, 128, 128, 129});
}

void expect_colour(const RgbImage& image, const std::array<double, 3>& expected, double tolerance) {
    for (size_t c = 0; c < 3; ++c) assert_float_equal(image.rgb[c], expected[c], tolerance);
}

void test_primaries(void**) {
    const double grey = 128.5 / 128, rounding = grey * 1e-6;
    // White stays white, whatever the primaries: that is what the adaptation is for.
    expect_colour(parse_texel("PRIMARIES= .7347 .2653 0 1 .0001 -.077 .32168 .33767"), {grey, grey, grey}, rounding);
    expect_colour(parse_texel("PRIMARIES= .640 .330 .290 .600 .150 .060 .333 .333"), {grey, grey, grey}, rounding);
    expect_colour(parse_texel("PRIMARIES=0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329"), {grey, grey, grey}, 0);
    expect_colour(parse_texel("PRIMARIES=0 0 0 0 0 0 0 0"), {grey, grey, grey}, 0);  // Adobe Photoshop
    // ACES 2065-1 to linear Rec. 709, as in test_exr_headers: half a unit of the last digit in each coefficient, 5e-6,
    // times the sum of the colours, 2.27; as much again for whites that are given in five digits.
    const double red = 128.5 / 128, green = 64.5 / 128, blue = 96.5 / 128;
    const std::string aces = "#?RADIANCE\nPRIMARIES= .7347 .2653 0 1 .0001 -.077 .32168 .33767\n\n-Y 1 +X 1\n";
    expect_colour(parse(aces + Bytes{128, 64, 96, 129}),
                  {2.52169 * red - 1.13413 * green - 0.38756 * blue, -0.27648 * red + 1.37272 * green - 0.09624 * blue,
                   -0.01538 * red - 0.15298 * green + 1.16835 * blue},
                  2.3e-5);
    // X = Y = Z is equal energy, white; 179 candelas per square metre of it are 1 watt per steradian and square metre.
    expect_colour(parse_texel("FORMAT=32-bit_rle_xyze"), {grey / 179, grey / 179, grey / 179}, rounding / 179);
    // Whatever primaries a program has left in the header.
    const std::string xyz = "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n",
                      primaries = "PRIMARIES= .64 .33 .3 .6 .15 .06 .3127 .3290\n";
    const Bytes texel = {128, 120, 96, 129};
    assert_true(parse(xyz + primaries + "\n-Y 1 +X 1\n" + texel).rgb == parse(xyz + "\n-Y 1 +X 1\n" + texel).rgb);
}

// For scanline s and position p along it: the column and the row from the top, in an image of 3 x 5 texels.
struct Orientation {
    const char* resolution;
    std::function<std::array<uint32_t, 2>(uint32_t s, uint32_t p)> place;
};

void test_orientations(void**) {
    constexpr uint32_t width = 3, height = 5, right = width - 1, bottom = height - 1;
    using Place = std::array<uint32_t, 2>;
    const Orientation orientations[] = {
        {"-Y 5 +X 3",
         [](uint32_t s, uint32_t p) {
             return Place{p, s};
         }},
        {"-Y 5 -X 3",
         [](uint32_t s, uint32_t p) {
             return Place{right - p, s};
         }},
        {"+Y 5 +X 3",
         [](uint32_t s, uint32_t p) {
             return Place{p, bottom - s};
         }},
        {"+Y 5 -X 3",
         [](uint32_t s, uint32_t p) {
             return Place{right - p, bottom - s};
         }},
        {"+X 3 -Y 5",
         [](uint32_t s, uint32_t p) {
             return Place{s, p};
         }},
        {"-X 3 -Y 5",
         [](uint32_t s, uint32_t p) {
             return Place{right - s, p};
         }},
        {"+X 3 +Y 5",
         [](uint32_t s, uint32_t p) {
             return Place{s, bottom - p};
         }},
        {"-X 3 +Y 5",
         [](uint32_t s, uint32_t p) {
             return Place{right - s, bottom - p};
         }},
    };
    for (const Orientation& orientation : orientations) {
        const bool by_columns = orientation.resolution[1] == 'X';
        Bytes data;
        for (uint32_t s = 0; s < (by_columns ? width : height); ++s)
            for (uint32_t p = 0; p < (by_columns ? height : width); ++p) {
                const auto [x, y] = orientation.place(s, p);
                const Rgbe texel = texel_at(x, y);
                data.insert(data.end(), texel.begin(), texel.end());
            }
        const RgbImage image = parse(usual_header + std::string(orientation.resolution) + "\n" + data);
        expect_texel_at_every_place(image, width, height);
    }
}

void test_flat(void**) {
    expect_texel_at_every_place(parse(usual_header + std::string("-Y 3 +X 9\n") + flat_rows(9, 3)), 9, 3);
}

void test_component_runs(void**) {
    expect_texel_at_every_place(parse(usual_header + std::string("-Y 4 +X 20\n") + component_rows(20, 4)), 20, 4);
    expect_texel_at_every_place(parse(usual_header + std::string("-Y 1 +X 8\n") + component_rows(8, 1)), 8, 1);
}

// A packet of 128 is the longest one of bytes as they are; 255 is the longest run, 127.
void test_longest_packets(void**) {
    Bytes data = {2, 2, 0, 255};
    for (int component = 0; component < 3; ++component) {
        data.push_back(128);
        for (int x = 0; x < 128; ++x) data.push_back(uint8_t(x));
        data = data + Bytes{255, 77};
    }
    data = data + Bytes{255, 130, 255, 130, 129, 130};
    const RgbImage image = parse(usual_header + std::string("-Y 1 +X 255\n") + data);
    for (uint32_t x = 0; x < 255; ++x) {
        const uint8_t mantissa = x < 128 ? uint8_t(x) : 77;
        expect_texel(image, x, 0, {mantissa, mantissa, mantissa, 130});
    }
}

// 301 texels: one, repeated 44 + 256 * 1 times; then another one, repeated twice.
void test_texel_repetitions(void**) {
    const Bytes data = {9, 8, 7, 130, 1, 1, 1, 44, 1, 1, 1, 1, 19, 18, 17, 131, 1, 1, 1, 2};
    const RgbImage image = parse(usual_header + std::string("-Y 1 +X 304\n") + data);
    for (uint32_t x = 0; x < 304; ++x) expect_texel(image, x, 0, x < 301 ? Rgbe{9, 8, 7, 130} : Rgbe{19, 18, 17, 131});
}

// A scanline shorter than 8 texels, or one with 128 and more in its third byte, is never encoded by components.
void test_texels_that_look_like_an_encoding(void**) {
    const RgbImage narrow = parse(usual_header + std::string("-Y 1 +X 2\n") + Bytes{2, 2, 0, 2, 5, 6, 7, 130});
    expect_texel(narrow, 0, 0, {2, 2, 0, 2});
    expect_texel(narrow, 1, 0, {5, 6, 7, 130});
    const RgbImage wide = parse(usual_header + std::string("-Y 1 +X 8\n") + Bytes{2, 2, 128, 130, 1, 1, 1, 7});
    expect_texel(wide, 7, 0, {2, 2, 128, 130});
}

// ---- Bad pictures -------------------------------------------------------------------------------

void expect_bad(const std::vector<std::string>& words, const Bytes& bytes) {
    expect_error(LB_ERROR_FORMAT, words, [&] { parse(bytes); });
}

void test_bad_headers(void**) {
    const Bytes texel = {9, 8, 7, 130};
    const std::string end = "\n-Y 1 +X 1\n";
    const std::string format = "FORMAT=32-bit_rle_rgbe\n";
    expect_bad({"picture.hdr", "#?"}, "?#RADIANCE\n" + format + end + texel);
    expect_bad({"32-bit_rle_spec", "not supported"}, "#?RADIANCE\nFORMAT=32-bit_rle_spec\n" + end + texel);
    for (const char* line : {"PRIMARIES=0.64 0.33", "PRIMARIES=a b c d e f g h"})
        expect_bad({"PRIMARIES", "eight numbers"}, "#?RADIANCE\n" + format + line + "\n" + end + texel);
    expect_bad({"white", "adapt"}, "#?RADIANCE\nPRIMARIES= .64 .33 .3 .6 .15 .06 .3 0\n" + end + texel);
    expect_bad({"one line"}, "#?RADIANCE\nPRIMARIES= .6 .3 .4 .2 .2 .1 .33 .33\n" + end + texel);
    expect_bad({"product", "EXPOSURE"}, "#?RADIANCE\n" + format + "COLORCORR=0 1 1\n" + end + texel);
    for (const char* number : {"", "-1", "-0.5", "+-1", "+", "nan", "inf", "1e999", "two", "1x"})
        expect_bad({"EXPOSURE=", "positive"}, "#?RADIANCE\n" + format + "EXPOSURE=" + number + "\n" + end + texel);
    expect_bad({"COLORCORR=1 2", "positive"}, "#?RADIANCE\n" + format + "COLORCORR=1 2\n" + end + texel);
    expect_bad({"product", "EXPOSURE"}, "#?RADIANCE\n" + format + "EXPOSURE=1e200\nEXPOSURE=1e200\n" + end + texel);
    expect_bad({"float32"}, "#?RADIANCE\n" + format + "EXPOSURE=1e-20\n" + end + Bytes{9, 8, 7, 250});
    expect_bad({"EXPOSURE=??"}, "#?RADIANCE\n" + format + "EXPOSURE=\x01\xff\n" + end + texel);
}

void test_bad_resolutions(void**) {
    for (const char* line : {"-Y 1", "Y 1 +X 1", "-Y 0 +X 1", "-Y 1 +X -1", "-Y 1 +X 1x", "-Y 1 +X 99999999999", "",
                             "-Y 1 +Z 1", "-Y 1 +Y 1", "-Y 1 +X 1 +Y 1"})
        expect_bad({"resolution line"}, usual_header + std::string(line) + "\n" + Bytes{9, 8, 7, 130});
    expect_bad({"16385 x 1", "16384 x 8192"}, usual_header + std::string("-Y 1 +X 16385\n") + Bytes{9, 8, 7, 130});
    expect_bad({"1 x 8193", "16384 x 8192"}, usual_header + std::string("+X 1 -Y 8193\n") + Bytes{9, 8, 7, 130});
    expect_bad({"truncated", "8192 scanlines"}, usual_header + std::string("-Y 8192 +X 16384\n") + Bytes(400));
}

void test_bad_scanlines(void**) {
    const std::string header = usual_header + "-Y 1 +X 8\n";
    expect_bad({"announces 9 texels, expected 8"}, header + Bytes{2, 2, 0, 9, 136, 1});
    expect_bad({"run does not fit"}, header + Bytes{2, 2, 0, 8, 137, 1});
    expect_bad({"run does not fit"}, header + Bytes{2, 2, 0, 8, 9, 1, 2, 3, 4, 5, 6, 7, 8, 9});
    expect_bad({"run does not fit"}, header + Bytes{2, 2, 0, 8, 0, 0, 0, 0});
    expect_bad({"begins with a repetition"}, header + Bytes{1, 1, 1, 8});
    expect_bad({"run does not fit"}, header + Bytes{9, 9, 9, 130, 1, 1, 1, 8});
    expect_bad({"run does not fit"}, header + Bytes{9, 9, 9, 130, 1, 1, 1, 0, 1, 1, 1, 1});
    // A third digit counts in 65536s, more than any scanline holds, even where it is zero.
    expect_bad({"run does not fit"}, usual_header + std::string("-Y 1 +X 2\n") +
                                         Bytes{9, 9, 9, 130, 1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1, 0, 8, 8, 8, 130});
}

std::vector<Bytes> one_of_each_encoding() {
    const Bytes repetitions = {9, 8, 7, 130, 1, 1, 1, 6, 19, 18, 17, 131};
    return {usual_header + std::string("-Y 4 +X 9\n") + flat_rows(9, 4),
            usual_header + std::string("-Y 4 +X 20\n") + component_rows(20, 4),
            usual_header + std::string("-Y 2 +X 8\n") + (repetitions + repetitions)};
}

void test_truncated(void**) {
    for (const Bytes& whole : one_of_each_encoding()) expect_truncation_is_an_error(whole, 1, parse);
}

void test_damaged(void**) {
    for (const Bytes& whole : one_of_each_encoding()) assert_true(parse_damaged_copies(whole, 5000, parse) > 0);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_exposure_is_divided_out),
        cmocka_unit_test(test_headers_of_many_programs),
        cmocka_unit_test(test_primaries),
        cmocka_unit_test(test_orientations),
        cmocka_unit_test(test_flat),
        cmocka_unit_test(test_component_runs),
        cmocka_unit_test(test_longest_packets),
        cmocka_unit_test(test_texel_repetitions),
        cmocka_unit_test(test_texels_that_look_like_an_encoding),
        cmocka_unit_test(test_bad_headers),
        cmocka_unit_test(test_bad_resolutions),
        cmocka_unit_test(test_bad_scanlines),
        cmocka_unit_test(test_truncated),
        cmocka_unit_test(test_damaged),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
