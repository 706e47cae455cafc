// What the tests of the renderer share: scenes by software rendering, fields as vectors.
#pragma once

#include <cmath>
#include <string>
#include <vector>

// The library's own headers first: the wrapper gives the names Brdf and Frame a second meaning.
// clang-format off
#include "numeric_testing.h"
#include "oracle/shading.h"
#include "scene/environment.h"
#include "lightband/lightband.hpp"
// clang-format on

namespace lightband::testing {

// One context for a whole program: making one takes longer than most of its frames.
inline const Context& software() {
    static const Context context({LB_DEVICE_SOFTWARE, "", nullptr});
    return context;
}

template <class Element>
std::vector<Element> field(const Frame& frame, const char* name) {
    const Buffer buffer = frame.map(name);
    size_t count = 1;
    for (uint32_t i = 0; i < buffer.view().dimensions; ++i) count *= size_t(buffer.view().shape[i]);
    const Element* first = buffer.data<Element>();
    return std::vector<Element>(first, first + count);
}

inline Vec3 vector_at(const std::vector<float>& values, size_t i, size_t components = 3) {
    return {values[components * i], values[components * i + 1], values[components * i + 2]};
}

// Luminance of every pixel.
inline std::vector<double> luminances(const Frame& frame) {
    const std::vector<float> color = field<float>(frame, "color");
    std::vector<double> result(color.size() / 4);
    for (size_t i = 0; i < result.size(); ++i) result[i] = luminance(vector_at(color, i, 4));
    return result;
}

inline std::vector<size_t> covered_pixels(const Frame& frame) {
    const std::vector<uint8_t> material = field<uint8_t>(frame, "material");
    std::vector<size_t> covered;
    for (size_t i = 0; i < material.size(); ++i)
        if (material[i] != 0) covered.push_back(i);
    return covered;
}

// Another colour everywhere, smooth but for a patch of 45 degrees that is ten times as bright.
inline RgbImage patched_map(uint32_t width, uint32_t height) {
    RgbImage map{width, height, {}};
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const double u = (x + 0.5) / width, v = (y + 0.5) / height;
            const bool bright = u > 0.125 && u < 0.25 && v > 0.25 && v < 0.5;
            const double light = bright ? 6 : 0.6 + 0.4 * std::sin(2 * pi * u + 1) * std::sin(pi * v);
            map.rgb.insert(map.rgb.end(), {float(light), float(light * (0.5 + 0.5 * v)), float(light * (1 - 0.5 * v))});
        }
    return map;
}

inline RgbImage constant_map(float radiance) {
    return {8, 4, std::vector<float>(8 * 4 * 3, radiance)};
}

inline Environment environment(const RgbImage& map) {
    return software().environment(map.width, map.height, map.rgb.data());
}

constexpr float eye[3] = {0.5f, 0.6f, 1.4f};  // the shapes fill most of the picture

// A shape of half a metre's radius, all lengths multiplied by scale.
inline Scene scene_of(const char* shape, const wrapper::Brdf& brdf, const Environment& light, float scale = 1) {
    Scene scene = software().scene();
    scene.add(software().builtin_mesh(shape), brdf, Transform{scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0});
    scene.set_environment(light);
    scene.set_camera({{scale * eye[0], scale * eye[1], scale * eye[2]}});
    return scene;
}

inline Frame reference_frame(uint32_t side, double samples, double seed = 0) {
    Frame frame = software().frame(side, side);
    frame.set("method", "reference");
    frame.set("samples", samples);
    frame.set("seed", seed);
    return frame;
}

}  // namespace lightband::testing
