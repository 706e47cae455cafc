// What a frame asks of its lights, whatever kind they are of. A kind is one file here (environment, sun) beside one
// shader file of its name, and one line in lights/kinds.cpp.
//
// The shader of kind K defines, for the pass that it is compiled for (LightPass):
//     seen        vec3 K_seen(vec3 direction)             radiance from a direction of the world, for the background
//     predict     void K_predict(Point, inout Predicted)  its part of eq. 5, 6 and 9 (shaders/bandwidth.glsl)
//     classify    bool K_sets_between(vec3, vec3)         whether the light is cut off by the horizon of either normal
//     or lies between them shade       vec3 K_of_sample(...), K_prepare, K_samples (shaders/shade.glsl)
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gl/objects.h"
#include "picture/settings.h"

namespace lightband {

enum class LightPass { background, predict, classify, shade };

struct LightKind;

// One light of a scene, as numbers in double precision: for tests and the oracle, and to plan a frame.
class Light {
public:
    virtual ~Light() = default;

    virtual const LightKind& kind() const = 0;
    virtual const gl::DevicePtr& device() const = 0;

    // Radiance from a unit direction of the world.
    virtual Vec3 evaluate(const Vec3& direction, Lookup lookup) const = 0;
    // A direction chosen by two uniform numbers in [0, 1), and the density of that choice, per steradian.
    struct Sample {
        Vec3 direction;
        double pdf;
    };
    virtual Sample sample(const Vec2& u) const = 0;
    virtual double pdf(const Vec3& direction) const = 0;

    // The mean over all directions of its radiance (mean of RGB).
    virtual double power() const = 0;
    // The lights that stand for it in a frame; empty where it stands for itself.
    virtual std::vector<std::shared_ptr<const Light>> split(const Settings&) const { return {}; }
    // What it holds on the device.
    virtual size_t device_bytes() const = 0;
};

// What one frame's passes need of all its lights of one kind.
class LightGroup {
public:
    virtual ~LightGroup() = default;

    // Makes what the passes will read of the light, so that no pass pays for it that happens to come first.
    // points_seed: of directions that are drawn beforehand (Sampler::combined). shades: whether any pixel will be
    // shaded.
    virtual void prepare(const Settings& settings, uint32_t points_seed, bool shades) const = 0;
    // "NAME value" lines for the program of a pass.
    virtual std::string definitions(LightPass pass, const Settings& settings) const = 0;
    // Textures, uniform blocks and uniforms of that program.
    virtual void bind(LightPass pass, const Settings& settings, uint32_t points_seed,
                      const gl::Program& program) const = 0;
    // Whether prediction evaluates the lobe itself, rather than from the pilots' table alone; and whether shading wants
    // Material::bind_importance.
    virtual bool predicts_by_lobe() const = 0;
    virtual bool needs_importance(const Settings& settings) const = 0;
    // Iterations of loops that a sample takes in K_of_sample and K_samples, beyond eight.
    virtual uint32_t loops_per_sample() const { return 0; }
};

struct LightKind {
    const char* name;  // of its shader file, and the prefix of its functions
    // unit: the radiance that is 1 in shaders (Lights::unit).
    std::unique_ptr<LightGroup> (*group)(std::vector<std::shared_ptr<const Light>> lights, double unit);
};

}  // namespace lightband
