#include "passes/foresee.h"

#include <algorithm>

#include "gl/dispatch.h"
#include "passes/gbuffer.h"
#include "passes/uniforms.h"

namespace lightband::passes {
namespace {

constexpr double most_units = 1u << 30;  // of all squared errors, each of tolerance^2 at most, in sums of 32 bits

}  // namespace

std::vector<ForeseenTile> foresee(gl::Device& device, size_t slots, const std::vector<Lamp>& lamps, const Forecast& forecast,
                                  double tolerance, const SlotTable& slot_of, const Covered& covered, const GBuffer& gbuffer,
                                  const Prediction& prediction, uint32_t stride) {
    const gl::Functions& gl = device.gl();
    const MirrorCells& mirrors = *prediction.mirrors;
    struct Sums {
        uint32_t squares, interpolated, shaded, unused;
    };
    std::vector<Sums> sums(slots * MirrorCells::tiles);
    const gl::Buffer buffer(gl, std::max<size_t>(sums.size(), 1) * sizeof(Sums), nullptr);
    buffer.clear();
    const float units = float(most_units / (tolerance * tolerance * (covered.all.count / stride + 1)));
    const gl::Program& program = device.compute("foresee", mirrors.definitions() + "\nSTRIDE" + lamp_definitions(lamps));
    set_lamps(program, lamps);
    program.set("units", units);
    program.set("tolerance", float(tolerance));
    program.set("mean_radiance", float(forecast.mean_radiance));
    program.use();
    bind_surfaces(gl, program, gbuffer);
    bind_texture(gl, 2, gbuffer.material);
    bind_texture(gl, 3, slot_of.texture);
    bind_texture(gl, 5, prediction.prediction);
    bind_texture(gl, 8, mirrors.cells);
    bind_texture(gl, 9, mirrors.claims.texture);
    bind_texture(gl, 11, mirrors.occupants.texture);
    bind_texture(gl, 12, mirrors.mirrors.texture);
    bind_storage(gl, 0, buffer);
    dispatch_covered(gl, program, covered, covered.all, stride);
    buffer.read(0, sums.size() * sizeof(Sums), sums.data());
    std::vector<ForeseenTile> tiles;
    for (const Sums& sum : sums)
        tiles.push_back({double(stride) * sum.interpolated, double(stride) * sum.shaded, double(stride) * sum.squares / units});
    return tiles;
}

}  // namespace lightband::passes
