// The kinds of light that there are, and the lights of one frame: what passes ask, without knowing a kind.
#pragma once

#include "lights/light.h"

namespace lightband {

class Lights {
public:
    Lights(const std::vector<std::shared_ptr<const Light>>& of_scene, const Settings& settings);

    // How many lights were split off others.
    size_t split() const { return split_; }
    bool empty() const { return groups_.empty(); }
    // The radiance of a value of 1 in whatever shaders read and write: the power of two at or below the mean radiance
    // over the sphere, so that products of radiances near it stay far within the range of float, and no digit changes.
    // 1 where there is no light.
    double unit() const { return unit_; }

    // After each kind, `made` is called.
    void prepare(const Settings& settings, uint32_t points_seed, bool shades, const std::function<void()>& made) const;
    // What a shader that includes LIGHT_FILES is compiled for.
    std::string definitions(LightPass pass, const Settings& settings) const;
    void bind(LightPass pass, const Settings& settings, uint32_t points_seed, const gl::Program& program) const;
    bool predicts_by_lobe() const;
    bool needs_importance(const Settings& settings) const;
    uint32_t loops_per_sample() const;

private:
    struct Group {
        const LightKind* kind;
        std::unique_ptr<LightGroup> group;
    };
    std::vector<Group> groups_;
    double unit_ = 1;
    size_t split_ = 0;
};

}  // namespace lightband
