// Constants that bench/constants.py changes while the library runs, in a build with LIGHTBAND_STUDY: included by
// picture/constants.h.
#pragma once

#include <cstdlib>
#include <map>
#include <string>

namespace lightband::constants {

struct Studied {
    double* place;
    double standard;
};
inline std::map<std::string, Studied>& studied() {
    static std::map<std::string, Studied> all;
    return all;
}
inline double studied_constant(const char* name, double* place, double standard) {
    studied()[name] = {place, standard};
    return standard;
}

// Before a frame: all constants are as in the table, but for the one that the environment variable LIGHTBAND_CONSTANT
// names, "name=value".
inline void choose_studied() {
    for (const auto& [name, constant] : studied()) *constant.place = constant.standard;
    const char* const chosen = std::getenv("LIGHTBAND_CONSTANT");
    if (chosen == nullptr) return;
    const std::string text = chosen;
    const size_t equals = text.find('=');
    if (equals == std::string::npos) return;
    const auto found = studied().find(text.substr(0, equals));
    if (found != studied().end()) *found->second.place = std::atof(text.c_str() + equals + 1);
}

}  // namespace lightband::constants

#define LIGHTBAND_CONSTANT(name, standard) inline double name = studied_constant(#name, &name, standard)
