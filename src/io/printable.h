// Words of an untrusted file, made fit for a message.
#pragma once

#include <string>
#include <string_view>

namespace lightband::io {

// The first 200 characters; whatever is not printable ASCII shows as '?'.
inline std::string printable(std::string_view words) {
    constexpr size_t longest = 200;
    std::string shown(words.substr(0, longest));
    for (char& c : shown)
        if (c < ' ' || c > '~') c = '?';
    if (words.size() > longest) shown += "...";
    return shown;
}

}  // namespace lightband::io
