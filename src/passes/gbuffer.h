// Section 3, "Render G-buffers": position, normal, depth and instance of what each pixel sees.
#pragma once

#include "frame/targets.h"
#include "scene/scene.h"

namespace lightband::passes {

void gbuffer(gl::Device& device, const Scene& scene, uint32_t width, uint32_t height, const GBuffer& target);

}  // namespace lightband::passes
