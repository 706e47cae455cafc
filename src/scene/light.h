// An environment on a device: its map, and its bandwidth on the octahedral square, computed there when first asked for.
#pragma once

#include <map>

#include "bandwidth/wavelet.h"
#include "gl/objects.h"
#include "scene/environment.h"

namespace lightband {

// Filled by passes/environment_bandwidth.
struct EnvironmentBandwidth {
    uint32_t side = 0;
    gl::Texture moments;    // mip-mapped means of L, L^2, L nu_a
    gl::Texture bandwidth;  // nu_a, cycles/radian
};

class Light {
public:
    // The map has been checked (check_radiance).
    Light(gl::DevicePtr device, RgbImage map);

    const gl::DevicePtr& device() const { return device_; }
    const RgbImage& map() const { return map_; }
    const gl::Texture& texture() const { return texture_; }
    const EnvironmentBandwidth& bandwidth(BandRule rule) const;
    size_t device_bytes() const;

private:
    gl::DevicePtr device_;
    const RgbImage map_;
    gl::Texture texture_;
    mutable std::map<BandRule, EnvironmentBandwidth> bandwidths_;
};

}  // namespace lightband
