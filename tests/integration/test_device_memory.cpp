// Buffers and textures that the device has no memory for are an error where they are made, and leave none for a later
// call. Sources of shaders are whole where memory runs out, or an exception.
#include <cstring>

#include "failing_memory.h"
#include "gl/objects.h"
#include "gl/shader_sources.h"
#include "io_testing.h"

namespace {

using namespace lightband;

void storage_beyond_the_device_is_refused(void**) {
    const auto device = std::make_shared<gl::Device>(LB_DEVICE_SOFTWARE, nullptr, nullptr);
    device->run([&] {
        const gl::Functions& gl = device->gl();
        constexpr size_t too_much = size_t(1) << 46;  // bytes: more than a process can address beside its own
        testing::expect_error(LB_ERROR_LIMIT, {"no memory", "buffer of 70368744177664 bytes"},
                              [&] { gl::Buffer(gl, too_much, nullptr); });
        const uint32_t side = uint32_t(device->max_texture_size());
        constexpr uint32_t layers = 256;  // every OpenGL 4.5 takes so many; of 16,384 x 16,384 texels they are a tebibyte
        testing::expect_error(LB_ERROR_LIMIT, {"no memory", "256 times"},
                              [&] { gl::Texture::image_array(gl, GL_RGBA32F, side, side, layers, 1); });
        device->check("afterwards");
        const uint32_t word = 7;
        uint32_t read = 0;
        const gl::Buffer buffer(gl, sizeof word, &word);
        buffer.read(0, sizeof read, &read);
        assert_int_equal(read, word);
    });
}

void sources_are_whole_or_an_exception(void**) {
    const std::string definitions = text("SAMPLER_CUT\nFILTERED\nTRUNK_PARTS ", 1024, "\nCEILING_WORTH ", 0.123456789);
    const std::string whole = gl::shader_source("shade.glsl", definitions);
    assert_non_null(std::strstr(whole.c_str(), "#define CEILING_WORTH 0.123456789\n"));
    for (int64_t granted = 0;; ++granted) {
        std::string source;
        failing_memory::fail_after(granted, failing_memory::Failing::one);
        try {
            source = gl::shader_source("shade.glsl", definitions);
        } catch (const std::bad_alloc&) {
        }
        const bool failed = failing_memory::stop_failing();
        assert_true(source == (failed ? std::string() : whole));
        if (!failed) break;
    }
}

}  // namespace

int main() {
    failing_memory::begin();
    const CMUnitTest tests[] = {
        cmocka_unit_test(storage_beyond_the_device_is_refused),
        cmocka_unit_test(sources_are_whole_or_an_exception),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
