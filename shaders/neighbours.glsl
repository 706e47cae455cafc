// From which pixels, and with what weights, a pixel is interpolated over directions: a plane fitted to those in the cells around its own.
#include "mirrors.glsl"

layout(binding = 11) uniform usamplerBuffer occupants;
layout(binding = 12) uniform usamplerBuffer mirrors;  // of each covered pixel

const int around = 9;  // cells: the pixel's own and those beside it

struct Neighbours {
    ivec2 at[around];
    float weight[around];    // sum 1; 0: nobody there
    bool sound;              // enough of them, and noise is not amplified
    float expected, between; // by the pilots: of the pixel, and between its neighbours
};

// Radiance changes with the mirror direction as highlights do and with the normal as diffuse light does: a step of one counts so
// much beside one of the other (docs/decisions/0012).
const float normal_share = 0.5;
// Neighbours count within so many widths of a cell; beyond, by a trace, so that lone ones are heard.
const float kernel_width = 1.5, trace = 1e-3;
// Where neighbours do not tell a slope (they lie in a row, or all in one place), it is taken to be small: of the square of the kernel's
// width.
const float flatness = 0.002;
const int fewest_neighbours = 4;
// Of the squared noise of one neighbour: a fit that would show more than that extrapolates.
const float most_noise = 2.0;

// The cell that lies there, where one next to the square may be outside it (octahedral_border for a single step).
ivec2 wrapped(ivec2 cell, int side) {
    ivec2 inside = clamp(cell, ivec2(0), ivec2(side - 1));
    if (inside.x != cell.x) inside.y = side - 1 - inside.y;
    return inside.y != cell.y && inside.x == cell.x ? ivec2(side - 1 - inside.x, inside.y) : inside;
}

Neighbours neighbours_of(uint place, uint word, uint slot) {
    int level = level_of(word);
    ivec2 cell = cell_of(word);
    Mirror here = mirror_of(texelFetch(mirrors, int(place)));
    // Steps of a direction and of the normal, across the plane of reflection and along it.
    vec3 across = cross(here.normal, here.direction), other = abs(here.normal.x) < 0.5 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    across = normalize(dot(across, across) > 1e-10 ? across : cross(here.normal, other));
    vec3 along = cross(across, here.direction);
    vec3 normal_along = normal_share * cross(across, here.normal), normal_across = normal_share * across;
    float per_width = 1.0 / (kernel_width * cell_width(here.direction, level));

    Neighbours result;
    vec4 steps[around], mean = vec4(0);
    float expected[around], sum = 0.0;
    int found = 0;
    for (int k = 0; k < around; ++k) {
        uint occupant = texelFetch(occupants, cell_index(slot, level, wrapped(cell + ivec2(k % 3, k / 3) - 1, 1 << level))).r;
        Mirror there = mirror_of(texelFetch(mirrors, int(occupant & place_mask)));
        vec3 turned = (there.direction - here.direction) * per_width, tilted = (there.normal - here.normal) * per_width;
        float squared = dot(turned, turned) + normal_share * normal_share * dot(tilted, tilted), near = max(1.0 - squared, 0.0);
        bool missing = occupant == 0u || (occupant & place_mask) == place;
        float weight = missing ? 0.0 : near * near + trace / (1.0 + squared);
        result.at[k] = there.at;
        expected[k] = there.expected;
        result.weight[k] = weight;
        steps[k] = vec4(dot(turned, across), dot(turned, along), dot(tilted, normal_across), dot(tilted, normal_along));
        sum += weight;
        mean += weight * steps[k];
        found += missing ? 0 : 1;
    }
    float per_sum = sum > 0.0 ? 1.0 / sum : 0.0;
    mean *= per_sum;
    mat4 spread = mat4(flatness);
    for (int k = 0; k < around; ++k) {
        vec4 off = steps[k] - mean;
        spread += outerProduct(off, off) * (result.weight[k] * per_sum);
    }
    // The value at the pixel of the plane that fits best: of each neighbour, so much.
    vec4 slope = inverse(spread) * mean;
    float noise = 0.0;
    result.expected = here.expected;
    result.between = 0.0;
    for (int k = 0; k < around; ++k) {
        result.weight[k] *= per_sum * (1.0 - dot(slope, steps[k] - mean));
        noise += result.weight[k] * result.weight[k];
        result.between += result.weight[k] * expected[k];
    }
    result.sound = found >= fewest_neighbours && noise <= most_noise;
    return result;
}
