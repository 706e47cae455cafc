#include "io/ringing.h"

#include <algorithm>
#include <cmath>

namespace lightband::io {
namespace {

// B44 and B44A keep 4 x 4 halfs as 6-bit differences from the largest, in units of 2^s of the halfs' bits read as integers
// (ImfB44Compressor.cpp). Halfs that are not negative span at most 0x7bff, which needs s = 10: rounding errs by at most
// 2^(s-1) = 512, and 512 below the bits of +0 lies the half -512 * 2^-24.
constexpr float b44_limit = 512.0f / (1 << 24);
// Of a channel marked "pLinear" it keeps exp(x / 8), at least 1, whose bits are 2^-11 apart below 1: 8 ln(1 - 512 * 2^-11).
const float b44_linear_limit = -8 * std::log(1 - 512.0f / 2048);

// DWAA and DWAB round the cosine transform of 8 x 8 texels (ImfDwaCompressor.cpp). How coarsely is not in the file, but
// no coefficient errs by more than itself, so that the error is bounded by the block's own values: R and B are
// Y + 1.5747 Cr and Y + 1.8556 Cb, and where no value exceeds m, luma errs by at most m, and a chroma, which is between
// -m/2 and m/2, by at most m/2.
constexpr size_t dwa_block = 8;
constexpr float dwa_error = 1 + 1.8556f / 2;
// All this holds of the values to the power of 1 / 2.2, which is what is transformed of values up to 1. (Of larger ones it
// is a logarithm, in which the same error would be wider; the limit does not follow it there.)
constexpr float dwa_exponent = 2.2f;

}  // namespace

Ringing::Ringing(Imf::Compression compression, const Imf::Channel& channel, bool single) {
    const bool is_b44 = compression == Imf::B44_COMPRESSION || compression == Imf::B44A_COMPRESSION;
    const bool is_dwa = compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
    if (is_b44 && channel.type == Imf::HALF) {
        kind_ = Limit::fixed;
        fixed_ = channel.pLinear ? b44_linear_limit : b44_limit;
    }
    if (is_dwa && channel.type != Imf::UINT) kind_ = Limit::block;
    factor_ = single && channel.pLinear ? dwa_error : std::pow(dwa_error, dwa_exponent);
}

void Ringing::remove(float* rgb, size_t width, size_t height) {
    if (kind_ == Limit::none) return;
    if (kind_ == Limit::fixed) return clear(rgb, width, width, height, fixed_);
    for (size_t y = 0; y < height; y += dwa_block)
        for (size_t x = 0; x < width; x += dwa_block) {
            float* const block = rgb + (y * width + x) * 3;
            const size_t columns = std::min(dwa_block, width - x), rows = std::min(dwa_block, height - y);
            clear(block, width, columns, rows, block_limit(block, width, columns, rows));
        }
}

float Ringing::block_limit(const float* rgb, size_t row, size_t width, size_t height) const {
    float most = 0;
    for (size_t y = 0; y < height; ++y)
        for (size_t i = 0; i < width * 3; ++i)
            if (const float value = rgb[y * row * 3 + i]; std::isfinite(value)) most = std::max(most, value);
    return factor_ * most;
}

void Ringing::clear(float* rgb, size_t row, size_t width, size_t height, float limit) {
    for (size_t y = 0; y < height; ++y)
        for (size_t i = 0; i < width * 3; ++i) {
            float& value = rgb[y * row * 3 + i];
            if (!(value < 0 && value >= -limit)) continue;
            least_ = std::min(least_, value);
            value = 0;
            ++count_;
        }
}

}  // namespace lightband::io
