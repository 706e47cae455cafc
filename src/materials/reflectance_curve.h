// The colour of a reflection against the cosine of its angle of incidence.
#pragma once

#include <functional>

#include "materials/cosine_curve.h"
#include "materials/spectrum.h"

namespace lightband {

using ReflectanceCurve = CosineCurve<Vec3>;

// RGB in [0, 1]. Colours that Rec. 709 cannot show are brought in by one saturation for all angles, the largest that
// fits: luminance and hue are kept at each angle, and no bend comes into the curve where the spectrum has none.
ReflectanceCurve reflectance_curve(const std::function<Spectrum(double cos_incident)>& reflectance);

}  // namespace lightband
