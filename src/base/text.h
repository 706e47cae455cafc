// Building messages from parts: text("width ", width, " exceeds the limit ", limit).
#pragma once

#include <locale>
#include <sstream>
#include <string>

namespace lightband {

template <typename... Parts>
std::string text(const Parts&... parts) {
    std::ostringstream out;
    out.imbue(std::locale::classic());  // whatever the host's locale, numbers keep their points
    out.precision(9);
    (out << ... << parts);
    return out.str();
}

}  // namespace lightband
