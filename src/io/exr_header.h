// What an EXR file's headers say: where its colours are, how large it is, what its values mean.
#pragma once

#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>

#include <optional>
#include <string>
#include <vector>

#include "io/colour_space.h"

namespace lightband::io {

enum class Colour { none, rgb, grey, luminance_chroma };

// Where the colours of a layer are: a part of the file, and the channels "<layer>.R" and so on, or "R" where layer is "".
struct ColourChannels {
    int part = 0;
    Colour colour = Colour::none;
    std::string layer;

    std::string channel(const char* component) const { return layer.empty() ? component : layer + '.' + component; }
};

// The channels of the layer, or the part, of that name; of the first part with colour where layer is "".
// LB_ERROR_FORMAT where there is none; the message lists what there is.
ColourChannels find_colour(const Imf::MultiPartInputFile& file, const std::string& layer, const std::string& name);

// OpenEXR reserves an attribute's announced size, up to 2 GiB, before it looks whether the file holds as much. This
// walk over the headers looks first.
void check_attribute_sizes(const std::vector<uint8_t>& bytes, const std::string& name);

// Checks the sizes of windows, tiles and chunks before OpenEXR or the library reserve memory in proportion to them.
void check_sizes(const Imf::Header& header, size_t file_bytes, const std::string& name);

// Lines that are compressed together ("OpenEXR File Layout", "Scan Line Blocks").
int lines_per_chunk(Imf::Compression compression);

// How the values convert to Rec. 709; nothing where they are in it.
std::optional<glm::dmat3> colour_conversion(const Imf::Header& header, const std::string& name);

}  // namespace lightband::io
