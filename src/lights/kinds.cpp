#include "lights/kinds.h"

#include <algorithm>
#include <cmath>

#include "lights/environment.h"
#include "lights/sun.h"

namespace lightband {
namespace {

// In the order in which passes ask them.
const LightKind* const kinds[] = {
    &EnvironmentLight::registered,
    &SunLight::registered,
};

}  // namespace

Lights::Lights(const std::vector<std::shared_ptr<const Light>>& of_scene, const Settings& settings) {
    std::vector<std::shared_ptr<const Light>> lights;
    for (const auto& light : of_scene) {
        const std::vector<std::shared_ptr<const Light>> parts = light->split(settings);
        if (parts.empty()) lights.push_back(light);
        lights.insert(lights.end(), parts.begin(), parts.end());
        if (!parts.empty()) split_ += parts.size() - 1;
    }
    double power = 0;
    for (const auto& light : lights) power += light->power();
    if (power > 0) unit_ = std::exp2(std::floor(std::log2(power)));
    for (const LightKind* kind : kinds) {
        std::vector<std::shared_ptr<const Light>> own;
        std::copy_if(lights.begin(), lights.end(), std::back_inserter(own),
                     [&](const auto& light) { return &light->kind() == kind; });
        if (!own.empty()) groups_.push_back({kind, kind->group(std::move(own), unit_)});
    }
}

void Lights::prepare(const Settings& settings, uint32_t points_seed, bool shades,
                     const std::function<void()>& made) const {
    for (const Group& group : groups_) {
        group.group->prepare(settings, points_seed, shades);
        made();
    }
}

// The functions of all kinds, added up: shaders call these macros. GLSL cannot join names, so they are written here.
std::string Lights::definitions(LightPass pass, const Settings& settings) const {
    std::string files = "LIGHT_FILES", own, seen = "vec3(0)", predict, sets_between = "false", of_sample = "vec3(0)",
                prepare, samples;
    for (const Group& group : groups_) {
        const std::string name = group.kind->name;
        files += " " + name + ".glsl";
        own += "\n" + group.group->definitions(pass, settings);
        seen += " + " + name + "_seen(direction)";
        predict += name + "_predict(point, sum); ";
        sets_between += " || " + name + "_sets_between(one, other)";
        of_sample += " + " + name + "_of_sample(pixel, wi, direction, density, footprints, wide)";
        prepare += name + "_prepare(pixel); ";
        samples += name + "_samples(pixel, each, sum, luminances, state); ";
    }
    const std::string lobe = predicts_by_lobe() ? "\nPREDICTS_BY_LOBE" : "";
    switch (pass) {
        case LightPass::background:
            return files + own + "\nPASS_BACKGROUND\nLIGHTS_SEEN(direction) (" + seen + ")";
        case LightPass::predict:
            return files + own + lobe + "\nPASS_PREDICT\nLIGHTS_PREDICT(point, sum) " + predict;
        case LightPass::classify:
            return files + own + "\nPASS_CLASSIFY\nLIGHTS_SET_BETWEEN(one, other) (" + sets_between + ")";
        case LightPass::shade:
            break;
    }
    return files + own + "\nPASS_SHADE\nLIGHTS_OF_SAMPLE(pixel, wi, direction, density, footprints, wide) (" +
           of_sample + ")\nLIGHTS_PREPARE(pixel) " + prepare +
           "\nLIGHTS_SAMPLES(pixel, each, sum, luminances, state) " + samples;
}

void Lights::bind(LightPass pass, const Settings& settings, uint32_t points_seed, const gl::Program& program) const {
    for (const Group& group : groups_) group.group->bind(pass, settings, points_seed, program);
}

bool Lights::predicts_by_lobe() const {
    return std::any_of(groups_.begin(), groups_.end(),
                       [](const Group& group) { return group.group->predicts_by_lobe(); });
}

bool Lights::needs_importance(const Settings& settings) const {
    return std::any_of(groups_.begin(), groups_.end(),
                       [&](const Group& group) { return group.group->needs_importance(settings); });
}

uint32_t Lights::loops_per_sample() const {
    uint32_t sum = 0;
    for (const Group& group : groups_) sum += group.group->loops_per_sample();
    return sum;
}

}  // namespace lightband
