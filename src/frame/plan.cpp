#include "frame/plan.h"

#include <algorithm>
#include <limits>

#include "base/text.h"

namespace lightband {
namespace {

// Columns: what is shorter is filled with blanks.
std::string at_left(std::string_view text, size_t width) {
    return std::string(text).append(width - std::min(width, text.size()), ' ');
}
std::string at_right(std::string_view text, size_t width) {
    return std::string(width - std::min(width, text.size()), ' ').append(text);
}

std::string two_decimals(double value) {
    // Of the largest number with its sign, point and decimals.
    char digits[std::numeric_limits<double>::max_exponent10 + 8];
    return {digits, std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed, 2).ptr};
}

}  // namespace

void Plan::finished(const char* name, const std::string& reason, uint64_t bytes, uint64_t invocations, const char* unit) {
    gl_.Finish();
    const Clock::time_point now = Clock::now();
    const double spent = milliseconds(mark_, now);
    mark_ = now;
    // The passes of rounds and of accumulated frames repeat: each name keeps one line, with the last reason.
    const auto same = std::find_if(passes_.begin(), passes_.end(), [&](const Pass& pass) { return pass.name == name; });
    if (same == passes_.end()) {
        passes_.push_back({name, reason, spent, bytes, invocations, unit});
    } else {
        same->milliseconds += spent;
        same->reason = reason;
        same->invocations += invocations;
    }
}

void Plan::count(const char* name, uint64_t invocations) {
    for (Pass& pass : passes_)
        if (pass.name == name) pass.invocations = invocations;
}

double Plan::milliseconds_of(const std::vector<std::string>& names) const {
    double sum = 0;
    for (const Pass& pass : passes_)
        if (std::find(names.begin(), names.end(), pass.name) != names.end()) sum += pass.milliseconds;
    return sum;
}

std::string Plan::text() const {
    std::string out;
    for (const Pass& pass : passes_) {
        out += at_left(pass.name, 12) + at_right(two_decimals(pass.milliseconds), 10) + " ms ";
        out += at_right(two_decimals(double(pass.bytes) / 1e6), 9) + " MB ";
        out += at_right(lightband::text(pass.invocations), 12) + ' ' + at_left(pass.unit, 8) + "  ";
        out += pass.reason + '\n';
    }
    return out + at_left("total", 12) + at_right(two_decimals(total_milliseconds()), 10) + " ms\n";
}

}  // namespace lightband
