// Section 3, "Render G-buffers": normal, depth and instance of what each pixel sees.
#pragma once

#include "assets/scene.h"
#include "picture/targets.h"

namespace lightband::passes {

void gbuffer(gl::Device& device, const Scene& scene, uint32_t width, uint32_t height, GBuffer* target);

// What shaders/surface.glsl and shaders/rays.glsl read.
void bind_surfaces(const gl::Functions& gl, const gl::Program& program, const GBuffer& gbuffer);
void set_rays(const gl::Program& program, const Camera::Rays& rays);

}  // namespace lightband::passes
