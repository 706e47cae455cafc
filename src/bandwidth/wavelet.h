// Local bandwidth of a square picture by Daubechies-4 wavelets: section 2.3 of Bagher et al. 2013 and appendix A of the
// report of 2012. This is the double-precision form; shaders/environment_*.glsl do the same for maps on the GPU.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace lightband {

struct SquareImage {
    int size = 0;
    std::vector<double> values;  // size * size, rows top-down

    explicit SquareImage(int side = 0) : size(side), values(size_t(side) * size_t(side)) {}
    double& at(int x, int y) { return values[size_t(y) * size_t(size) + size_t(x)]; }
    double at(int x, int y) const { return values[size_t(y) * size_t(size) + size_t(x)]; }
};

// How a picture goes on beyond its edge; given a position outside a side x side picture, returns one inside.
using Border = std::function<void(int side, int& x, int& y)>;
void octahedral_border(int side, int& x, int& y);  // across an edge lies the same edge, mirrored about its middle
void periodic_border(int side, int& x, int& y);

// The bands of a transform. details[k]: the largest magnitude of the three detail coefficients (horizontal, vertical,
// diagonal; orthonormal) of level k + 1, side size >> (k + 1). smooth: the remaining approximation.
struct WaveletBands {
    std::vector<SquareImage> details;
    SquareImage smooth;
};

// size must be a power of two; goes down to a single texel.
WaveletBands analyse(const SquareImage& image, const Border& border);

// Which bands count. The paper states two rules that differ. sum (eq. 7): the finest band from which on the sum of maxima
// reaches 1 % of the largest maximum; its fine end is the bandwidth. energy (figure 6): the 95th percentile of the energy,
// taken as spread evenly over the logarithm of frequency within its band, so that the result has no steps.
enum class BandRule { sum, energy };

struct BandLimit {
    double frequency;  // cycles per texel, at most 0.5; 0 where nothing but the rounding of float input is left
    bool open;         // the finest level counts: the true limit may lie beyond what the texels can show
};
BandLimit band_limit(const double* maxima, int levels, double local_mean, BandRule rule);

// band_limit at every texel, from the coefficients whose support holds it.
std::vector<BandLimit> local_band_limits(const WaveletBands& bands, int size, const Border& border, BandRule rule);

// eq. 7's epsilon, and figure 6's percentile.
constexpr double sum_threshold = 0.01;
constexpr double energy_percentile = 0.95;
// A coefficient below this part of the local mean is rounding: pictures come as float (2^-24), a four-tap transform over
// ten levels adds up to about forty of those.
constexpr double rounding_floor = 1.0 / (1 << 18);

}  // namespace lightband
