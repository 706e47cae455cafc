// Memory that runs out: the Nth allocation fails, for each N in turn. The readers and writers then throw
// std::bad_alloc or Error, and everything they had allocated is free again.
//
// Inside OpenEXR 3.1 itself some memory is lost when an allocation fails: Imf::Header's constructor allocates its
// attributes one by one, and where a later one fails nothing frees the earlier ones. Where OpenEXR takes part, only
// what leaves the call is checked, and not what is free afterwards.
#include <atomic>
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
std::atomic<bool> failed{false};

void* allocate(size_t size) {
    if (until_failure >= 0 && until_failure-- == 0) {
        failed = true;
        throw std::bad_alloc();
    }
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
        } catch (const Error&) {
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

void test_exr(void**) {
    ScratchFolder folder;
    const std::string path = folder.file("a.exr");
    io::write_exr(path, 2, 1, colour_channels);
    const Bytes bytes = io::read_file(path, 1 << 20);
    assert_true(fail_each_allocation(Leaks::inside_openexr, [&] { io::parse_exr(bytes, "a"); }) >= 10);
    assert_true(fail_each_allocation(Leaks::inside_openexr, [&] { io::read_image(path); }) >= 10);
}

void test_writers(void**) {
    ScratchFolder folder;
    const std::string exr = folder.file("a.exr"), png = folder.file("a.png"), plain = folder.file("a");
    const Bytes bytes(1000), pixels(4 * 2 * 2);
    assert_true(fail_each_allocation(Leaks::inside_openexr, [&] { io::write_exr(exr, 2, 1, colour_channels); }) >= 10);
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
