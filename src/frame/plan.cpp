#include "frame/plan.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace lightband {

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
    std::ostringstream out;
    out << std::fixed;
    for (const Pass& pass : passes_)
        out << std::left << std::setw(12) << pass.name << std::right << std::setw(10) << std::setprecision(2)
            << pass.milliseconds << " ms " << std::setw(9) << std::setprecision(2) << double(pass.bytes) / 1e6 << " MB "
            << std::setw(12) << pass.invocations << ' ' << std::left << std::setw(8) << pass.unit << "  " << pass.reason << '\n';
    out << std::left << std::setw(12) << "total" << std::right << std::setw(10) << std::setprecision(2)
        << total_milliseconds() << " ms\n";
    return out.str();
}

}  // namespace lightband
