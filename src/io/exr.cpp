// OpenEXR pictures, through OpenEXR's C++ interface, from memory.
#include <ImfStandardAttributes.h>

#include <new>
#include <string_view>

#include "base/error.h"
#include "io/cube_map.h"
#include "io/exr_header.h"
#include "io/exr_pixels.h"
#include "io/exr_streams.h"
#include "io/image_file.h"

namespace lightband::io {
namespace {

RgbImage read_layer(const std::vector<uint8_t>& bytes, const std::string& name, const std::string& layer) {
    check_attribute_sizes(bytes, name);
    BytesIn stream(bytes, name);
    constexpr bool mend_chunk_table = false;  // an incomplete file is an error, not something to make the best of
    Imf::MultiPartInputFile file(stream, no_threads, mend_chunk_table);
    const ColourChannels channels = find_colour(file, layer, name);
    const Imf::Header& header = file.header(channels.part);
    check_sizes(header, bytes.size(), name);
    const std::optional<glm::dmat3> conversion = colour_conversion(header, name);

    // A cube map is where its data are. Any other picture is what the display window shows; what of it has no data is
    // black.
    const bool is_cube = Imf::hasEnvmap(header) && Imf::envmap(header) == Imf::ENVMAP_CUBE;
    const Imath::Box2i data = header.dataWindow(), window = is_cube ? data : header.displayWindow();
    RgbImage image = read_window(file, channels, bytes, name, window);
    if (data != window) {
        const auto words = [](const Imath::Box2i& w) {
            return text("(", w.min.x, ", ", w.min.y, ") to (", w.max.x, ", ", w.max.y, ")");
        };
        image.notes.push_back(
            text("its data window, ", words(data), ", is not its display window, ", words(window),
                 ": what it has no data of is black, and what lies outside the display window is left out"));
    }
    if (is_cube) image = from_cube_map(image, name);
    if (conversion) convert_colours(*conversion, &image);
    return image;
}

bool ends_in(std::string_view words, std::string_view end) {
    return words.size() >= end.size() && words.substr(words.size() - end.size()) == end;
}

// OpenEXR reports that memory ran out by exceptions of its own. They end in the words of the std::bad_alloc that it
// caught, or in those of its ScanLineInputFile.
bool tells_of_memory(const std::exception& reason) {
    return ends_in(reason.what(), std::bad_alloc().what()) ||
           ends_in(reason.what(), "Failed to allocate memory for scanline buffers");
}

}  // namespace

// Where zlib gets no memory, OpenEXR says no more than that decompression failed, as of a damaged file. If memory is
// still short right after that, read_window throws std::bad_alloc. If not, another thread has released some in the
// meantime, and the second attempt succeeds: it fails only with a damaged file.
RgbImage parse_exr(const std::vector<uint8_t>& bytes, const std::string& name, const std::string& layer) {
    for (bool again : {false, true}) {
        try {
            return read_layer(bytes, name, layer);
        } catch (const Error&) {
            throw;
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const std::exception& reason) {
            if (tells_of_memory(reason)) throw std::bad_alloc();
            if (again) throw Error(LB_ERROR_FORMAT, text(name, ": OpenEXR cannot read it: ", reason.what()));
        }
    }
    throw Error(LB_ERROR_INTERNAL, "parse_exr: not reached");
}

}  // namespace lightband::io
