// A map whose lossy compression rings: black with bright points. OpenEXR writes it.
#include <ImfRgbaFile.h>

#include <vector>

// For test_callbacks.c. The name of the file, or NULL.
extern "C" const char* write_ringing_map() {
    try {
        constexpr int width = 64, height = 32, spacing = 7;
        constexpr const char* name = "ringing.exr";
        std::vector<Imf::Rgba> pixels(size_t(width) * height, Imf::Rgba(0, 0, 0));
        for (size_t i = 0; i < pixels.size(); i += spacing) pixels[i] = Imf::Rgba(1, 1, 1);
        Imf::RgbaOutputFile file(name, width, height, Imf::WRITE_RGB, 1, {0, 0}, 1, Imf::INCREASING_Y, Imf::DWAA_COMPRESSION);
        file.setFrameBuffer(pixels.data(), 1, width);
        file.writePixels(height);
        return name;
    } catch (...) {
        return nullptr;
    }
}
