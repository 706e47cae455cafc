#include "lights/sun.h"

#include <cmath>

#include "bandwidth/disc_bandwidth.h"
#include "gl/dispatch.h"
#include "scene/environment.h"

namespace lightband {
namespace {

// Of a pixel's samples, one in so many are drawn besides from each sun: a lobe varies little over a disc of half a
// degree.
constexpr uint32_t samples_to_one_of_a_sun = 4;

class SunGroup : public LightGroup {
public:
    SunGroup(const std::vector<std::shared_ptr<const Light>>& lights, double unit) : count_(int32_t(lights.size())) {
        device_ = lights.front()->device();
        std::vector<float> values;
        for (const auto& light : lights) {
            const Sun& sun = std::static_pointer_cast<const SunLight>(light)->sun();
            const Vec3 radiance = sun.radiance() / unit;
            for (const double value : {sun.direction.x, sun.direction.y, sun.direction.z, std::sin(sun.angular_radius),
                                       radiance.x, radiance.y, radiance.z, sun.versine()})
                values.push_back(float(value));
        }
        buffer_ = gl::Buffer(device_->gl(), values.size() * sizeof(float), values.data());
        texture_ = gl::Texture::of_buffer(device_->gl(), GL_RGBA32F, buffer_);
    }

    void prepare(const Settings&, uint32_t, bool) const override {}

    std::string definitions(LightPass, const Settings&) const override {
        return text("SAMPLES_TO_ONE_OF_A_SUN ", samples_to_one_of_a_sun, "u");
    }

    void bind(LightPass pass, const Settings& settings, uint32_t, const gl::Program& program) const override {
        program.set("sun_count", count_);
        // A disc's bandwidth goes with one over its radius.
        if (pass == LightPass::predict)
            program.set("unit_disc_bandwidth", float(disc_bandwidth(1, settings.band_rule())));
        bind_texture(device_->gl(), 11, texture_);
    }

    bool predicts_by_lobe() const override { return true; }
    bool needs_importance(const Settings&) const override { return false; }
    uint32_t loops_per_sample() const override { return 2 * uint32_t(count_); }

private:
    gl::DevicePtr device_;
    int32_t count_;
    gl::Buffer buffer_;
    gl::Texture texture_;
};

}  // namespace

const LightKind SunLight::registered = {"sun", [](std::vector<std::shared_ptr<const Light>> lights, double unit) {
                                            return std::unique_ptr<LightGroup>(new SunGroup(lights, unit));
                                        }};

double SunLight::power() const {
    const Vec3 radiance = sun_.radiance();
    return (radiance.x + radiance.y + radiance.z) / 3 * sun_.solid_angle() / (4 * pi);
}

Sun SunLight::from(const lb_sun_desc& desc) {
    Sun sun;
    const float* v = desc.direction;
    const double length = glm::length(Vec3(v[0], v[1], v[2]));
    if (!(length > 0) || !std::isfinite(length))
        throw Error(LB_ERROR_INVALID_ARGUMENT,
                    text("desc: direction is (", v[0], ", ", v[1], ", ", v[2], "); it must be a direction"));
    sun.direction = Vec3(v[0], v[1], v[2]) / length;
    if (desc.angular_radius != 0) {
        sun.angular_radius = double(desc.angular_radius);
        // The limit as a float is a little more than pi / 2.
        if (!(desc.angular_radius >= float(Sun::least_radius) && desc.angular_radius <= float(Sun::largest_radius)))
            throw Error(LB_ERROR_INVALID_ARGUMENT,
                        text("desc: angular_radius is ", desc.angular_radius, "; it must be ", Sun::least_radius,
                             " .. pi / 2 radians, or 0 for that of the sun, ", Sun::standard_radius));
    }
    const double most = double(largest_radiance) * sun.projected_solid_angle();
    for (int c = 0; c < 3; ++c) {
        if (!(desc.irradiance[c] >= 0 && double(desc.irradiance[c]) <= most))
            throw Error(LB_ERROR_INVALID_ARGUMENT,
                        text("desc: irradiance[", c, "] is ", desc.irradiance[c], "; it must be 0 .. ", most,
                             " for a disc of ", sun.angular_radius, " radians, of radiance ", largest_radiance));
        sun.irradiance[c] = double(desc.irradiance[c]);
    }
    return sun;
}

}  // namespace lightband
