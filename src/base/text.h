// Building text from parts: text("width ", width, " exceeds the limit ", limit). The result is the whole text, or
// std::bad_alloc is thrown; a standard stream would swallow the exception and keep what it had written until then. The
// text is the same in every locale.
#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lightband {

// Numbers as printf's "%.9g" writes them: nine significant digits tell any two floats apart.
constexpr int significant_digits = 9;

namespace detail {

inline void append(std::string* out, std::string_view part) { out->append(part); }
inline void append(std::string* out, const char* part) { out->append(part); }
inline void append(std::string* out, const std::string& part) { out->append(part); }
inline void append(std::string* out, char part) { out->push_back(part); }

template <typename Number, typename = std::enable_if_t<std::is_arithmetic_v<Number>>>
void append(std::string* out, Number part) {
    static_assert(!std::is_same_v<Number, bool> && sizeof(Number) > 1, "convert it to the number or word meant");
    char digits[32];  // 2^64 has 20 digits; a double's sign, point, nine digits and exponent are 16 characters
    char* const end = digits + sizeof digits;
    std::to_chars_result written;
    if constexpr (std::is_floating_point_v<Number>)
        written = std::to_chars(digits, end, double(part), std::chars_format::general, significant_digits);
    else
        written = std::to_chars(digits, end, part);
    out->append(digits, written.ptr);
}

}  // namespace detail

template <typename... Parts>
std::string text(const Parts&... parts) {
    std::string out;
    (detail::append(&out, parts), ...);
    return out;
}

// The pieces between separators, in order: one more than there are separators. They point into the text.
inline std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> pieces;
    for (;;) {
        const size_t end = text.find(separator);
        pieces.push_back(text.substr(0, end));
        if (end == std::string_view::npos) return pieces;
        text.remove_prefix(end + 1);
    }
}

}  // namespace lightband
