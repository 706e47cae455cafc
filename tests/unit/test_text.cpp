// Text from parts: numbers look as printf's "%.9g" writes them, and nothing is lost.
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "base/text.h"
#include "io_testing.h"

namespace {

using namespace lightband;

void parts_follow_each_other(void**) {
    const std::string name = "map.exr";
    const std::string whole = text(name, ": ", size_t(3), " of ", -4, ' ', std::string_view("x|y").substr(0, 1), "");
    assert_string_equal(whole.c_str(), "map.exr: 3 of -4 x");
    assert_string_equal(text().c_str(), "");
    assert_string_equal(text(std::numeric_limits<int64_t>::min(), " ", std::numeric_limits<uint64_t>::max()).c_str(),
                        "-9223372036854775808 18446744073709551615");
}

void check_number(double value) {
    char expected[64];
    std::snprintf(expected, sizeof expected, "%.9g", value);  // the tests run in the C locale
    assert_string_equal(text(value).c_str(), expected);
    std::snprintf(expected, sizeof expected, "%.9g", double(float(value)));
    assert_string_equal(text(float(value)).c_str(), expected);
}

void numbers_have_nine_digits(void**) {
    constexpr double smallest = std::numeric_limits<double>::denorm_min(), largest = std::numeric_limits<double>::max();
    for (const double value : {0.0, -0.0, 1.0, 0.1, 100000.0, 1e9, 1e10, 1e-5, smallest, largest, -2.5, 1.0 / 3})
        check_number(value);
    check_number(std::numeric_limits<double>::infinity());
    check_number(-std::numeric_limits<double>::infinity());
    check_number(std::numeric_limits<double>::quiet_NaN());
    std::mt19937_64 random(5);
    for (int i = 0; i < 10000; ++i) {
        const double value = std::ldexp(double(random()), int(random() % 240) - 180);
        check_number(i % 2 == 0 ? value : -value);
    }
}

void a_text_is_split_at_every_separator(void**) {
    const auto pieces = [](const char* whole) {
        std::string all;
        for (const std::string_view piece : split(whole, ',')) all += text("<", piece, ">");
        return all;
    };
    assert_string_equal(pieces("a,bc,d").c_str(), "<a><bc><d>");
    assert_string_equal(pieces("").c_str(), "<>");
    assert_string_equal(pieces(",a,").c_str(), "<><a><>");
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(parts_follow_each_other),
        cmocka_unit_test(numbers_have_nine_digits),
        cmocka_unit_test(a_text_is_split_at_every_separator),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
