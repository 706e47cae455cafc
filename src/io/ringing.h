// Negative values that a lossy compression makes of light.
#pragma once

#include <ImfChannelList.h>
#include <ImfCompression.h>

#include <cstddef>

namespace lightband::io {

// What a compression may have made of values that were not negative.
class Ringing {
public:
    // single: the part is read through one channel, Y, rather than R, G, B.
    Ringing(Imf::Compression compression, const Imf::Channel& channel, bool single);

    // Sets what may be ringing to 0 in a chunk of width x height RGB texels.
    void remove(float* rgb, size_t width, size_t height);

    size_t count() const { return count_; }
    float least() const { return least_; }

private:
    enum class Limit { none, fixed, block };
    float block_limit(const float* rgb, size_t row, size_t width, size_t height) const;
    void clear(float* rgb, size_t row, size_t width, size_t height, float limit);

    Limit kind_ = Limit::none;
    float fixed_ = 0;
    float factor_ = 0;  // of the largest value of a block
    size_t count_ = 0;
    float least_ = 0;
};

}  // namespace lightband::io
