#include "scene/light.h"

#include "passes/environment_bandwidth.h"

namespace lightband {

Light::Light(gl::DevicePtr device, RgbImage map) : device_(std::move(device)), map_(std::move(map)) {
    const uint32_t limit = uint32_t(device_->max_texture_size());
    if (map_.width > limit || map_.height > limit)
        throw Error(LB_ERROR_LIMIT, text("a map of ", map_.width, " x ", map_.height, " exceeds the device's textures of ", limit));
    texture_ = gl::Texture::image(device_->gl(), GL_RGBA32F, map_.width, map_.height);
    texture_.upload(map_.width, map_.height, GL_RGB, GL_FLOAT, map_.rgb.data());
    texture_.parameter(GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    texture_.parameter(GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    texture_.parameter(GL_TEXTURE_WRAP_S, GL_REPEAT);
    device_->check("uploading an environment");
}

const EnvironmentBandwidth& Light::bandwidth(BandRule rule) const {
    auto found = bandwidths_.find(rule);
    if (found == bandwidths_.end())
        found = bandwidths_.emplace(rule, passes::environment_bandwidth(*device_, texture_, map_.height, rule)).first;
    return found->second;
}

size_t Light::device_bytes() const {
    size_t bytes = texture_.bytes();
    for (const auto& [rule, bandwidth] : bandwidths_) bytes += bandwidth.moments.bytes() + bandwidth.bandwidth.bytes();
    return bytes;
}

}  // namespace lightband
