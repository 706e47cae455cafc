#include "materials/reflectance_curve.h"

#include <algorithm>

namespace lightband {

ReflectanceCurve reflectance_curve(const std::function<Spectrum(double)>& reflectance) {
    double saturation = 1.0;
    const ReflectanceCurve unbounded([&](double cosine) {
        const Vec3 rgb = spectrum_rgb(reflectance(cosine));
        saturation = std::min(saturation, saturation_within_unit_cube(rgb));
        return rgb;
    });
    return ReflectanceCurve([&](double cosine) {
        // The clamp takes away the rounding of the colour that set the saturation, and of white at grazing.
        return glm::clamp(with_saturation(unbounded(cosine), saturation), 0.0, 1.0);
    });
}

}  // namespace lightband
