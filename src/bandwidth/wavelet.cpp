#include "bandwidth/wavelet.h"

#include <algorithm>
#include <cmath>

namespace lightband {
namespace {

// Daubechies 1988, the orthonormal filter of four taps; the high pass is its alternating reverse.
const double root3 = std::sqrt(3.0);
const double low[4] = {(1 + root3) / (4 * std::sqrt(2.0)), (3 + root3) / (4 * std::sqrt(2.0)),
                       (3 - root3) / (4 * std::sqrt(2.0)), (1 - root3) / (4 * std::sqrt(2.0))};
const double high[4] = {low[3], -low[2], low[1], -low[0]};

// One level: a half-sized approximation and the largest detail of each of its texels.
void split(const SquareImage& image, const Border& border, SquareImage* smooth, SquareImage* detail) {
    for (int y = 0; y < smooth->size; ++y)
        for (int x = 0; x < smooth->size; ++x) {
            double ll = 0, lh = 0, hl = 0, hh = 0;
            for (int j = 0; j < 4; ++j)
                for (int i = 0; i < 4; ++i) {
                    int sx = 2 * x + i, sy = 2 * y + j;
                    if (sx >= image.size || sy >= image.size) border(image.size, sx, sy);
                    const double value = image.at(sx, sy);
                    ll += low[i] * low[j] * value;
                    lh += low[i] * high[j] * value;
                    hl += high[i] * low[j] * value;
                    hh += high[i] * high[j] * value;
                }
            smooth->at(x, y) = ll;
            detail->at(x, y) = std::max({std::abs(lh), std::abs(hl), std::abs(hh)});
        }
}

// The largest of the 3 x 3 coefficients whose support reaches the block of texel (x, y): supports of level k start at
// multiples of 2^k and are shorter than 3 * 2^k.
double reaching(const SquareImage& band, int x, int y, const Border& border) {
    double largest = 0;
    for (int j = -2; j <= 0; ++j)
        for (int i = -2; i <= 0; ++i) {
            int bx = x + i, by = y + j;
            if (bx < 0 || by < 0) border(band.size, bx, by);
            largest = std::max(largest, band.at(bx, by));
        }
    return largest;
}

}  // namespace

void octahedral_border(int side, int& x, int& y) {
    // A support may reach around a side of one or two texels more than once.
    while (x < 0 || x >= side) {
        x = x < 0 ? -1 - x : 2 * side - 1 - x;
        y = side - 1 - y;
    }
    while (y < 0 || y >= side) {
        y = y < 0 ? -1 - y : 2 * side - 1 - y;
        x = side - 1 - x;
    }
}

void periodic_border(int side, int& x, int& y) {
    x = (x % side + side) % side;
    y = (y % side + side) % side;
}

WaveletBands analyse(const SquareImage& image, const Border& border) {
    WaveletBands bands;
    bands.smooth = image;
    while (bands.smooth.size > 1) {
        const int half = bands.smooth.size / 2;
        SquareImage smooth(half), detail(half);
        split(bands.smooth, border, &smooth, &detail);
        bands.details.push_back(std::move(detail));
        bands.smooth = std::move(smooth);
    }
    return bands;
}

BandLimit band_limit(const double* maxima, int levels, double local_mean, BandRule rule) {
    // Called for each of millions of texels: it takes no memory.
    const auto weight = [&](int k) {
        // An orthonormal coefficient of level k + 1 carries 2^(k+1) times the amplitude.
        const double floor = rounding_floor * std::ldexp(local_mean, k + 1);
        const double value = maxima[k] > floor ? maxima[k] : 0;
        return rule == BandRule::sum ? value : value * value;
    };
    double largest = 0, total = 0;
    for (int k = 0; k < levels; ++k) {
        largest = std::max(largest, weight(k));
        total += weight(k);
    }
    if (largest == 0) return {0, false};
    const double negligible = rule == BandRule::sum ? sum_threshold * largest : (1 - energy_percentile) * total;
    double finer = 0;
    for (int k = 0; k < levels; ++k) {
        const double own = weight(k);
        if (finer + own >= negligible) {
            const double part = rule == BandRule::sum ? 0 : (negligible - finer) / own;
            return {std::exp2(-1 - k - part), k == 0};
        }
        finer += own;
    }
    return {0, false};
}

std::vector<BandLimit> local_band_limits(const WaveletBands& bands, int size, const Border& border, BandRule rule) {
    const int levels = int(bands.details.size());
    std::vector<SquareImage> maxima;
    for (const SquareImage& band : bands.details) {
        SquareImage reach(band.size);
        for (int y = 0; y < band.size; ++y)
            for (int x = 0; x < band.size; ++x) reach.at(x, y) = reaching(band, x, y, border);
        maxima.push_back(std::move(reach));
    }
    std::vector<BandLimit> limits(size_t(size) * size_t(size));
    std::vector<double> local(static_cast<size_t>(levels));
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            for (int k = 0; k < levels; ++k) local[size_t(k)] = maxima[size_t(k)].at(x >> (k + 1), y >> (k + 1));
            // The approximation of the last level is the local mean times 2^levels.
            const double mean = std::abs(std::ldexp(bands.smooth.at(x >> levels, y >> levels), -levels));
            limits[size_t(y) * size_t(size) + size_t(x)] = band_limit(local.data(), levels, mean, rule);
        }
    return limits;
}

}  // namespace lightband
