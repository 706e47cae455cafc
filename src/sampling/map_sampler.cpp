#include "sampling/map_sampler.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sampling/sequence.h"
#include "scene/environment.h"

namespace lightband {
namespace {

double mean(const float* rgb) { return (double(rgb[0]) + rgb[1] + rgb[2]) / 3; }

// Mean over a texel of bilinear interpolation between texel centres: weights 1/8, 6/8, 1/8 along each axis.
double smoothed(const RgbImage& map, uint32_t x, uint32_t y) {
    const uint32_t left = (x + map.width - 1) % map.width, right = (x + 1) % map.width;
    const auto row = [&](uint32_t at) {
        return (mean(map.texel(left, at)) + 6 * mean(map.texel(x, at)) + mean(map.texel(right, at))) / 8;
    };
    return (row(y > 0 ? y - 1 : 0) + 6 * row(y) + row(std::min(y + 1, map.height - 1))) / 8;
}

// The interval of ascending running sums that holds target: its index and the part of it that lies below target.
std::pair<uint32_t, double> invert(const double* sums, uint32_t count, double target) {
    const auto index = uint32_t(std::min<ptrdiff_t>(std::upper_bound(sums, sums + count, target) - sums, count - 1));
    const double before = index > 0 ? sums[index - 1] : 0, own = sums[index] - before;
    return {index, own > 0 ? std::clamp((target - before) / own, 0.0, 1.0) : 0.5};
}

}  // namespace

MapSampler::MapSampler(const RgbImage& map) : width_(map.width), height_(map.height) {
    texels_.resize(size_t(width_) * height_);
    rows_.resize(height_);
    const bool black = std::all_of(map.rgb.begin(), map.rgb.end(), [](float value) { return value == 0; });
    double total = 0;
    for (uint32_t y = 0; y < height_; ++y) {
        double row = 0;
        for (uint32_t x = 0; x < width_; ++x) {
            row += (black ? 1.0 : smoothed(map, x, y)) * solid_angle(y);
            texels_[size_t(y) * width_ + x] = row;
        }
        rows_[y] = total += row;
    }
}

double MapSampler::unit() const { return std::exp2(std::floor(std::log2(total() / (4 * pi)))); }

double MapSampler::dimmest_view() const {
    bool black = false;
    const double octant = least_density(4, 2, &black);
    return black ? least_density(32, 16, &black) : octant;
}

// The least mean density, over that of the sphere, of so many cells that any light comes from; black: whether there are others.
double MapSampler::least_density(uint32_t columns, uint32_t rows, bool* black) const {
    // The running sum along a row up to a part of its width, within a texel in proportion.
    const auto sum_to = [this](uint32_t y, double part) {
        const double at = part * width_;
        const uint32_t whole = uint32_t(at);
        const double* row = &texels_[size_t(y) * width_];
        const double before = whole > 0 ? row[whole - 1] : 0;
        return whole < width_ ? before + (at - whole) * (row[whole] - before) : before;
    };
    double least = std::numeric_limits<double>::infinity();
    for (uint32_t j = 0; j < rows; ++j) {
        const double low = double(j) / rows * height_, high = (j + 1.0) / rows * height_;
        const double solid_angle = 2 * pi / columns * (std::cos(pi * j / rows) - std::cos(pi * (j + 1.0) / rows));
        for (uint32_t i = 0; i < columns; ++i) {
            double light = 0;
            for (uint32_t y = uint32_t(low); y < height_ && y < high; ++y) {
                // The part of the row that lies in the cell: a texel's light is even over it.
                const double top = std::cos(pi * std::max(low, double(y)) / height_), bottom = std::cos(pi * std::min(high, y + 1.0) / height_);
                const double whole = std::cos(pi * y / height_) - std::cos(pi * (y + 1.0) / height_);
                light += (top - bottom) / whole * (sum_to(y, (i + 1.0) / columns) - sum_to(y, double(i) / columns));
            }
            if (light > 0)
                least = std::min(least, light / solid_angle);
            else
                *black = true;
        }
    }
    return least * 4 * pi / rows_.back();
}

double MapSampler::solid_angle(uint32_t row) const {
    const double top = std::cos(pi * row / height_), bottom = std::cos(pi * (row + 1.0) / height_);
    return 2 * pi / width_ * (top - bottom);
}

MapSampler::Sample MapSampler::sample(const Vec2& u) const {
    const auto [y, v] = invert(rows_.data(), height_, u.x * rows_.back());
    const double* row = &texels_[size_t(y) * width_];
    const auto [x, across] = invert(row, width_, u.y * row[width_ - 1]);
    // Even in solid angle: in longitude, and in the sine of latitude.
    const double top = std::cos(pi * y / height_), bottom = std::cos(pi * (y + 1.0) / height_);
    const double sine = top + v * (bottom - top), cosine = std::sqrt(std::max(0.0, 1 - sine * sine));
    const double longitude = (0.5 - (x + across) / width_) * 2 * pi;
    return {Vec3(cosine * std::sin(longitude), sine, cosine * std::cos(longitude)), texel_pdf(x, y)};
}

double MapSampler::texel_pdf(uint32_t x, uint32_t y) const {
    const double* row = &texels_[size_t(y) * width_];
    return (row[x] - (x > 0 ? row[x - 1] : 0)) / (solid_angle(y) * rows_.back());
}

double MapSampler::pdf(const Vec3& direction) const {
    const Vec2 uv = latitude_longitude(direction);
    return texel_pdf(std::min(uint32_t(uv.x * width_), width_ - 1), std::min(uint32_t(uv.y * height_), height_ - 1));
}

double MapSampler::interpolated_pdf(const Vec3& direction) const {
    const Vec2 at = latitude_longitude(direction) * Vec2(width_, height_) - Vec2(0.5);
    const double x0 = std::floor(at.x), y0 = std::floor(at.y), fx = at.x - x0, fy = at.y - y0;
    const auto texel = [&](double x, double y) {
        const auto wrapped = uint32_t((int64_t(x) + width_) % width_);
        return texel_pdf(wrapped, uint32_t(std::clamp(y, 0.0, height_ - 1.0)));
    };
    return (1 - fy) * ((1 - fx) * texel(x0, y0) + fx * texel(x0 + 1, y0)) +
           fy * ((1 - fx) * texel(x0, y0 + 1) + fx * texel(x0 + 1, y0 + 1));
}

std::vector<MapPoint> draw_map_points(const RgbImage& map, const MapSampler& sampler, Lookup lookup, uint32_t seed,
                                      uint32_t count) {
    // Two well-mixed words of the seed (the finaliser of MurmurHash3, Appleby 2011).
    const auto mix = [](uint32_t h) {
        h = (h ^ h >> 16) * 0x85ebca6bu;
        h = (h ^ h >> 13) * 0xc2b2ae35u;
        return h ^ h >> 16;
    };
    const uint32_t shift_x = mix(seed + 0x9e3779b9u), shift_y = mix(shift_x + 0x9e3779b9u);
    std::vector<MapPoint> points(count);
    for (uint32_t i = 0; i < count; ++i) {
        const SequencePoint point = sequence_point(i);
        const MapSampler::Sample sample = sampler.sample(to_unit({point.x ^ shift_x, point.y ^ shift_y}));
        const Vec3& d = sample.direction;
        const Vec3 light = radiance(map, d, lookup) / sampler.unit();
        points[i] = {{float(d.x), float(d.y), float(d.z)}, float(1 / sample.pdf),
                     {float(light.x), float(light.y), float(light.z)}, float(lookup == Lookup::linear ? sampler.interpolated_pdf(d) : sampler.pdf(d))};
    }
    return points;
}

namespace {

// Orders points[0 .. count) so that each half, quarter ... is compact.
void halve(MapPoint* points, size_t count) {
    if (count < 2) return;
    float low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = high[axis] = points[0].direction[axis];
        for (size_t i = 1; i < count; ++i) {
            low[axis] = std::min(low[axis], points[i].direction[axis]);
            high[axis] = std::max(high[axis], points[i].direction[axis]);
        }
    }
    int widest = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (high[axis] - low[axis] > high[widest] - low[widest]) widest = axis;
    std::nth_element(points, points + count / 2, points + count, [widest](const MapPoint& a, const MapPoint& b) {
        return a.direction[widest] < b.direction[widest];
    });
    halve(points, count / 2);
    halve(points + count / 2, count - count / 2);
}

MapCluster cluster_of(const MapPoint* points, size_t count) {
    Vec3 sum(0);
    double solid_angle = 0;
    for (size_t i = 0; i < count; ++i) {
        sum += Vec3(points[i].direction[0], points[i].direction[1], points[i].direction[2]);
        solid_angle += points[i].inverse_pdf;
    }
    // A cluster around the whole sphere has no middle; any direction serves for one that is seen from everywhere.
    const double length = glm::length(sum);
    const Vec3 middle = length > 0 ? sum / length : Vec3(0, 1, 0);
    double cosine = 1;
    for (size_t i = 0; i < count; ++i)
        cosine = std::min(cosine, glm::dot(middle, Vec3(points[i].direction[0], points[i].direction[1], points[i].direction[2])));
    const double sine = cosine > 0 ? std::sqrt(std::max(0.0, 1 - cosine * cosine)) : 1;
    return {{float(middle.x), float(middle.y), float(middle.z)}, float(sine), float(count / solid_angle), {}};
}

}  // namespace

std::vector<MapCluster> cluster_points(std::vector<MapPoint>* points, uint32_t clusters) {
    halve(points->data(), points->size());
    const size_t each = points->size() / clusters;
    std::vector<MapCluster> result;
    std::vector<MapPoint> ordered(each);
    for (uint32_t cluster = 0; cluster < clusters; ++cluster) {
        MapPoint* own = points->data() + cluster * each;
        result.push_back(cluster_of(own, each));
        for (size_t i = 0; i < each; ++i) {
            size_t reversed = 0;
            for (size_t bit = 1; bit < each; bit *= 2) reversed = reversed * 2 + ((i & bit) != 0 ? 1 : 0);
            ordered[i] = own[reversed];
        }
        std::copy(ordered.begin(), ordered.end(), own);
    }
    return result;
}

}  // namespace lightband
