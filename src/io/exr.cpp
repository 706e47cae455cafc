// OpenEXR pictures, through OpenEXR's C++ interface, from memory.
#include <ImfStandardAttributes.h>

#include <new>

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

    // A cube map is where its data are. Any other picture is what the display window shows; what of it has no data is black.
    const bool is_cube = Imf::hasEnvmap(header) && Imf::envmap(header) == Imf::ENVMAP_CUBE;
    const Imath::Box2i data = header.dataWindow(), window = is_cube ? data : header.displayWindow();
    RgbImage image = read_window(file, channels, bytes, name, window);
    if (data != window) {
        const auto words = [](const Imath::Box2i& w) {
            return text("(", w.min.x, ", ", w.min.y, ") to (", w.max.x, ", ", w.max.y, ")");
        };
        image.notes.push_back(text("its data window, ", words(data), ", is not its display window, ", words(window),
                                   ": what it has no data of is black, and what lies outside the display window is left out"));
    }
    if (is_cube) image = from_cube_map(image, name);
    if (conversion) convert_colours(*conversion, &image);
    return image;
}

// OpenEXR passes on that memory ran out as an exception of its own, with the text of the first one.
bool tells_of_memory(const std::exception& reason) {
    return std::string(reason.what()).find(std::bad_alloc().what()) != std::string::npos;
}

}  // namespace

// Where zlib gets no memory, OpenEXR says no more than that decompression failed, as of a damaged file. But a damaged file
// fails whenever it is read, and so it is read twice.
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
            if (!again) continue;
            // More than zlib asks for to decompress (zconf.h: 44 kB). Where this is not to be had, neither was that.
            constexpr size_t zlib_bytes = 1 << 16;
            const std::vector<uint8_t> probe(zlib_bytes);
            throw Error(LB_ERROR_FORMAT, text(name, ": OpenEXR cannot read it: ", reason.what()));
        }
    }
    throw Error(LB_ERROR_INTERNAL, "parse_exr: not reached");
}

}  // namespace lightband::io
