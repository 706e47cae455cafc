#include "frame/record.h"

#include <algorithm>

#include "base/columns.h"
#include "base/text.h"

namespace lightband {

void Record::add(std::string_view name, Done done, double milliseconds) {
    auto entry = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& each) { return each.name == name; });
    if (entry == entries_.end()) entry = entries_.insert(entries_.end(), {std::string(name), "", done.unit});
    entry->milliseconds += milliseconds;
    entry->invocations += done.invocations;
    entry->note = std::move(done.note);
}

void Record::count(std::string_view name, uint64_t invocations) {
    for (Entry& entry : entries_)
        if (entry.name == name) entry.invocations = invocations;
}

double Record::milliseconds_of(std::string_view name) const {
    for (const Entry& entry : entries_)
        if (entry.name == name) return entry.milliseconds;
    return 0;
}

std::string Record::text(const Plan& plan, double total, bool timed) const {
    std::string out;
    const auto time = [](double milliseconds) { return at_right(two_decimals(milliseconds), 10) + " ms "; };
    for (const PlannedPass& pass : plan.passes())
        for (const Entry& entry : entries_) {
            if (entry.name != pass.name) continue;
            out += at_left(entry.name, pass_name_width) + (timed ? time(entry.milliseconds) : std::string()) +
                   megabytes(pass.bytes);
            out += at_right(lightband::text(entry.invocations), 12) + ' ' + at_left(entry.unit, 8) + "  " + pass.reason;
            out += (entry.note.empty() ? "" : "; " + entry.note) + '\n';
        }
    return out + at_left("total", pass_name_width) + time(total) + '\n';
}

}  // namespace lightband
