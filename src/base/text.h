// Building messages from parts: text("width ", width, " exceeds the limit ", limit).
#pragma once

#include <sstream>
#include <string>

namespace lightband {

template <typename... Parts>
std::string text(const Parts&... parts) {
    std::ostringstream out;
    out.precision(9);
    (out << ... << parts);
    return out.str();
}

}  // namespace lightband
