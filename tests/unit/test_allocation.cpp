// Memory that runs out: the Nth allocation fails, for each N in turn. The readers and writers then throw
// std::bad_alloc, and everything they had allocated is free again.
//
// Inside OpenEXR 3.1 itself some memory is lost when an allocation fails: Imf::Header's constructor allocates its
// attributes one by one, and where a later one fails nothing frees the earlier ones. Where OpenEXR takes part, only
// what leaves the call is checked, and not what is free afterwards.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStdIO.h>
#include <ImfTiledOutputFile.h>
#include <malloc.h>

#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "io/file.h"
#include "io/image_file.h"
#include "io/merl.h"
#include "io_testing.h"

namespace {

std::atomic<int64_t> outstanding{0};     // allocations through operator new that were not freed yet
std::atomic<int64_t> until_failure{-1};  // allocations that still succeed; negative: all do
constexpr int64_t unlimited = INT64_MAX / 2;
std::atomic<int64_t> free_bytes{unlimited};  // that malloc can still give; what is freed is added again
std::atomic<bool> failed{false};

bool is_refused([[maybe_unused]] size_t size) {
    if (int64_t(size) > free_bytes) {
        failed = true;
        return true;
    }
    if (until_failure < 0 || until_failure-- > 0) return false;
    failed = true;
    return true;
}

void* allocate(size_t size) {
#if defined(__SANITIZE_ADDRESS__)
    if (is_refused(size)) throw std::bad_alloc();
#endif
    void* memory = std::malloc(size ? size : 1);
    if (!memory) throw std::bad_alloc();
    ++outstanding;
    return memory;
}

void release(void* memory) {
    if (!memory) return;
    --outstanding;
    std::free(memory);
}

}  // namespace

// zlib and libpng call malloc, and so does allocate above. (AddressSanitizer has a malloc of its own; with it, operator
// new alone fails.)
#if !defined(__SANITIZE_ADDRESS__)
extern "C" {
void* __libc_malloc(size_t);
void* __libc_memalign(size_t, size_t);
void __libc_free(void*);

__attribute__((visibility("default"))) void* malloc(size_t size) {
    void* const memory = is_refused(size) ? nullptr : __libc_malloc(size);
    free_bytes -= int64_t(malloc_usable_size(memory));
    return memory;
}
__attribute__((visibility("default"))) int posix_memalign(void** out, size_t alignment, size_t size) {
    // OpenEXR 3.1 does not look whether it got these, and writes to the null pointer.
    constexpr size_t largest_dwa_block = 64 * sizeof(float);
    *out = size > largest_dwa_block && is_refused(size) ? nullptr : __libc_memalign(alignment, size);
    if (*out == nullptr) return ENOMEM;
    free_bytes -= int64_t(malloc_usable_size(*out));
    return 0;
}
__attribute__((visibility("default"))) void free(void* memory) {
    free_bytes += int64_t(malloc_usable_size(memory));
    __libc_free(memory);
}
}
#endif

// Asked by the leak detector of AddressSanitizer, which must be able to find it.
extern "C" __attribute__((visibility("default"))) const char* __lsan_default_suppressions() {
    return "leak:libOpenEXR\n";
}

// The nothrow forms call these; nothing here allocates with an alignment of its own.
void* operator new(size_t size) {
    return allocate(size);
}
void* operator new[](size_t size) {
    return allocate(size);
}
void operator delete(void* memory) noexcept {
    release(memory);
}
void operator delete[](void* memory) noexcept {
    release(memory);
}
void operator delete(void* memory, size_t) noexcept {
    release(memory);
}
void operator delete[](void* memory, size_t) noexcept {
    release(memory);
}

namespace {

using namespace lightband;
using namespace lightband::testing;

enum class Leaks { none, inside_openexr };

// Runs call with the first, the second ... allocation failing, until one run needs no more than were granted.
// Returns the number of allocations of the whole call.
template <typename Call>
int64_t fail_each_allocation(Leaks leaks, const Call& call) {
    call();  // statics of the libraries underneath are made now and stay
    for (int64_t granted = 0;; ++granted) {
        const int64_t before = outstanding;
        failed = false;
        until_failure = granted;
        try {
            call();
        } catch (const std::bad_alloc&) {
        } catch (const Error& error) {
            until_failure = -1;
            fail_msg("lack of memory is reported as: %s", error.what());
        }
        until_failure = -1;
        if (leaks == Leaks::none || !failed) assert_int_equal(outstanding, before);
        if (!failed) return granted;
    }
}

Bytes bytes_of(const std::string& words) {
    return Bytes(words.begin(), words.end());
}

const std::vector<io::NamedChannel> colour_channels = {{"R", {1, 2}}, {"G", {3, 4}}, {"B", {5, 6}}};

void test_merl(void**) {
    constexpr size_t merl_bytes = 12 + 3 * BrdfTable::cell_count * 8;
    Bytes bytes(merl_bytes);
    bytes[0] = bytes[4] = 90;
    bytes[8] = 180;
    assert_true(fail_each_allocation(Leaks::none, [&] { io::parse_merl(bytes, "a"); }) >= 1);

    const Bytes truncated(bytes.begin(), bytes.begin() + 1000);
    assert_true(fail_each_allocation(Leaks::none, [&] {
                    try {
                        io::parse_merl(truncated, "a");
                    } catch (const Error&) {
                    }
                }) >= 1);
}

void test_hdr(void**) {
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 1 +X 2\n";
    const Bytes good = bytes_of(header + "abcdefgh"), bad = bytes_of(header + "abcdef");
    assert_true(fail_each_allocation(Leaks::none, [&] { io::parse_hdr(good, "a"); }) >= 2);
    assert_true(fail_each_allocation(Leaks::none, [&] {
                    try {
                        io::parse_hdr(bad, "a");
                    } catch (const Error&) {
                    }
                }) >= 2);
}

// Several chunks of a compression, so that there is one after the chunk in which memory runs out.
Bytes exr_of(Imf::Compression compression, bool tiled) {
    constexpr int width = 40, height = 300;
    std::vector<float> values(size_t(width) * height);
    for (size_t i = 0; i < values.size(); ++i) values[i] = float(i % 97) / 32;
    Imf::StdOSStream stream;
    {
        Imf::Header header(width, height);
        header.compression() = compression;
        if (tiled) header.setTileDescription(Imf::TileDescription(32, 32));
        Imf::FrameBuffer buffer;
        for (const char* name : {"R", "G", "B"}) {
            header.channels().insert(name, Imf::Channel(Imf::HALF));
        }
        std::vector<Imath::half> halfs(values.begin(), values.end());
        for (const char* name : {"R", "G", "B"})
            buffer.insert(name, Imf::Slice::Make(Imf::HALF, halfs.data(), header.dataWindow()));
        if (tiled) {
            Imf::TiledOutputFile file(stream, header);
            file.setFrameBuffer(buffer);
            file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
        } else {
            Imf::OutputFile file(stream, header);
            file.setFrameBuffer(buffer);
            file.writePixels(height);
        }
    }
    return bytes_of(stream.str());
}

// Luminance and chroma, and a second part: each has a reader of its own.
Bytes luminance_chroma_exr() {
    constexpr int width = 40, height = 40;
    std::vector<Imf::Rgba> pixels(width * height, Imf::Rgba(1, 2, 3));
    Imf::StdOSStream stream;
    {
        Imf::RgbaOutputFile file(stream, Imf::Header(width, height), Imf::WRITE_YC);
        file.setFrameBuffer(pixels.data(), 1, width);
        file.writePixels(height);
    }
    return bytes_of(stream.str());
}

Bytes two_part_exr() {
    constexpr int width = 40, height = 40;
    const std::vector<float> values(width * height, 2.0f);
    std::vector<Imf::Header> headers(2, Imf::Header(width, height));
    const char* const names[] = {"Z", "R", "G", "B"};  // the first part has no colour
    for (int part = 0; part < 2; ++part) {
        headers[part].setName(part == 0 ? "depth" : "colour");
        headers[part].setType(Imf::SCANLINEIMAGE);
        for (int i = part; i < (part == 0 ? 1 : 4); ++i)
            headers[part].channels().insert(names[i], Imf::Channel(Imf::FLOAT));
    }
    Imf::StdOSStream stream;
    {
        Imf::MultiPartOutputFile file(stream, headers.data(), 2);
        for (int part = 0; part < 2; ++part) {
            Imf::FrameBuffer buffer;
            for (const char* name : names)
                buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), headers[part].dataWindow()));
            Imf::OutputPart output(file, part);
            output.setFrameBuffer(buffer);
            output.writePixels(height);
        }
    }
    return bytes_of(stream.str());
}

// A good file gives its picture where it is read at all.
void check_reading(const Bytes& bytes) {
    const std::vector<float> whole = io::parse_exr(bytes, "a").rgb;
    const auto read = [&] {
        const RgbImage image = io::parse_exr(bytes, "a");
        until_failure = -1;
        assert_true(image.rgb == whole);
    };
    assert_true(fail_each_allocation(Leaks::inside_openexr, read) >= 10);
#if !defined(__SANITIZE_ADDRESS__)
    // Few bytes may be held at a time, then more and more. What is freed after a failure can be had again: a second
    // attempt fails where the first one did.
    constexpr int64_t step = 1024;
    int64_t limit = 0;
    do {
        failed = false;
        free_bytes = limit += step;
        try {
            read();
        } catch (const std::bad_alloc&) {
        } catch (const Error& error) {
            free_bytes = unlimited;
            fail_msg("%lld bytes: lack of memory is reported as: %s", (long long)limit, error.what());
        }
        free_bytes = unlimited;
    } while (failed);
    assert_true(limit > int64_t(whole.size() * sizeof(float)));
#endif
}

void test_exr(void**) {
    for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression)
        for (const bool tiled : {false, true}) check_reading(exr_of(Imf::Compression(compression), tiled));
    check_reading(luminance_chroma_exr());
    check_reading(two_part_exr());
    ScratchFolder folder;
    const std::string path = folder.file("a.exr");
    io::write_exr(path, 2, 1, colour_channels);
    assert_true(fail_each_allocation(Leaks::inside_openexr, [&] { io::read_image(path); }) >= 10);
}

void test_writers(void**) {
    ScratchFolder folder;
    const std::string exr = folder.file("a.exr"), png = folder.file("a.png"), plain = folder.file("a");
    const Bytes bytes(1000), pixels(4 * 2 * 2);
    // Of 40 lines, three chunks. Whether it succeeds or not, what path names is a complete picture.
    constexpr uint32_t width = 32, height = 40;
    std::vector<io::NamedChannel> tall;
    for (const char* name : {"R", "G", "B", "Z", "normal.X", "normal.Y", "normal.Z"}) {
        tall.push_back({name, std::vector<float>(width * height)});
        for (uint32_t i = 0; i < width * height; ++i) tall.back().values[i] = std::sin(float(i * i) + float(name[0]));
    }
    io::write_exr(exr, width, height, tall);
    const std::vector<float> whole = io::read_image(exr).rgb;
    const auto write = [&] {
        bool saved = false;
        try {
            io::write_exr(exr, width, height, tall);
            saved = true;
        } catch (const std::bad_alloc&) {
        }
        until_failure = -1;
        assert_true(io::read_image(exr).rgb == whole);
        if (!saved) assert_true(failed);
    };
    assert_true(fail_each_allocation(Leaks::inside_openexr, write) >= 10);
    assert_true(fail_each_allocation(Leaks::none, [&] { io::write_png(png, 2, 2, pixels); }) >= 2);
    assert_true(fail_each_allocation(Leaks::none, [&] { io::write_file(plain, bytes); }) >= 1);
    assert_true(fail_each_allocation(Leaks::none, [&] { io::read_file(plain, 1000); }) >= 1);
    assert_int_equal(folder.entries(), 3);  // no temporary file is left
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_merl),
        cmocka_unit_test(test_hdr),
        cmocka_unit_test(test_exr),
        cmocka_unit_test(test_writers),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
