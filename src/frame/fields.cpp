// A frame's fields as arrays in host memory.
#include <algorithm>
#include <cmath>
#include <limits>

#include "frame/result.h"
#include "picture/decision.h"

namespace lightband {
namespace {

std::vector<float> read_floats(const gl::Texture& texture, GLenum format, size_t texels, size_t components) {
    std::vector<float> values(texels * components);
    texture.read(0, format, GL_FLOAT, values.size() * sizeof(float), values.data());
    return values;
}

std::vector<uint8_t> read_bytes(const gl::Texture& texture, size_t texels) {
    std::vector<uint8_t> values(texels);
    texture.read(0, GL_RED_INTEGER, GL_UNSIGNED_BYTE, values.size(), values.data());
    return values;
}

std::vector<uint32_t> read_words(const gl::Texture& texture, size_t texels) {
    std::vector<uint32_t> values(texels);
    texture.read(0, GL_RED_INTEGER, GL_UNSIGNED_INT, texels * sizeof(uint32_t), values.data());
    return values;
}

// The last of four components; the others a readback can pick by itself.
std::vector<float> alpha_of(const std::vector<float>& rgba) {
    std::vector<float> alpha(rgba.size() / 4);
    for (size_t i = 0; i < alpha.size(); ++i) alpha[i] = rgba[4 * i + 3];
    return alpha;
}

// From what shaders count radiance in, or its square, to the map's own units.
std::vector<float> scaled(std::vector<float> values, double unit) {
    for (float& value : values) value = float(value * unit);
    return values;
}

// Eq. 9 as printed bounds a mirror's variance so loosely that the bound may be beyond a float's range: then it is the largest float, in a
// shader's units and in the map's.
std::vector<float> scaled_bound(std::vector<float> values, double unit) {
    constexpr float most = std::numeric_limits<float>::max();
    for (float& value : values)
        if (std::isfinite(value)) value = value == most ? most : float(std::min(value * unit, double(most)));
    return values;
}

double luminance_of(const float* rgb) { return luminance(Vec3(rgb[0], rgb[1], rgb[2])); }

}  // namespace

RoundPixels Frame::Result::read_round() const {
    const size_t count = size_t(stats.width) * stats.height;
    RoundPixels pixels;
    pixels.radiance = accumulated.empty() ? read_floats(shading.radiance, GL_RGBA, count, 4) : accumulated;
    pixels.spread = read_floats(shading.spread, GL_RGBA, count, 4);
    if (prediction) pixels.expected = read_floats(prediction->prediction, GL_GREEN, count, 1);
    pixels.sample_count = read_words(shading.sample_count, count);
    pixels.decision = read_bytes(shading.decision, count);
    pixels.material = read_bytes(gbuffer.material, count);
    pixels.neighbour_part = neighbour_part;
    pixels.combined = !neighbour_part.empty();
    return pixels;
}

// A pixel of a lattice stands for those nearer to it than to others of the lattice, or of its own spacing.
std::vector<float> Frame::Result::areas() const {
    if (!prediction || !prediction->pyramids) return {};
    std::vector<float> areas(size_t(stats.width) * stats.height, 1);
    const std::vector<uint8_t> levels = read_bytes(prediction->pyramids->levels, size_t(stats.width) * prediction->pyramids->height);
    for (size_t i = 0; i < areas.size(); ++i) {
        const uint32_t x = uint32_t(i % stats.width), y = uint32_t(i / stats.width);
        areas[i] = std::ldexp(1.0f, 2 * int(std::min(lattice_level(x, y, settings.coarsest_level()), uint32_t(levels[i]))));
    }
    return areas;
}

// How interpolation's squared error is spread over the pixels, up to a factor: linear interpolation errs by the square of
// bandwidth times spacing.
std::vector<float> Frame::interpolation_shape() const {
    const Result& r = result();
    std::vector<float> shape(pixels());
    if (!r.prediction || !r.prediction->pyramids) return shape;
    const std::vector<float> bandwidth = read_floats(r.prediction->bandwidth, GL_BLUE, pixels(), 1);
    for (size_t i = 0; i < shape.size(); ++i) {
        const uint32_t bits = uint32_t(i % width_) | uint32_t(i / width_);
        const int level = 1 + (bits == 0 ? 0 : int(std::log2(double(bits & (~bits + 1)))));  // log2 of the spacing between two parents
        shape[i] = float(std::pow(bandwidth[i] * std::ldexp(1.0, level), 4));
    }
    return shape;
}

// Frames that do not interpolate need no pyramids, nor do those whose shares do not follow variance need that one: theirs
// are made when they are asked for, of the bandwidth as it is.
HostArray Frame::pyramid(const std::string& name, const std::vector<uint8_t>& material) const {
    const Result& r = result();
    std::optional<Pyramids> made;
    const bool variances = name == "variance_pyramid";
    if (!r.prediction->pyramids || (variances && !r.prediction->pyramids->variances)) {
        const uint32_t coarsest = r.settings.coarsest_level();
        made.emplace(device_->gl(), width_, height_, coarsest, variances);
        Forecast forecast;
        forecast.mean_radiance = r.mean_radiance;
        const Scales unscaled{std::vector<float>(size_t(tiles_along(width_)) * tiles_along(height_), 1), 1};
        const passes::Covered covered = passes::covered(device_->gl(), r.gbuffer, width_, height_, coarsest);
        passes::pyramids(*device_, forecast, unscaled, r.settings, covered, width_, height_, *r.prediction, *made);
    }
    const Pyramids& pyramids = made ? *made : *r.prediction->pyramids;
    const size_t count = size_t(width_) * pyramids.height;
    if (variances)
        return HostArray::of(LB_TYPE_FLOAT32, {pyramids.height, width_}, "", read_floats(pyramids.variances, GL_RED, count, 1));
    std::vector<uint8_t> levels = read_bytes(pyramids.levels, count);
    if (name == "level_pyramid") return HostArray::of(LB_TYPE_UINT8, {pyramids.height, width_}, "log2(pixel)", std::move(levels));
    levels.resize(material.size());
    for (size_t i = 0; i < levels.size(); ++i)
        if (material[i] == 0) levels[i] = 0;
    return HostArray::of(LB_TYPE_UINT8, {height_, width_}, "log2(pixel)", std::move(levels));
}

const Settings& Frame::rendered_settings() const { return result().settings; }

HostArray Frame::field(const std::string& name) const {
    const auto is_it = [&](const FieldName& f) { return name == f.name; };
    const auto known = std::find_if(std::begin(field_names), std::end(field_names), is_it);
    if (known == std::end(field_names)) {
        std::string all;
        for (const FieldName& f : field_names) all += text(all.empty() ? "" : ", ", f.name);
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("there is no field \"", name, "\"; there are ", all));
    }
    const Result& r = result();
    if (known->predicted && !r.prediction)
        throw Error(LB_ERROR_INVALID_STATE, text("field ", name, ": a frame of method reference predicts nothing"));
    std::vector<uint8_t> material = read_bytes(r.gbuffer.material, pixels());
    if (name == "material") return HostArray::of(LB_TYPE_UINT8, {height_, width_}, "instance + 1", std::move(material));
    if (known->predicted) return predicted(name, material);
    if (name == "depth" || name == "position" || name == "normal") return seen(name, material);
    return shaded(name, material);
}

HostArray Frame::scalar(std::vector<float> values, const char* unit) const {
    return HostArray::of(LB_TYPE_FLOAT32, {height_, width_}, unit, std::move(values));
}

// What the geometry pass saw.
HostArray Frame::seen(const std::string& name, const std::vector<uint8_t>& material) const {
    const Result& r = result();
    if (name == "normal")
        return HostArray::of(LB_TYPE_FLOAT32, {height_, width_, 3}, "", read_floats(r.gbuffer.surface, GL_RGB, pixels(), 3));
    std::vector<float> depth = alpha_of(read_floats(r.gbuffer.surface, GL_RGBA, pixels(), 4));
    for (size_t i = 0; i < pixels(); ++i) depth[i] = material[i] != 0 ? std::abs(depth[i]) : std::numeric_limits<float>::infinity();
    if (name == "depth") return scalar(std::move(depth), "metre");
    std::vector<float> position(3 * pixels());
    for (size_t i = 0; i < pixels(); ++i) {
        if (material[i] == 0) continue;
        const Vec3 at = r.eye + double(depth[i]) * r.gbuffer.rays.through(double(i % width_), double(i / width_));
        for (size_t k = 0; k < 3; ++k) position[3 * i + k] = float(at[glm::length_t(k)]);
    }
    return HostArray::of(LB_TYPE_FLOAT32, {height_, width_, 3}, "metre", std::move(position));
}

HostArray Frame::predicted(const std::string& name, const std::vector<uint8_t>& material) const {
    const Prediction& prediction = *result().prediction;
    const auto bandwidth = [&](GLenum component) { return read_floats(prediction.bandwidth, component, pixels(), 1); };
    if (name == "bandwidth_spatial") return scalar(bandwidth(GL_RED), "1/metre");
    if (name == "bandwidth_angular") return scalar(bandwidth(GL_GREEN), "1/radian");
    if (name == "bandwidth_image") return scalar(bandwidth(GL_BLUE), "1/pixel");
    if (name == "curvature") return scalar(alpha_of(read_floats(prediction.bandwidth, GL_RGBA, pixels(), 4)), "1/metre");
    if (name == "variance_predicted")
        return scalar(scaled_bound(read_floats(prediction.prediction, GL_RED, pixels(), 1), result().squared_unit()), "radiance^2");
    return pyramid(name, material);
}

// What the rounds drew and showed.
HostArray Frame::shaded(const std::string& name, const std::vector<uint8_t>& material) const {
    const Result& r = result();
    if (name == "color") {
        std::vector<float> rgba = read_floats(r.shading.radiance, GL_RGBA, pixels(), 4);
        for (size_t i = 0; i < pixels(); ++i) {
            if (!r.accumulated.empty() && material[i] != 0) std::copy_n(&r.accumulated[4 * i], 3, &rgba[4 * i]);
        }
        rgba = scaled(std::move(rgba), r.radiance_unit);
        for (size_t i = 0; i < pixels(); ++i) rgba[4 * i + 3] = material[i] != 0 ? 1.0f : 0.0f;
        return HostArray::of(LB_TYPE_FLOAT32, {height_, width_, 4}, "radiance", std::move(rgba));
    }
    if (name == "shaded") {
        std::vector<uint8_t> decisions = read_bytes(r.shading.decision, pixels());
        for (uint8_t& decision : decisions) decision = is_shaded(decision);
        return HostArray::of(LB_TYPE_UINT8, {height_, width_}, "", std::move(decisions));
    }
    if (name == "error") return scalar(pixel_errors(r.read_round(), r.estimate, r.slot_of, interpolation_shape()), "");
    std::vector<uint32_t> counts = read_words(r.shading.sample_count, pixels());
    if (name == "sample_count") return HostArray::of(LB_TYPE_UINT32, {height_, width_}, "sample", std::move(counts));
    // variance_measured: the samples' own, unbiased; rounding may leave a constant integrand slightly below zero.
    const std::vector<float> radiance = r.accumulated.empty() ? read_floats(r.shading.radiance, GL_RGBA, pixels(), 4) : r.accumulated;
    std::vector<float> variance(pixels());
    for (size_t i = 0; i < pixels(); ++i) {
        if (counts[i] < 2) continue;
        const double mean = luminance_of(&radiance[4 * i]), n = counts[i];
        variance[i] = float(std::max(0.0, (double(radiance[4 * i + 3]) - mean * mean) * n / (n - 1)));
    }
    return scalar(scaled(std::move(variance), r.squared_unit()), "radiance^2");
}

}  // namespace lightband
