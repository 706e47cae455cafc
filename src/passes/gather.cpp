#include "passes/gather.h"

#include "gl/dispatch.h"

namespace lightband::passes {

std::vector<Gathered> gather(gl::Device& device, const ShadingList& list, const Shading& shading,
                             const Prediction* prediction) {
    const gl::Functions& gl = device.gl();
    std::vector<Gathered> gathered(list.pixels);
    if (gathered.empty()) return gathered;
    const size_t bytes = gathered.size() * sizeof(Gathered);
    const gl::Buffer buffer(gl, bytes, nullptr);
    const gl::Program& program = device.compute("gather", prediction != nullptr ? "PREDICTED" : "");
    program.set("count", uint32_t(gathered.size()));
    program.use();
    bind_texture(gl, 0, list.entries_texture);
    bind_texture(gl, 1, shading.radiance);
    bind_texture(gl, 2, shading.spread);
    if (prediction != nullptr) bind_texture(gl, 3, prediction->prediction);
    bind_storage(gl, 0, buffer);
    gl.DispatchCompute(GLuint((gathered.size() + 63) / 64), 1, 1);
    gl.MemoryBarrier(everything);
    buffer.read(0, bytes, gathered.data());
    return gathered;
}

}  // namespace lightband::passes
