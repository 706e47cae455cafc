#include "lights/environment.h"

#include <algorithm>

#include "gl/dispatch.h"
#include "lights/environment_bandwidth.h"
#include "lights/footprint_light.h"
#include "lights/sun.h"
#include "sampling/bright_sources.h"

namespace lightband {
namespace {

// Of the map's mean. Half floats keep all their digits down to 2^-14, of which weights of solid angle take a fifth;
// footprints and pilots that reach below the horizon were seen to mislead from 2^-11 on.
constexpr double least_seen = 0x1p-9;

// Of a texel under linear lookup, the half width (that of a whole texel) over the radius of the disc that is as wide,
// sqrt(2 / 6 * 2).
constexpr double corner_reach = 1.2247449;

// The one environment of a frame.
class EnvironmentGroup : public LightGroup {
public:
    EnvironmentGroup(std::shared_ptr<const Light> light, double unit)
        : light_(std::static_pointer_cast<const EnvironmentLight>(std::move(light))), scale_(light_->unit() / unit) {}

    void prepare(const Settings& settings, uint32_t points_seed, bool shades) const override {
        if (settings.method() == Method::adaptive) light_->bandwidth(settings.band_rule());
        if (!shades) return;
        const Lookup lookup = settings.environment_lookup();
        const Sampler sampler = settings.sampler();
        if (sampler == Sampler::filtered || sampler == Sampler::cut)
            light_->footprints(lookup, footprint_kind(sampler));
        if (sampler == Sampler::cut) light_->above(lookup);
        if (sampler == Sampler::combined) light_->points(lookup, points_seed);
    }

    std::string definitions(LightPass pass, const Settings& settings) const override {
        std::string result = settings.environment_lookup() == Lookup::nearest ? "ENVIRONMENT_NEAREST" : "";
        if (pass == LightPass::classify)
            return text("BRIGHT_SOURCES ", light_->sources(settings.environment_lookup()).size());
        if (pass != LightPass::predict && pass != LightPass::shade) return result;
        if (light_->hides_light()) result += "\nHIDES_LIGHT";
        switch (settings.sampler()) {
            case Sampler::cut:
                result += "\nSAMPLER_CUT";
                break;
            case Sampler::combined:
                result += text("\nSAMPLER_COMBINED\nMAP_WORTH ", map_sample_worth);
                break;
            default:
                break;
        }
        return pass == LightPass::shade ? result + tables(settings.sampler()) : result;
    }

    void bind(LightPass pass, const Settings& settings, uint32_t points_seed,
              const gl::Program& program) const override {
        const gl::Functions& gl = light_->device()->gl();
        if (pass == LightPass::classify) return bind_sources(settings, program);
        program.set("environment_scale", float(scale_));
        if (pass == LightPass::predict) {
            const EnvironmentBandwidth& bandwidth = light_->bandwidth(settings.band_rule());
            program.set("map_density", float(1 / (4 * pi * light_->mean())));
            program.set("footprint_level", float(std::log2(double(bandwidth.side) * bandwidth.side / (4 * pi))));
            bind_texture(gl, 13, bandwidth.moments);
            return;
        }
        bind_texture(gl, 0, light_->texture());
        if (pass == LightPass::shade) bind_tables(settings, points_seed, program);
    }

    bool predicts_by_lobe() const override { return false; }
    bool needs_importance(const Settings& settings) const override {
        return settings.sampler() == Sampler::cut || settings.sampler() == Sampler::combined;
    }

private:
    static FootprintLight::Kind footprint_kind(Sampler sampler) {
        return sampler == Sampler::cut ? FootprintLight::Kind::below_ceilings : FootprintLight::Kind::whole;
    }

    static std::string tables(Sampler sampler) {
        switch (sampler) {
            case Sampler::cut:
                return text("\nFILTERED\nTRUNK_PARTS ", LightTree::trunks[0].count, "\nCOARSE_TRUNK_PARTS ",
                            LightTree::trunks[1].count, "\nTREE_DEPTH ", LightTree::depth, "u\nCEILING_WORTH ",
                            Ceilings::worth, "\n", FootprintLight::definitions(footprint_kind(sampler)));
            case Sampler::combined:
                return text("\nMAP_POINTS ", MapPoints::count, "u\nMAP_CLUSTERS ", MapPoints::cluster_count);
            case Sampler::filtered:
                return "\nFILTERED\n" + FootprintLight::definitions(footprint_kind(sampler));
            case Sampler::brdf:
                break;
        }
        return "";
    }

    // Each with the sine of the half angle that it fills.
    void bind_sources(const Settings& settings, const gl::Program& program) const {
        const std::vector<Sun>& sources = light_->sources(settings.environment_lookup());
        for (size_t i = 0; i < sources.size(); ++i) {
            // A texel's corners lie further from its middle than the edge of a disc of the same width.
            const Vec3& d = sources[i].direction;
            const double reach = std::min(corner_reach * sources[i].angular_radius, pi / 2);
            program.set(text("bright_sources[", i, "]").c_str(),
                        {float(d.x), float(d.y), float(d.z), float(std::sin(reach))});
        }
    }

    // The tables of the sampler.
    void bind_tables(const Settings& settings, uint32_t points_seed, const gl::Program& program) const {
        const gl::Functions& gl = light_->device()->gl();
        const Lookup lookup = settings.environment_lookup();
        const Sampler sampler = settings.sampler();
        if (sampler == Sampler::filtered || sampler == Sampler::cut) {
            program.set("mean_light", float(light_->mean()));
            bind_texture(gl, 13, light_->footprints(lookup, footprint_kind(sampler)).texture);
        }
        if (sampler == Sampler::cut) {
            const LightAbove& above = light_->above(lookup);
            bind_texture(gl, 10, above.texture);
            bind_uniforms(gl, 0, above.trunk);
        }
        if (sampler == Sampler::combined) {
            const MapPoints& points = light_->points(lookup, points_seed);
            bind_texture(gl, 10, points.texture);
            bind_uniforms(gl, 0, points.clusters);
        }
    }

    const std::shared_ptr<const EnvironmentLight> light_;
    const double scale_;  // from the map's unit to the frame's, a power of two
};

}  // namespace

const LightKind EnvironmentLight::registered = {
    "environment", [](std::vector<std::shared_ptr<const Light>> lights, double unit) {
        return std::unique_ptr<LightGroup>(new EnvironmentGroup(std::move(lights.front()), unit));
    }};

Light::Sample EnvironmentLight::sample(const Vec2& u) const {
    const MapSampler::Sample sample = sampler_.sample(u);
    return {sample.direction, sample.pdf};
}

double EnvironmentLight::power() const {
    const bool black = std::all_of(map_.rgb.begin(), map_.rgb.end(), [](float value) { return value == 0; });
    return black ? 0 : sampler_.total() / (4 * pi);
}

EnvironmentLight::EnvironmentLight(gl::DevicePtr device, RgbImage map)
    : device_(std::move(device)),
      map_(std::move(map)),
      sampler_(map_),
      unit_(sampler_.unit()),
      hides_light_(sampler_.dimmest_view() < least_seen) {
    const uint32_t limit = uint32_t(device_->max_texture_size());
    if (map_.width > limit || map_.height > limit)
        throw Error(LB_ERROR_LIMIT,
                    text("a map of ", map_.width, " x ", map_.height, " exceeds the device's textures of ", limit));
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

std::vector<std::shared_ptr<const Light>> EnvironmentLight::split(const Settings& settings) const {
    if (!settings.split_suns()) return {};
    const Lookup lookup = settings.environment_lookup();
    auto found = split_.find(lookup);
    if (found == split_.end()) {
        BrightSources sources = split_bright_sources(map_, unit_, lookup);
        std::vector<std::shared_ptr<const Light>> lights;
        if (!sources.suns.empty()) {
            device_->log(
                text("split_suns: ", sources.suns.size(), " small bright sources of an environment became suns"));
            lights.push_back(std::make_shared<const EnvironmentLight>(device_, std::move(sources.rest)));
        }
        for (const Sun& sun : sources.suns) lights.push_back(std::make_shared<const SunLight>(device_, sun));
        found = split_.emplace(lookup, std::move(lights)).first;
    }
    return found->second;
}

const std::vector<Sun>& EnvironmentLight::sources(Lookup lookup) const {
    auto found = sources_.find(lookup);
    if (found == sources_.end()) found = sources_.emplace(lookup, bright_sources(map_, unit_, lookup)).first;
    return found->second;
}

const EnvironmentBandwidth& EnvironmentLight::bandwidth(BandRule rule) const {
    auto found = bandwidths_.find(rule);
    if (found == bandwidths_.end())
        found =
            bandwidths_.emplace(rule, lightband::environment_bandwidth(*device_, texture_, map_.height, rule)).first;
    return found->second;
}

const MapPoints& EnvironmentLight::points(Lookup lookup, uint32_t seed) const {
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

const FootprintLight& EnvironmentLight::footprints(Lookup lookup, FootprintLight::Kind kind) const {
    const auto key = std::pair(lookup, kind);
    auto found = footprints_.find(key);
    if (found == footprints_.end()) found = footprints_.emplace(key, footprint_light(*this, lookup, kind)).first;
    return found->second;
}

const LightAbove& EnvironmentLight::above(Lookup lookup) const {
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

size_t EnvironmentLight::device_bytes() const {
    size_t bytes = texture_.bytes() + points_.points.bytes() + points_.clusters.bytes();
    for (const auto& [rule, bandwidth] : bandwidths_) bytes += bandwidth.moments.bytes() + bandwidth.bandwidth.bytes();
    for (const auto& [key, footprints] : footprints_) bytes += footprints.texture.bytes();
    for (const auto& [lookup, lights] : split_)
        for (const auto& light : lights) bytes += light->device_bytes();
    for (const auto& [lookup, above] : above_) bytes += above.trunk.bytes() + above.parts.bytes();
    return bytes;
}

}  // namespace lightband
