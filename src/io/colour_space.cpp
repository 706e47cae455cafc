#include "io/colour_space.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace lightband::io {
namespace {

Vec3 with_z(const Vec2& xy) { return {xy.x, xy.y, 1 - xy.x - xy.y}; }

// CIE XYZ of a white of luminance 1.
Vec3 white_xyz(const Vec2& xy) { return with_z(xy) / xy.y; }

// Bradford's matrix from XYZ to the responses of sharpened cones, row by row; GLM takes columns.
const glm::dmat3 bradford = glm::transpose(glm::dmat3(0.8951, 0.2664, -0.1614,    //
                                                      -0.7502, 1.7135, 0.0367,    //
                                                      0.0389, -0.0685, 1.0296));

// RGB to XYZ (SMPTE RP 177): columns along the primaries, scaled so that their sum is the white.
glm::dmat3 to_xyz(const Chromaticities& c) {
    const glm::dmat3 primaries(with_z(c.red), with_z(c.green), with_z(c.blue));
    const Vec3 scale = glm::inverse(primaries) * white_xyz(c.white);
    return {primaries[0] * scale.x, primaries[1] * scale.y, primaries[2] * scale.z};
}

void check(const Chromaticities& c, const Vec2& neutral, const std::string& name) {
    const auto reject = [&](const std::string& what) {
        const auto pair = [](const Vec2& xy) { return text("(", xy.x, ", ", xy.y, ")"); };
        throw Error(LB_ERROR_FORMAT, text(name, ": chromaticities red ", pair(c.red), ", green ", pair(c.green), ", blue ",
                                          pair(c.blue), ", white ", pair(c.white), ", neutral ", pair(neutral), ": ", what));
    };
    // Those of all known colour spaces lie within -1 .. 2; the rest is a damaged header.
    constexpr double largest = 10;
    for (const Vec2& xy : {c.red, c.green, c.blue, c.white, neutral})
        if (!(std::abs(xy.x) <= largest && std::abs(xy.y) <= largest))
            reject(text("each coordinate must be finite and at most ", largest, " in magnitude"));
    // Twice the area of the triangle of primaries; that of Rec. 709 is 0.22. The coordinates are floats (2^-24).
    constexpr double smallest_area = 1e-4;
    if (!(std::abs(glm::determinant(glm::dmat3(with_z(c.red), with_z(c.green), with_z(c.blue)))) > smallest_area))
        reject("the primaries lie on one line and span no colours");
    constexpr double smallest_white = 1e-3;
    for (const Vec2& white : {c.white, neutral}) {
        const Vec3 cones = bradford * with_z(white);
        if (!(white.y > smallest_white) || !(std::min({cones.x, cones.y, cones.z}) > smallest_white))
            reject("the white is not a colour that eyes can adapt to");
    }
    const Vec3 sum = glm::inverse(glm::dmat3(with_z(c.red), with_z(c.green), with_z(c.blue))) * white_xyz(c.white);
    if (!(std::min({std::abs(sum.x), std::abs(sum.y), std::abs(sum.z)}) > smallest_white))
        reject("the white is a mixture of two primaries alone");
}

}  // namespace

std::optional<glm::dmat3> to_rec709(const Chromaticities& from, const std::optional<Vec2>& neutral, const std::string& name) {
    const Vec2 white = neutral.value_or(from.white);
    check(from, white, name);
    const Vec3 ours = bradford * white_xyz(rec709.white), theirs = bradford * white_xyz(white);
    const Vec3 gain = ours / theirs;
    const glm::dmat3 adapt =
        glm::inverse(bradford) * glm::dmat3(gain.x, 0, 0, 0, gain.y, 0, 0, 0, gain.z) * bradford;
    const glm::dmat3 matrix = glm::inverse(to_xyz(rec709)) * adapt * to_xyz(from);
    double difference = 0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            difference = std::max(difference, std::abs(matrix[column][row] - (column == row ? 1.0 : 0.0)));
    // Headers hold four to six digits of each coordinate: 0.3127 is known to 5e-5, a relative 2e-4.
    constexpr double rounding_of_headers = 5e-4;
    if (difference < rounding_of_headers) return std::nullopt;
    return matrix;
}

void convert_colours(const glm::dmat3& matrix, RgbImage* image) {
    size_t outside = 0;
    double least = 0;
    for (size_t i = 0; i < image->rgb.size(); i += 3) {
        float* const texel = &image->rgb[i];
        const Vec3 before(texel[0], texel[1], texel[2]);
        const bool was_light = before.x >= 0 && before.y >= 0 && before.z >= 0;
        Vec3 after = matrix * before;
        // Rounding alone leaves about so much of a component that is 0.
        const double rounding = 4 * double(std::numeric_limits<float>::epsilon()) * (before.x + before.y + before.z);
        bool is_outside = false;
        for (int c = 0; c < 3; ++c) {
            if (was_light && after[c] < 0) {
                is_outside = is_outside || after[c] < -rounding;
                least = std::min(least, after[c]);
                after[c] = 0;
            }
            texel[c] = float(after[c]);
        }
        outside += is_outside;
    }
    if (outside > 0)
        image->notes.push_back(text("of ", outside, " texels the colour is outside the gamut of Rec. 709; their negative ",
                                    "components (the least is ", least, ") were set to 0"));
}

}  // namespace lightband::io
