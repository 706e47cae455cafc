// What the headers of OpenEXR pictures say: windows, colours, cube maps, compressions that ring.
#include <ImfEnvmap.h>
#include <ImfStandardAttributes.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "exr_testing.h"
#include "scene/environment.h"

namespace {

using namespace lightband;
using namespace lightband::testing;

// ---- What headers say -----------------------------------------------------------------------------

// The picture is what the display window shows: what has no data is black, what lies outside is left out.
void test_windows(void**) {
    const Imath::Box2i displays[] = {
        {{-10, 0}, {40, 90}}, {{0, 20}, {9, 29}}, {{-20, -20}, {0, 10}}, {{10, 0}, {90, 20}}, {{200, 200}, {201, 203}}};
    for (const Imath::Box2i& shown : displays)
        for (const bool tiled : {false, true})
            for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
                Kind kind{Imf::FLOAT, compression, tiled};
                kind.change = [&](Imf::Header& header) { header.displayWindow() = shown; };
                const RgbImage image = parse(make_exr(kind, [](int x, int y, int c) { return counted(x, y, c) + 1; }));
                assert_int_equal(image.width, shown.max.x - shown.min.x + 1);
                assert_int_equal(image.height, shown.max.y - shown.min.y + 1);
                for (int y = shown.min.y; y <= shown.max.y; ++y)
                    for (int x = shown.min.x; x <= shown.max.x; ++x)
                        for (int c = 0; c < 3; ++c) {
                            const bool has_data = window.intersects(Imath::V2i(x, y));
                            const double expected = has_data ? counted(x - window.min.x, y - window.min.y, c) + 1 : 0;
                            assert_float_equal(image.texel(x - shown.min.x, y - shown.min.y)[c], expected, 0);
                        }
                assert_int_equal(image.notes.size(), 1);
            }
}

void test_finest_level_of_detail(void**) {
    for (const Imf::LevelMode mode : {Imf::MIPMAP_LEVELS, Imf::RIPMAP_LEVELS}) {
        Imf::StdOSStream stream;
        {
            Imf::Header header = header_of({});
            header.setTileDescription(Imf::TileDescription(tile_size, tile_size, mode));
            Imf::TiledOutputFile file(stream, header);
            for (int ly = 0; ly < file.numYLevels(); ++ly)
                for (int lx = 0; lx < file.numXLevels(); ++lx) {
                    if (!file.isValidLevel(lx, ly)) continue;
                    const Bytes planes[] = {plane(Imf::FLOAT, lx + ly, counted), plane(Imf::FLOAT, 1, counted),
                                            plane(Imf::FLOAT, 2, counted)};
                    Imf::FrameBuffer buffer;
                    for (int i = 0; i < 3; ++i)
                        buffer.insert(Kind().channels[i], Imf::Slice::Make(Imf::FLOAT, planes[i].data(), window));
                    file.setFrameBuffer(buffer);
                    file.writeTiles(0, file.numXTiles(lx) - 1, 0, file.numYTiles(ly) - 1, lx, ly);
                }
        }
        expect_values(parse(written(stream)), counted);
    }
}

const Imf::Chromaticities aces({0.7347f, 0.2653f}, {0, 1}, {0.0001f, -0.077f}, {0.32168f, 0.33767f});

RgbImage parse_with(const std::function<void(Imf::Header&)>& change, const Value& value) {
    Kind kind;
    kind.change = change;
    return parse(make_exr(kind, value));
}

void expect_texel(const RgbImage& image, const std::array<double, 3>& expected, double tolerance) {
    for (size_t c = 0; c < 3; ++c) assert_float_equal(image.texel(0, 0)[c], expected[c], tolerance);
}

// ACES 2065-1 to linear Rec. 709, the white adapted by Bradford's matrix, as OpenColorIO's built-in transform has it.
void test_chromaticities(void**) {
    const double published[3][3] = {{2.52169, -1.13413, -0.38756}, {-0.27648, 1.37272, -0.09624}, {-0.01538, -0.15298, 1.16835}};
    const double colour[3] = {0.5, 0.3, 0.4};
    std::array<double, 3> expected = {};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) expected[row] += published[row][column] * colour[column];
    const auto of_aces = [](Imf::Header& header) { Imf::addChromaticities(header, aces); };
    const RgbImage image = parse_with(of_aces, [&](int, int, int c) { return colour[c]; });
    // Half a unit of the last digit in each coefficient, 5e-6, times the sum of the colours, 1.2; as much again for whites
    // that are given in five digits.
    expect_texel(image, expected, 1.2e-5);
    assert_true(image.notes.empty());

    // A neutral of its own: what has the file's white (here ACES's, as RGB 1, 1, 1) is then not grey.
    const auto with_neutral = [&](Imf::Header& header) {
        of_aces(header);
        Imf::addAdoptedNeutral(header, Imath::V2f(0.3457f, 0.3585f));  // D50: ACES's white is bluer
    };
    const RgbImage cold = parse_with(with_neutral, [](int, int, int) { return 1; });
    assert_true(cold.rgb[2] > 1.1 && cold.rgb[0] < 0.95);

    // Files in CIE XYZ: x = y = z = 1/3 is their white.
    const auto of_xyz = [](Imf::Header& header) {
        Imf::addChromaticities(header, {{1, 0}, {0, 1}, {0, 0}, {1 / 3.0f, 1 / 3.0f}});
    };
    expect_texel(parse_with(of_xyz, [](int, int, int) { return 2; }), {2, 2, 2}, 1e-5);
    const auto of_rec709 = [](Imf::Header& header) { Imf::addChromaticities(header, {}); };
    expect_values(parse_with(of_rec709, counted), counted);
}

void test_colours_outside_the_gamut(void**) {
    const auto of_aces = [](Imf::Header& header) { Imf::addChromaticities(header, aces); };
    const RgbImage image = parse_with(of_aces, [](int, int, int c) { return c == 0 ? 1 : 0; });
    expect_texel(image, {2.52169, 0, 0}, 1.2e-5);
    assert_int_equal(image.notes.size(), 1);
    assert_non_null(std::strstr(image.notes[0].c_str(), text("of ", width * height, " texels").c_str()));
    // What was negative in the file stays negative, and is refused by whoever wants light.
    assert_true(parse_with(of_aces, [](int, int, int) { return -1; }).rgb[0] < -0.9);
}

void test_absurd_chromaticities(void**) {
    const Imath::V2f red(0.64f, 0.33f), green(0.3f, 0.6f), blue(0.15f, 0.06f), white(0.3127f, 0.329f);
    const auto expect_bad = [](const Imf::Chromaticities& wrong, const char* reason) {
        expect_error(LB_ERROR_FORMAT, {"picture.exr", "chromaticities", reason}, [&] {
            parse_with([&](Imf::Header& header) { Imf::addChromaticities(header, wrong); }, counted);
        });
    };
    expect_bad({red, green, (red + green) / 2.0f, white}, "one line");
    expect_bad({{0, 0}, {0, 0}, {0, 0}, {0, 0}}, "one line");
    expect_bad({red, green, blue, {0.3f, 0}}, "adapt");
    expect_bad({red, green, blue, {0.3f, -0.2f}}, "adapt");
    expect_bad({red, green, blue, (red + green) / 2.0f}, "two primaries");
    expect_bad({{NAN, 0.3f}, green, blue, white}, "finite");
    expect_bad({red, green, blue, {INFINITY, 0.3f}}, "finite");
    expect_bad({red, {1e30f, 1}, blue, white}, "at most 10");
}

// ---- Cube maps ------------------------------------------------------------------------------------

constexpr int face_size = 24;
// ImfEnvmap.h counts from its corner; where that lies in the plane does not matter.
const Imath::Box2i cube({0, 0}, {face_size - 1, 6 * face_size - 1}), cube_window(cube.min + Imath::V2i(3, 5), cube.max + Imath::V2i(3, 5));

RgbImage parse_cube(const std::function<double(const Imath::V3f& direction, int face)>& light) {
    std::vector<float> values(size_t(face_size) * face_size * 6);
    for (int face = 0; face < 6; ++face)
        for (int y = 0; y < face_size; ++y)
            for (int x = 0; x < face_size; ++x) {
                const Imath::V2f within{float(x), float(y)};
                const Imath::V3f direction = Imf::CubeMap::direction(Imf::CubeMapFace(face), cube, within).normalized();
                const Imath::V2f at = Imf::CubeMap::pixelPosition(Imf::CubeMapFace(face), cube, within);
                values.at(size_t(std::lround(at.y)) * face_size + size_t(std::lround(at.x))) = float(light(direction, face));
            }
    Imf::StdOSStream stream;
    {
        Imf::Header header(cube_window, cube_window);
        Imf::addEnvmap(header, Imf::ENVMAP_CUBE);
        header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
        Imf::FrameBuffer buffer;
        buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), cube_window));
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(buffer);
        file.writePixels(6 * face_size);
    }
    return parse(written(stream));
}

// Light that is linear in the direction, lit from each side: where it comes from in the cube, it comes from in the map. The
// faces' own texels are 4 / 23 wide, over which bilinear interpolation of a unit vector errs by at most an eighth of the
// square of it times its second derivative, at most 2: 0.008; the map's own texels are much smaller.
void test_cube_map_directions(void**) {
    for (int axis = 0; axis < 3; ++axis) {
        const RgbImage map = parse_cube([&](const Imath::V3f& direction, int) { return 1 + direction[axis]; });
        assert_int_equal(map.width, 2 * map.height);
        for (uint32_t y = 0; y < map.height; ++y)
            for (uint32_t x = 0; x < map.width; ++x) {
                const Vec3 direction = direction_of({(x + 0.5) / map.width, (y + 0.5) / map.height});
                assert_float_equal(map.texel(x, y)[0], 1 + direction[axis], 0.008);
            }
    }
}

// A face alone, a square at distance 1 that is 2 wide, lights a plate that faces it by the closed form of Lambert's
// configuration factor: 4 / (pi sqrt 2) atan(1 / sqrt 2) of what a whole sky would (Modest, "Radiative Heat Transfer", factor 10).
void test_cube_map_faces(void**) {
    const Vec3 sides[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int lit = 0; lit < 6; ++lit) {
        const RgbImage map = parse_cube([&](const Imath::V3f&, int face) { return face == lit ? 1 : 0; });
        double sum = 0;
        for (uint32_t y = 0; y < map.height; ++y) {
            const double solid = (std::cos(pi * y / map.height) - std::cos(pi * (y + 1) / map.height)) * 2 * pi / map.width;
            for (uint32_t x = 0; x < map.width; ++x)
                sum += map.texel(x, y)[0] * solid *
                       std::max(0.0, glm::dot(sides[lit], direction_of({(x + 0.5) / map.width, (y + 0.5) / map.height})));
        }
        // Cosines are taken at texel centres, 0.006 radians apart: far below a thousandth.
        assert_float_equal(sum / pi, 4 / (pi * std::sqrt(2)) * std::atan(1 / std::sqrt(2)), 1e-3);
    }
}

void test_cube_map_of_wrong_shape(void**) {
    Kind kind;
    kind.change = [](Imf::Header& header) { Imf::addEnvmap(header, Imf::ENVMAP_CUBE); };
    expect_error(LB_ERROR_FORMAT, {"cube map of 37 x 67", "six squares"}, [&] { parse(make_exr(kind, counted)); });
}

// ---- Ringing ----------------------------------------------------------------------------------------

// Bright dots amid darkness, and a smooth dim corner: none negative.
double dots(int x, int y, int channel) {
    const bool lit = (x * 7 + y * 3) % 11 == 0;
    return lit ? std::ldexp(1.0, (x + 5 * y) % 14) * (channel + 1) : x > 20 ? 0 : 1e-3 * (x + y);
}

void test_ringing_becomes_black(void**) {
    size_t b44_rang = 0, dwa_rang = 0;
    for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT})
        for (const bool tiled : {false, true})
            for (const std::vector<std::string>& channels : {std::vector<std::string>{"R", "G", "B"}, {"Y"}})
                for (const Imf::Compression compression :
                     {Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION})
                    for (const float level : {45.0f, 1000.0f, 100000.0f}) {
                        Kind kind{type, compression, tiled, channels};
                        kind.change = [&](Imf::Header& header) { header.dwaCompressionLevel() = level; };
                        const RgbImage image = parse(make_exr(kind, dots));
                        for (const float value : image.rgb)
                            if (!(value >= 0))
                                fail_msg("%g in compression %d, type %d, tiled %d, %zu channels, level %g", double(value), compression,
                                         type, tiled, channels.size(), double(level));
                        // B44 leaves what is not half as it is.
                        const bool is_b44 = compression == Imf::B44_COMPRESSION || compression == Imf::B44A_COMPRESSION;
                        if (is_b44 && type == Imf::FLOAT) assert_true(image.notes.empty());
                        (is_b44 ? b44_rang : dwa_rang) += image.notes.size();
                    }
    assert_true(b44_rang > 0 && dwa_rang > 0);
}

// What no compression makes of light stays as it is, to be refused: negative all over a block, or more than B44 rounds.
void test_negative_light_is_no_ringing(void**) {
    const auto negative = [](int x, int y, int channel) { return (x + y + channel) % 5 == 0 ? -0.002 : -0.001; };
    for (const Imf::Compression compression : {Imf::ZIP_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION,
                                               Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION}) {
        const RgbImage image = parse(make_exr({Imf::HALF, compression}, negative));
        assert_true(*std::max_element(image.rgb.begin(), image.rgb.end()) < 0 && image.notes.empty());
    }
    const RgbImage beside_light = parse(make_exr({Imf::HALF, Imf::B44_COMPRESSION}, [](int x, int, int) { return x < 18 ? 1 : -0.001; }));
    assert_true(*std::min_element(beside_light.rgb.begin(), beside_light.rgb.end()) < -0.0005);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_windows),
        cmocka_unit_test(test_finest_level_of_detail),
        cmocka_unit_test(test_chromaticities),
        cmocka_unit_test(test_colours_outside_the_gamut),
        cmocka_unit_test(test_absurd_chromaticities),
        cmocka_unit_test(test_cube_map_directions),
        cmocka_unit_test(test_cube_map_faces),
        cmocka_unit_test(test_cube_map_of_wrong_shape),
        cmocka_unit_test(test_ringing_becomes_black),
        cmocka_unit_test(test_negative_light_is_no_ringing),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
