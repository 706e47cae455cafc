// The n_b directions of eq. 5 and 9: chosen once per material and view by importance sampling, so that a pixel only has
// to turn them into its frame and look up the light.
#pragma once

#include <cstdint>
#include <vector>

#include "bandwidth/lobe_bandwidth.h"
#include "sampling/lobe_sampler.h"

namespace lightband {

// Drawn with density g: eq. 5's weights become lambda_i / g_i, and sums over uniform directions become sums over 1 / g_i.
struct Pilot {
    float half[3];         // half vector, local frame with wo at azimuth 0; wi is wo mirrored about it
    float weight;          // luminance of f cos(theta_i) / g: the part of L_i that reaches the eye
    float square;          // f^2 / (2 pi g), of f's luminance: chi_i^2 / L_i^2 averaged over uniform directions
    float lobe_bandwidth;  // rho at this pair of directions, cycles/radian
    float footprint;       // log2 of the solid angle that the pilot stands for, 1 / (n_b g), in steradians
    float pdf;             // g, per steradian
};

// LobeTable::views * count pilots, view by view.
std::vector<Pilot> pilots(const Brdf& brdf, const LobeSampler& sampler, const LobeBandwidth& bandwidth, uint32_t count);

}  // namespace lightband
