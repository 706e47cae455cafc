// A frame's fields on disk.
#pragma once

#include <string>

#include "frame/frame.h"
#include "io/display.h"

namespace lightband {

// path ends in .exr (fields: comma-separated names) or .png (color alone, as display says).
void save(const Frame& frame, const std::string& path, const std::string& fields, const io::Display& display);

}  // namespace lightband
