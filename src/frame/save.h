// A frame's fields on disk.
#pragma once

#include <string>

#include "frame/frame.h"

namespace lightband {

// path ends in .exr (fields: comma-separated names) or .png (color alone, sRGB after multiplication by 2^exposure).
void save(const Frame& frame, const std::string& path, const std::string& fields, float exposure);

}  // namespace lightband
