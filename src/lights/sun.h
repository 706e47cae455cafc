// A sun: it is given by a direction, an angular radius and an irradiance, and may move between frames.
#pragma once

#include "lights/light.h"
#include "scene/sun.h"

namespace lightband {

class SunLight : public Light {
public:
    SunLight(gl::DevicePtr device, const Sun& sun) : sun_(sun), device_(std::move(device)) {}
    // Throws where the description is not one of a sun.
    static Sun from(const lb_sun_desc& desc);

    static const LightKind registered;
    const LightKind& kind() const override { return registered; }
    const gl::DevicePtr& device() const override { return device_; }
    Vec3 evaluate(const Vec3& direction, Lookup) const override {
        return sun_.contains(direction) ? sun_.radiance() : Vec3(0);
    }
    Sample sample(const Vec2& u) const override { return {sun_.sample(u), 1 / sun_.solid_angle()}; }
    double pdf(const Vec3& direction) const override { return sun_.contains(direction) ? 1 / sun_.solid_angle() : 0; }
    double power() const override;
    // What shaders read of it is written for each frame: it takes 32 bytes.
    size_t device_bytes() const override { return 0; }

    const Sun& sun() const { return sun_; }
    void set(const Sun& sun) { sun_ = sun; }

private:
    Sun sun_;
    gl::DevicePtr device_;
};

}  // namespace lightband
