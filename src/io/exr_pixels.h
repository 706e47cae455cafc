// The texels of an EXR part.
#pragma once

#include <functional>

#include "base/image.h"
#include "io/exr_header.h"

namespace lightband::io {

// The layer's colours within a window, as stored but for what is named in the image's notes: what may be ringing of the
// compression is 0, and so are negative components of colours that came of chroma at half resolution. What the data
// window does not cover is black.
RgbImage read_window(Imf::MultiPartInputFile& file, const ColourChannels& channels, const std::vector<uint8_t>& bytes,
                     const std::string& name, const Imath::Box2i& window);

}  // namespace lightband::io
