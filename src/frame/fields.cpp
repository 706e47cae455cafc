#include "frame/fields.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gl/read_back.h"
#include "passes/covered.h"
#include "passes/predict.h"
#include "picture/decision.h"

namespace lightband {
namespace {

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

// Eq. 9 as printed bounds a mirror's variance so loosely that the bound may be beyond a float's range: then it is the
// largest float, in a shader's units and in the map's.
std::vector<float> scaled_bound(std::vector<float> values, double unit) {
    constexpr float most = std::numeric_limits<float>::max();
    for (float& value : values)
        if (std::isfinite(value)) value = value == most ? most : float(std::min(value * unit, double(most)));
    return values;
}

double luminance_of(const float* rgb) {
    return luminance(Vec3(rgb[0], rgb[1], rgb[2]));
}

// How interpolation's squared error is spread over the pixels, up to a factor: linear interpolation errs by the square
// of bandwidth times spacing.
std::vector<float> interpolation_shape(const FrameResult& r) {
    std::vector<float> shape(r.pixels());
    if (!r.prediction || !r.prediction->pyramids) return shape;
    const std::vector<float> bandwidth = read_floats(r.prediction->bandwidth, GL_BLUE, r.pixels(), 1);
    for (size_t i = 0; i < shape.size(); ++i) {
        const uint32_t bits = uint32_t(i % r.width) | uint32_t(i / r.width);
        const int level =
            1 +
            (bits == 0 ? 0 : int(std::log2(double(bits & (~bits + 1)))));  // log2 of the spacing between two parents
        shape[i] = float(std::pow(bandwidth[i] * std::ldexp(1.0, level), 4));
    }
    return shape;
}

// Frames that do not interpolate need no pyramids, nor do those whose shares do not follow variance need that one:
// theirs are made when they are asked for, of the bandwidth as it is.
HostArray pyramid(gl::Device& device, const FrameResult& r, const std::string& name) {
    std::optional<Pyramids> made;
    const bool variances = name == "variance_pyramid";
    if (!r.prediction->pyramids || (variances && !r.prediction->pyramids->variances)) {
        const uint32_t coarsest = r.settings.coarsest_level();
        made.emplace(device.gl(), r.width, r.height, coarsest, variances);
        Forecast forecast;
        forecast.mean_radiance = r.mean_radiance;
        const Scales unscaled{std::vector<float>(size_t(tiles_along(r.width)) * tiles_along(r.height), 1), 1};
        std::vector<uint8_t> material;
        const passes::Covered covered = passes::covered(device.gl(), r.gbuffer, r.width, r.height, coarsest, &material);
        passes::pyramids(device, forecast, unscaled, r.settings, covered, r.width, r.height, *r.prediction, *made);
    }
    const Pyramids& pyramids = made ? *made : *r.prediction->pyramids;
    const size_t count = size_t(r.width) * pyramids.height;
    if (variances)
        return HostArray::of(LB_TYPE_FLOAT32, {pyramids.height, r.width}, "",
                             read_floats(pyramids.variances, GL_RED, count, 1));
    std::vector<uint8_t> levels = read_bytes(pyramids.levels, count);
    if (name == "level_pyramid")
        return HostArray::of(LB_TYPE_UINT8, {pyramids.height, r.width}, "log2(pixel)", std::move(levels));
    levels.resize(r.pixels());
    for (size_t i = 0; i < levels.size(); ++i)
        if (r.material[i] == 0) levels[i] = 0;
    return HostArray::of(LB_TYPE_UINT8, {r.height, r.width}, "log2(pixel)", std::move(levels));
}

HostArray scalar(const FrameResult& r, std::vector<float> values, const char* unit) {
    return HostArray::of(LB_TYPE_FLOAT32, {r.height, r.width}, unit, std::move(values));
}

// What the geometry pass saw.
HostArray seen(const FrameResult& r, const std::string& name) {
    if (name == "normal")
        return HostArray::of(LB_TYPE_FLOAT32, {r.height, r.width, 3}, "",
                             read_floats(r.gbuffer.surface, GL_RGB, r.pixels(), 3));
    std::vector<float> depth = alpha_of(read_floats(r.gbuffer.surface, GL_RGBA, r.pixels(), 4));
    for (size_t i = 0; i < r.pixels(); ++i)
        depth[i] = r.material[i] != 0 ? std::abs(depth[i]) : std::numeric_limits<float>::infinity();
    if (name == "depth") return scalar(r, std::move(depth), "metre");
    std::vector<float> position(3 * r.pixels());
    for (size_t i = 0; i < r.pixels(); ++i) {
        if (r.material[i] == 0) continue;
        const Vec3 at = r.eye + double(depth[i]) * r.gbuffer.rays.through(double(i % r.width), double(i / r.width));
        for (size_t k = 0; k < 3; ++k) position[3 * i + k] = float(at[glm::length_t(k)]);
    }
    return HostArray::of(LB_TYPE_FLOAT32, {r.height, r.width, 3}, "metre", std::move(position));
}

HostArray predicted(gl::Device& device, const FrameResult& r, const std::string& name) {
    const Prediction& prediction = *r.prediction;
    const auto bandwidth = [&](GLenum component) {
        return read_floats(prediction.bandwidth, component, r.pixels(), 1);
    };
    if (name == "bandwidth_spatial") return scalar(r, bandwidth(GL_RED), "1/metre");
    if (name == "bandwidth_angular") return scalar(r, bandwidth(GL_GREEN), "1/radian");
    if (name == "bandwidth_image") return scalar(r, bandwidth(GL_BLUE), "1/pixel");
    if (name == "curvature")
        return scalar(r, alpha_of(read_floats(prediction.bandwidth, GL_RGBA, r.pixels(), 4)), "1/metre");
    if (name == "variance_predicted")
        return scalar(r, scaled_bound(read_floats(prediction.prediction, GL_RED, r.pixels(), 1), r.squared_unit()),
                      "radiance^2");
    return pyramid(device, r, name);
}

// What the rounds drew and showed.
HostArray shaded(const FrameResult& r, const std::string& name) {
    if (name == "color") {
        std::vector<float> rgba = read_floats(r.shading.radiance, GL_RGBA, r.pixels(), 4);
        for (size_t i = 0; i < r.pixels(); ++i) {
            if (!r.accumulated.empty() && r.material[i] != 0) std::copy_n(&r.accumulated[4 * i], 3, &rgba[4 * i]);
        }
        rgba = scaled(std::move(rgba), r.radiance_unit);
        for (size_t i = 0; i < r.pixels(); ++i) rgba[4 * i + 3] = r.material[i] != 0 ? 1.0f : 0.0f;
        return HostArray::of(LB_TYPE_FLOAT32, {r.height, r.width, 4}, "radiance", std::move(rgba));
    }
    if (name == "shaded") {
        std::vector<uint8_t> decisions = read_bytes(r.shading.decision, r.pixels());
        for (uint8_t& decision : decisions) decision = is_shaded(decision);
        return HostArray::of(LB_TYPE_UINT8, {r.height, r.width}, "", std::move(decisions));
    }
    if (name == "error")
        return scalar(r, pixel_errors(r.read_round(), r.estimate, r.slot_of, interpolation_shape(r)), "");
    std::vector<uint32_t> counts = read_words(r.shading.sample_count, r.pixels());
    if (name == "sample_count") return HostArray::of(LB_TYPE_UINT32, {r.height, r.width}, "sample", std::move(counts));
    // variance_measured: the samples' own, unbiased; rounding may leave a constant integrand slightly below zero.
    const std::vector<float> radiance =
        r.accumulated.empty() ? read_floats(r.shading.radiance, GL_RGBA, r.pixels(), 4) : r.accumulated;
    std::vector<float> variance(r.pixels());
    for (size_t i = 0; i < r.pixels(); ++i) {
        if (counts[i] < 2) continue;
        const double mean = luminance_of(&radiance[4 * i]), n = counts[i];
        variance[i] = float(std::max(0.0, (double(radiance[4 * i + 3]) - mean * mean) * n / (n - 1)));
    }
    return scalar(r, scaled(std::move(variance), r.squared_unit()), "radiance^2");
}

}  // namespace

HostArray field(gl::Device& device, const FrameResult& r, const std::string& name) {
    const auto is_it = [&](const FieldName& f) { return name == f.name; };
    const auto known = std::find_if(std::begin(field_names), std::end(field_names), is_it);
    if (known == std::end(field_names)) {
        std::string all;
        for (const FieldName& f : field_names) all += text(all.empty() ? "" : ", ", f.name);
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("there is no field \"", name, "\"; there are ", all));
    }
    if (known->predicted && !r.prediction)
        throw Error(LB_ERROR_INVALID_STATE, text("field ", name, ": a frame of method reference predicts nothing"));
    if (name == "material")
        return HostArray::of(LB_TYPE_UINT8, {r.height, r.width}, "instance + 1", std::vector<uint8_t>(r.material));
    if (known->predicted) return predicted(device, r, name);
    if (name == "depth" || name == "position" || name == "normal") return seen(r, name);
    return shaded(r, name);
}

}  // namespace lightband
