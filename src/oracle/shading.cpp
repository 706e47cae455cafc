#include "oracle/shading.h"

#include <cmath>

#include "scene/environment.h"

namespace lightband {

Vec3 reflected_radiance(const Brdf& brdf, const RgbImage& map, const ShadingPoint& point,
                        const OracleSettings& settings) {
    const Frame3 frame(point.normal, point.wo);
    const Vec3 wo = frame.to_local(point.wo);
    const int rows = settings.rows, columns = 2 * rows;
    Vec3 sum(0);
    for (int y = 0; y < rows; ++y) {
        const double top = (0.5 - double(y) / rows) * pi, bottom = (0.5 - (y + 1.0) / rows) * pi;
        const double solid_angle = 2 * pi / columns * (std::sin(top) - std::sin(bottom));
        for (int x = 0; x < columns; ++x) {
            const Vec3 world = direction_of(Vec2((x + 0.5) / columns, (y + 0.5) / rows));
            const Vec3 wi = frame.to_local(world);
            if (wi.z <= 0) continue;
            sum += evaluate(brdf, wi, wo, settings.brdf_lookup) *
                   radiance(map, world, settings.environment_lookup) * (wi.z * solid_angle);
        }
    }
    return sum;
}

}  // namespace lightband
