// PNG writing through libpng's simplified interface, which keeps its error jumps to itself.
#include <png.h>

#include <new>

#include "base/error.h"
#include "io/file.h"
#include "io/image_file.h"

namespace lightband::io {

void write_png(const std::string& path, uint32_t width, uint32_t height, const std::vector<uint8_t>& rgba) {
    if (width == 0 || height == 0 || rgba.size() != size_t(width) * height * 4)
        throw Error(LB_ERROR_INVALID_ARGUMENT, text(path, ": ", rgba.size(), " bytes given for a picture of ", width,
                                                    " x ", height, " RGBA pixels"));
    constexpr uint32_t largest = 1000000;  // libpng's own limit: PNG_USER_WIDTH_MAX, PNG_USER_HEIGHT_MAX
    if (width > largest || height > largest)
        throw Error(LB_ERROR_FILE, text(path, ": a PNG of ", width, " x ", height, " pixels exceeds the limit of ", largest,
                                        " on a side"));
    png_image image = {};
    image.version = PNG_IMAGE_VERSION;
    image.width = width;
    image.height = height;
    image.format = PNG_FORMAT_RGBA;  // 8 bits, encoded as sRGB; libpng then writes the sRGB chunk

    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::vector<uint8_t> bytes(size);
    constexpr int already_eight_bits = 0;
    constexpr png_int_32 tightly_packed_rows = 0;
    if (!png_image_write_to_memory(&image, bytes.data(), &size, already_eight_bits, rgba.data(), tightly_packed_rows,
                                   nullptr))
        throw std::bad_alloc();  // from memory to memory, of a size that was checked: nothing else can have been missing
    bytes.resize(size);
    write_file(path, bytes);
}

}  // namespace lightband::io
