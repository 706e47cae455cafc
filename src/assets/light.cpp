#include "assets/light.h"

#include <algorithm>

#include "assets/environment_bandwidth.h"
#include "assets/footprint_light.h"

namespace lightband {
namespace {

// Of the map's mean. Half floats keep all their digits down to 2^-14, of which weights of solid angle take a fifth; footprints and pilots
// that reach below the horizon were seen to mislead from 2^-11 on.
constexpr double least_seen = 0x1p-9;

}  // namespace

Light::Light(gl::DevicePtr device, RgbImage map)
    : device_(std::move(device)),
      map_(std::move(map)),
      sampler_(map_),
      unit_(sampler_.unit()),
      hides_light_(sampler_.dimmest_view() < least_seen) {
    const uint32_t limit = uint32_t(device_->max_texture_size());
    if (map_.width > limit || map_.height > limit)
        throw Error(LB_ERROR_LIMIT, text("a map of ", map_.width, " x ", map_.height, " exceeds the device's textures of ", limit));
    texture_ = gl::Texture::image(device_->gl(), GL_RGBA32F, map_.width, map_.height);
    // Some rows at a time: a second copy of a large map would take 2 GiB.
    constexpr uint32_t rows_at_once = 64;
    std::vector<float> texels(size_t(map_.width) * rows_at_once * 4);
    for (uint32_t first = 0; first < map_.height; first += rows_at_once) {
        const uint32_t rows = std::min(rows_at_once, map_.height - first);
        for (uint32_t y = 0; y < rows; ++y)
            for (uint32_t x = 0; x < map_.width; ++x) {
                float* texel = &texels[(size_t(y) * map_.width + x) * 4];
                for (int c = 0; c < 3; ++c) texel[c] = float(map_.texel(x, first + y)[c] / unit_);
                texel[3] = float(sampler_.texel_pdf(x, first + y));
            }
        texture_.upload_rows(first, map_.width, rows, GL_RGBA, GL_FLOAT, texels.data());
    }
    texture_.parameter(GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    texture_.parameter(GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    texture_.parameter(GL_TEXTURE_WRAP_S, GL_REPEAT);
    device_->check("uploading an environment");
}

const std::vector<Lamp>& Light::lamps() const {
    if (!lamps_) lamps_ = lightband::lamps(map_, unit_);
    return *lamps_;
}

const EnvironmentBandwidth& Light::bandwidth(BandRule rule) const {
    auto found = bandwidths_.find(rule);
    if (found == bandwidths_.end())
        found = bandwidths_.emplace(rule, lightband::environment_bandwidth(*device_, texture_, map_.height, rule)).first;
    return found->second;
}

const MapPoints& Light::points(Lookup lookup, uint32_t seed) const {
    if (!points_.points || points_key_ != std::pair(lookup, seed)) {
        std::vector<MapPoint> points = draw_map_points(map_, sampler_, lookup, seed, MapPoints::count);
        const std::vector<MapCluster> clusters = cluster_points(&points, MapPoints::cluster_count);
        MapPoints made;  // replaces the former ones once it is complete
        made.clusters = gl::Buffer(device_->gl(), clusters.size() * sizeof(MapCluster), clusters.data());
        made.points = gl::Buffer(device_->gl(), points.size() * sizeof(MapPoint), points.data());
        made.texture = gl::Texture::of_buffer(device_->gl(), GL_RGBA32F, made.points);
        points_ = std::move(made);
        points_key_ = {lookup, seed};
    }
    return points_;
}

std::string FootprintLight::definitions(Kind kind) {
    if (kind == Kind::whole) return "LIGHT_LAYERS 1";
    return text("BELOW_CEILINGS\nLIGHT_LAYERS ", Ceilings::count, "\nFIRST_CEILING ", Ceilings::first);
}

const FootprintLight& Light::footprints(Lookup lookup, FootprintLight::Kind kind) const {
    const auto key = std::pair(lookup, kind);
    auto found = footprints_.find(key);
    if (found == footprints_.end())
        found = footprints_.emplace(key, footprint_light(*this, lookup, kind)).first;
    return found->second;
}

const LightAbove& Light::above(Lookup lookup) const {
    auto found = above_.find(lookup);
    if (found == above_.end()) {
        const LightTree tree = light_tree(map_, sampler_, lookup);
        LightAbove above;
        std::vector<float> trunk;
        for (uint32_t i = 0; i < LightTree::trunk_parts; ++i) {
            const LightPart& part = tree.parts[LightTree::index(i, 1)];
            trunk.insert(trunk.end(), {part.direction[0], part.direction[1], part.direction[2], part.sine});
            const LightPart::Flux& flux = part.flux[0];
            trunk.insert(trunk.end(), {flux.rgb[0], flux.rgb[1], flux.rgb[2], flux.spread});
        }
        above.trunk = gl::Buffer(device_->gl(), trunk.size() * sizeof(float), trunk.data());
        above.parts = gl::Buffer(device_->gl(), tree.parts.size() * sizeof(LightPart), tree.parts.data());
        above.texture = gl::Texture::of_buffer(device_->gl(), GL_RGBA32F, above.parts);
        found = above_.emplace(lookup, std::move(above)).first;
    }
    return found->second;
}

size_t Light::device_bytes() const {
    size_t bytes = texture_.bytes() + points_.points.bytes() + points_.clusters.bytes();
    for (const auto& [rule, bandwidth] : bandwidths_) bytes += bandwidth.moments.bytes() + bandwidth.bandwidth.bytes();
    for (const auto& [key, footprints] : footprints_) bytes += footprints.texture.bytes();
    for (const auto& [lookup, above] : above_) bytes += above.trunk.bytes() + above.parts.bytes();
    return bytes;
}

}  // namespace lightband
