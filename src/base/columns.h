// Columns of printed tables.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace lightband {

inline std::string at_left(std::string_view text, size_t width) {
    return std::string(text).append(width - std::min(width, text.size()), ' ');
}
inline std::string at_right(std::string_view text, size_t width) {
    return std::string(width - std::min(width, text.size()), ' ').append(text);
}
inline std::string two_decimals(double value) {
    char digits[std::numeric_limits<double>::max_exponent10 +
                8];  // of the largest number, with sign, point and decimals
    return {digits, std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed, 2).ptr};
}
inline std::string megabytes(uint64_t bytes) {
    return at_right(two_decimals(double(bytes) / 1e6), 9) + " MB";
}

constexpr size_t pass_name_width = 12;

}  // namespace lightband
