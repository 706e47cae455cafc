// Whole files, MERL tables, telling pictures apart, and the writers. (Radiance: test_hdr.cpp; OpenEXR: test_exr.cpp.)
#include <ImfChannelList.h>
#include <ImfCompression.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <png.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cfloat>
#include <cmath>
#include <cstring>
#include <limits>

#include "io/display.h"
#include "io/file.h"
#include "io/image_file.h"
#include "io/merl.h"
#include "io_testing.h"

namespace {

using namespace lightband;
using namespace lightband::io;
using namespace lightband::testing;

// A limit on the size of files stands for the full disk.
template <typename Call>
void with_file_size_limit(rlim_t bytes, const Call& call) {
    struct rlimit before;
    getrlimit(RLIMIT_FSIZE, &before);
    const struct rlimit small = {bytes, before.rlim_max};
    const auto handler = signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    call();
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, handler);
}

// ---- Whole files --------------------------------------------------------------------------------

void test_file_round_trip(void**) {
    ScratchFolder folder;
    const std::string path = folder.file("bytes");
    for (const size_t size : {0, 1, 65535, 65536, 300000}) {
        Bytes bytes(size);
        for (size_t i = 0; i < size; ++i) bytes[i] = uint8_t(i * 7 + i / 256);
        write_file(path, bytes);
        assert_true(read_file(path, size) == bytes);
        assert_int_equal(folder.entries(), 1);
    }
}

void test_descriptors_are_closed(void**) {
    ScratchFolder folder;
    const std::string path = folder.file("bytes");
    const int before = ::dup(0);  // the lowest free number
    ::close(before);
    write_file(path, Bytes(10));
    read_file(path, 10);
    expect_error(LB_ERROR_FORMAT, {}, [&] { read_file(path, 9); });
    with_file_size_limit(5, [&] { expect_error(LB_ERROR_FILE, {}, [&] { write_file(path, Bytes(10)); }); });
    const int after = ::dup(0);
    ::close(after);
    assert_int_equal(after, before);
}

void test_read_limits(void**) {
    ScratchFolder folder;
    const std::string path = folder.file("bytes");
    write_file(path, Bytes(1000));
    assert_int_equal(read_file(path, 1000).size(), 1000);
    expect_error(LB_ERROR_FORMAT, {path, "1000 bytes", "limit of 999"}, [&] { read_file(path, 999); });
    // It announces no size, and holds this program's name.
    assert_true(read_file("/proc/self/comm", 100).size() > 1);
    expect_error(LB_ERROR_FORMAT, {"/proc/self/comm", "limit of 2"}, [] { read_file("/proc/self/comm", 2); });
}

void test_read_failures(void**) {
    ScratchFolder folder;
    const std::string missing = folder.file("missing");
    expect_error(LB_ERROR_FILE, {missing, "No such file"}, [&] { read_file(missing, 10); });
}

// What is not a regular file: made in the folder where it can be, with the word that messages have for it.
std::vector<std::pair<std::string, const char*>> things_that_are_no_files(const ScratchFolder& folder) {
    const std::string pipe = folder.file("pipe"), socket = folder.file("socket"), inner = folder.file("folder");
    assert_int_equal(mkfifo(pipe.c_str(), 0600), 0);
    const int listener = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address = {};
    address.sun_family = AF_UNIX;
    socket.copy(address.sun_path, sizeof address.sun_path - 1);
    assert_int_equal(bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::close(listener);  // its name stays
    std::filesystem::create_directory(inner);
    std::filesystem::create_symlink(pipe, folder.file("link"));
    return {{pipe, "a pipe"},       {socket, "a socket"},     {inner, "a directory"}, {folder.file("link"), "a pipe"},
            {"/dev/zero", "a device"}, {"/dev/null", "a device"}};
}

// Nothing of them is waited for: a read that blocks would never end.
void test_only_regular_files_are_read_and_replaced(void**) {
    ScratchFolder folder;
    const auto things = things_that_are_no_files(folder);
    for (const auto& [path, kind] : things) {
        expect_error(LB_ERROR_FILE, {path, kind}, [&, &name = path] { read_file(name, 1 << 20); });
        expect_error(LB_ERROR_FILE, {path, kind}, [&, &name = path] { read_image(name); });
        expect_error(LB_ERROR_FILE, {path, kind}, [&, &name = path] { read_merl(name); });
        expect_error(LB_ERROR_FILE, {path, kind}, [&, &name = path] { write_file(name, Bytes(3)); });
    }
    assert_int_equal(folder.entries(), 4);
}

void test_write_failures_leave_nothing(void**) {
    ScratchFolder folder;
    const std::string nowhere = folder.file("missing/file");
    expect_error(LB_ERROR_FILE, {nowhere, "No such file"}, [&] { write_file(nowhere, Bytes(3)); });
    // The temporary file can be made and written, but this name cannot be given to it.
    const std::string too_long = folder.file(std::string(300, 'x'));
    expect_error(LB_ERROR_FILE, {"name too long"}, [&] { write_file(too_long, Bytes(3)); });
    assert_int_equal(folder.entries(), 0);
}

mode_t mode_of(const std::string& path) {
    struct stat status;
    assert_int_equal(stat(path.c_str(), &status), 0);
    return status.st_mode & 07777;
}

void test_links_and_modes_stay(void**) {
    namespace fs = std::filesystem;
    ScratchFolder folder;
    fs::create_directory(folder.file("inner"));
    const std::string target = folder.file("inner/target");
    write_file(target, Bytes(5, 1));
    assert_int_equal(chmod(target.c_str(), 0604), 0);
    fs::create_symlink("inner/target", folder.file("relative"));
    fs::create_symlink(folder.file("relative"), folder.file("chain"));
    for (const std::string name : {"relative", "chain"}) {
        write_file(folder.file(name), Bytes(name.begin(), name.end()));
        assert_true(fs::is_symlink(folder.file(name)));
        assert_true(read_file(target, 100) == Bytes(name.begin(), name.end()));
        assert_int_equal(mode_of(target), 0604);
    }
    // A link to what does not exist yet makes it; one to itself leads nowhere.
    fs::create_symlink("inner/new", folder.file("dangling"));
    write_file(folder.file("dangling"), Bytes(3, 7));
    assert_true(read_file(folder.file("inner/new"), 100) == Bytes(3, 7) && fs::is_symlink(folder.file("dangling")));
    fs::create_symlink("loop", folder.file("loop"));
    expect_error(LB_ERROR_FILE, {folder.file("loop"), "symbolic links"}, [&] { write_file(folder.file("loop"), Bytes(3)); });
    assert_int_equal(folder.entries(), 5);
}

void test_full_disk_leaves_the_old_file(void**) {
    ScratchFolder folder;
    const std::string path = folder.file("file");
    write_file(path, Bytes(5, 42));
    with_file_size_limit(1000, [&] {
        expect_error(LB_ERROR_FILE, {path, "cannot be written", "too large"}, [&] { write_file(path, Bytes(5000)); });
    });
    assert_true(read_file(path, 5) == Bytes(5, 42));
    assert_int_equal(folder.entries(), 1);
}

void test_permissions_follow_the_umask(void**) {
    ScratchFolder folder;
    const mode_t before = umask(027);
    write_file(folder.file("file"), Bytes(3));
    umask(before);
    assert_int_equal(mode_of(folder.file("file")), 0640);
}

// ---- MERL ---------------------------------------------------------------------------------------

constexpr size_t merl_bytes = 12 + 3 * BrdfTable::cell_count * 8;

void put_int(Bytes& bytes, size_t position, int32_t value) {
    for (int i = 0; i < 4; ++i) bytes[position + i] = uint8_t(uint32_t(value) >> (8 * i));
}

// The tests run on little-endian machines, whose memory is as the file's.
void put_double(Bytes& bytes, size_t cell, size_t channel, double value) {
    std::memcpy(&bytes[12 + (channel * BrdfTable::cell_count + cell) * 8], &value, sizeof value);
}

Bytes merl_header(int32_t theta_half, int32_t theta_diff, int32_t phi_diff, size_t size) {
    Bytes bytes(size);
    put_int(bytes, 0, theta_half);
    put_int(bytes, 4, theta_diff);
    put_int(bytes, 8, phi_diff);
    return bytes;
}

BrdfTable parse(const Bytes& bytes) {
    return parse_merl(bytes, "paint.binary");
}

void test_merl_values(void**) {
    Bytes bytes = merl_header(90, 90, 180, merl_bytes);
    const size_t cell = BrdfTable::cell(3, 40, 170), partly = BrdfTable::cell(89, 89, 179), first = 0;
    for (size_t channel = 0; channel < 3; ++channel) {
        put_double(bytes, cell, channel, 1500.0 * double(channel + 1));
        put_double(bytes, partly, channel, channel == 1 ? -1e-9 : 5.0);
        put_double(bytes, first, channel, 750.0);
    }
    const BrdfTable table = parse(bytes);
    assert_int_equal(table.rgb.size(), BrdfTable::cell_count * 3);
    assert_float_equal(table.rgb[cell * 3 + 0], 1.0f, 0);
    assert_float_equal(table.rgb[cell * 3 + 1], 2.0f * 1.15f, FLT_EPSILON * 4);  // one ulp between 2 and 4
    assert_float_equal(table.rgb[cell * 3 + 2], 3.0f * 1.66f, FLT_EPSILON * 8);  // two ulps between 4 and 8
    for (size_t channel = 0; channel < 3; ++channel) assert_float_equal(table.rgb[partly * 3 + channel], -1, 0);
    assert_float_equal(table.rgb[0], 0.5f, 0);
    assert_float_equal(table.rgb[3], 0, 0);
}

void test_merl_round_trip(void**) {
    ScratchFolder folder;
    BrdfTable table;
    table.rgb.resize(BrdfTable::cell_count * 3);
    for (size_t i = 0; i < table.rgb.size(); ++i)
        table.rgb[i] = std::ldexp(1.0f + float(i % 4093) / 4096, int(i % 40) - 20);
    for (size_t channel = 0; channel < 3; ++channel) table.rgb[300 + channel] = -1;
    table.rgb[600] = 9.9e8f;
    write_merl(folder.file("a.binary"), table);
    assert_int_equal(std::filesystem::file_size(folder.file("a.binary")), merl_bytes);
    // The double between carries each float32 through the division and the multiplication without a change.
    assert_true(read_merl(folder.file("a.binary")).rgb == table.rgb);
}

void test_merl_headers(void**) {
    const auto expect_header = [](int32_t a, int32_t b, int32_t c, const std::vector<std::string>& words) {
        for (const size_t size : {size_t(12), size_t(1000)})
            expect_error(LB_ERROR_FORMAT, words, [&] { parse(merl_header(a, b, c, size)); });
    };
    expect_header(180, 90, 90, {"paint.binary", "(180, 90, 90)", "wrong order", "(90, 90, 180)"});
    expect_header(90, 180, 90, {"(90, 180, 90)", "wrong order"});
    expect_header(90, -90, 180, {"(90, -90, 180)", "negative"});
    expect_header(90, 90, 181, {"(90, 90, 181)", "other dimensions"});
    expect_header(90, 90, 90, {"(90, 90, 90)", "other dimensions"});
    expect_header(std::numeric_limits<int32_t>::max(), 90, 180, {"(2147483647, 90, 180)", "other dimensions"});
    // Big-endian 90 reads as 1509949440.
    expect_header(1509949440, 1509949440, -1275068416, {"negative"});
}

void test_merl_sizes(void**) {
    expect_error(LB_ERROR_FORMAT, {"truncated", "34992012", "found 0"}, [] { parse({}); });
    expect_error(LB_ERROR_FORMAT, {"truncated", "34992012", "found 11"}, [] { parse(Bytes(11)); });
    for (const size_t size : {size_t(12), size_t(13), merl_bytes / 3, merl_bytes - 1})
        expect_error(LB_ERROR_FORMAT, {"truncated", "expected 34992012", "found " + std::to_string(size)},
                     [&] { parse(merl_header(90, 90, 180, size)); });
    expect_error(LB_ERROR_FORMAT, {"too long", "expected 34992012", "found 34992013"},
                 [] { parse(merl_header(90, 90, 180, merl_bytes + 1)); });
    ScratchFolder folder;
    write_file(folder.file("long"), merl_header(90, 90, 180, merl_bytes + 100));
    expect_error(LB_ERROR_FORMAT, {"34992112", "34992012"}, [&] { read_merl(folder.file("long")); });
}

void test_merl_cells(void**) {
    const Bytes zeros = merl_header(90, 90, 180, merl_bytes);
    const size_t cell = BrdfTable::cell(12, 34, 56);
    const double bad_values[] = {NAN, INFINITY, -INFINITY, 1e300, 1.6e12};
    for (const double value : bad_values) {
        Bytes bytes = zeros;
        put_double(bytes, cell, 2, value);
        put_double(bytes, cell, 0, -1);  // does not excuse the other channel
        const char* reason = std::isfinite(value) ? "1e9 per steradian" : "not finite";
        expect_error(LB_ERROR_FORMAT, {"theta_half 12, theta_diff 34, phi_diff 56", "blue", reason},
                     [&] { parse(bytes); });
    }
    Bytes large = zeros;
    put_double(large, cell, 0, 1.49e12);  // 1.49e12 / 1500 is just below 1e9
    put_double(large, cell + 1, 0, -1e300);  // not measured
    const BrdfTable table = parse(large);
    assert_true(table.rgb[cell * 3] > 9.9e8f && table.rgb[(cell + 1) * 3] == -1);
}

void test_merl_writing_bad_tables(void**) {
    ScratchFolder folder;
    BrdfTable table;
    table.rgb.resize(7);
    expect_error(LB_ERROR_INVALID_ARGUMENT, {"7 values", "4374000"}, [&] { write_merl(folder.file("a"), table); });
    table.rgb.resize(BrdfTable::cell_count * 3);
    table.rgb[BrdfTable::cell(1, 2, 3) * 3 + 1] = NAN;
    expect_error(LB_ERROR_INVALID_ARGUMENT, {"theta_half 1, theta_diff 2, phi_diff 3", "green", "not finite"},
                 [&] { write_merl(folder.file("a"), table); });
    assert_int_equal(folder.entries(), 0);
}

// ---- Telling pictures apart ---------------------------------------------------------------------

void test_read_image(void**) {
    ScratchFolder folder;
    // The name does not decide, the first bytes do.
    write_exr(folder.file("a.hdr"), 2, 1, {{"R", {1, 2}}, {"G", {3, 4}}, {"B", {5, 6}}});
    const RgbImage exr = read_image(folder.file("a.hdr"));
    assert_true(exr.rgb == std::vector<float>({1, 3, 5, 2, 4, 6}));
    const std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x81";
    write_file(folder.file("b.exr"), Bytes(hdr.begin(), hdr.end()));
    assert_int_equal(read_image(folder.file("b.exr")).width, 1);
    for (const std::string start : {"", "#", "v/1", "\x89PNG\r\n"}) {
        write_file(folder.file("c.exr"), Bytes(start.begin(), start.end()));
        expect_error(LB_ERROR_FORMAT, {folder.file("c.exr"), "neither"}, [&] { read_image(folder.file("c.exr")); });
    }
    expect_error(LB_ERROR_FILE, {"No such file"}, [&] { read_image(folder.file("missing.exr")); });
}

void test_named_layers(void**) {
    ScratchFolder folder;
    write_exr(folder.file("a.exr"), 1, 1, {{"glow.R", {1}}, {"glow.G", {2}}, {"glow.B", {3}}, {"in.ner.Y", {4}}, {"Z", {5}}});
    assert_true(read_image(folder.file("a.exr#glow")).rgb == std::vector<float>({1, 2, 3}));
    assert_true(read_image(folder.file("a.exr#in.ner")).rgb == std::vector<float>({4, 4, 4}));
    expect_error(LB_ERROR_FORMAT, {"\"shadow\"", "glow, in.ner"}, [&] { read_image(folder.file("a.exr#shadow")); });
    expect_error(LB_ERROR_FORMAT, {"no colour", "glow, in.ner"}, [&] { read_image(folder.file("a.exr")); });
    expect_error(LB_ERROR_FILE, {"b.exr", "No such file"}, [&] { read_image(folder.file("b.exr#glow")); });
    // A file that has the whole name comes first.
    write_exr(folder.file("a.exr#glow"), 1, 1, {{"Y", {9}}});
    assert_true(read_image(folder.file("a.exr#glow")).rgb == std::vector<float>({9, 9, 9}));
    const std::string hdr = "#?RADIANCE\n\n-Y 1 +X 1\n\x80\x80\x80\x81";
    write_file(folder.file("c.hdr"), Bytes(hdr.begin(), hdr.end()));
    expect_error(LB_ERROR_FORMAT, {"no layers", "glow"}, [&] { read_image(folder.file("c.hdr#glow")); });
}

// ---- Writers ------------------------------------------------------------------------------------

void test_write_exr(void**) {
    ScratchFolder folder;
    constexpr uint32_t width = 19, height = 33;
    std::vector<NamedChannel> channels = {{"R", {}}, {"variance_predicted.Y", {}}, {"B", {}}, {"G", {}}};
    for (size_t c = 0; c < channels.size(); ++c)
        for (uint32_t i = 0; i < width * height; ++i) channels[c].values.push_back(float(i) * 1.7f + float(c) * 1e-3f);
    channels[0].values[5] = INFINITY;
    write_exr(folder.file("a.exr"), width, height, channels, {{"lightband.seed", 7.0}, {"lightband.sampler", "cut"}});
    assert_int_equal(folder.entries(), 1);

    Imf::InputFile file(folder.file("a.exr").c_str());
    const Imath::Box2i window = file.header().dataWindow();
    assert_true(window == Imath::Box2i({0, 0}, {width - 1, height - 1}));
    assert_int_equal(file.header().compression(), Imf::ZIP_COMPRESSION);
    assert_true(Imf::hasChromaticities(file.header()) && Imf::chromaticities(file.header()) == Imf::Chromaticities());
    assert_float_equal(file.header().pixelAspectRatio(), 1, 0);
    assert_float_equal(file.header().typedAttribute<Imf::DoubleAttribute>("lightband.seed").value(), 7, 0);
    assert_string_equal(file.header().typedAttribute<Imf::StringAttribute>("lightband.sampler").value().c_str(), "cut");
    for (const NamedChannel& channel : channels) {
        const Imf::Channel* found = file.header().channels().findChannel(channel.name);
        assert_non_null(found);
        assert_int_equal(found->type, Imf::FLOAT);
        std::vector<float> values(width * height);
        Imf::FrameBuffer buffer;
        buffer.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, values.data(), window));
        file.setFrameBuffer(buffer);
        file.readPixels(0, height - 1);
        assert_true(values == channel.values);
    }
}

void test_write_exr_bad_arguments(void**) {
    ScratchFolder folder;
    const std::string path = folder.file("a.exr");
    const auto expect_bad = [&](uint32_t width, uint32_t height, const std::vector<NamedChannel>& channels,
                                const std::vector<std::string>& words) {
        expect_error(LB_ERROR_INVALID_ARGUMENT, words, [&] { write_exr(path, width, height, channels); });
    };
    expect_bad(0, 1, {{"R", {}}}, {path, "0 x 1"});
    expect_bad(1, 1, {}, {"without channels"});
    expect_bad(2, 2, {{"R", {1, 2, 3}}}, {"channel R has 3 values", "2 x 2"});
    expect_bad(1, 1, {{"R", {1}}, {"R", {2}}}, {"R is given twice"});
    expect_bad(1, 1, {{"", {1}}}, {"channel name ''"});
    expect_bad(1, 1, {{std::string(256, 'x'), {1}}}, {"255"});
    assert_int_equal(folder.entries(), 0);
}

void test_write_png(void**) {
    ScratchFolder folder;
    constexpr uint32_t width = 13, height = 7;
    Bytes pixels;
    for (uint32_t i = 0; i < width * height * 4; ++i) pixels.push_back(uint8_t(i * 37));
    write_png(folder.file("a.png"), width, height, pixels);
    assert_int_equal(folder.entries(), 1);

    const Bytes file = read_file(folder.file("a.png"), 1 << 20);
    const std::string words(file.begin(), file.end());
    assert_true(words.find("sRGB") != std::string::npos);
    assert_int_equal(words.rfind("IEND"), words.size() - 8);  // the last chunk's name and checksum end the file
    png_image image = {};
    image.version = PNG_IMAGE_VERSION;
    assert_true(png_image_begin_read_from_memory(&image, file.data(), file.size()));
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    assert_int_equal(image.format, PNG_FORMAT_RGBA);
    Bytes found(PNG_IMAGE_SIZE(image));
    assert_true(png_image_finish_read(&image, nullptr, found.data(), 0, nullptr));
    assert_true(found == pixels);
}

void test_write_png_bad_arguments(void**) {
    ScratchFolder folder;
    const std::string path = folder.file("a.png");
    expect_error(LB_ERROR_INVALID_ARGUMENT, {path, "0 x 3"}, [&] { write_png(path, 0, 3, {}); });
    expect_error(LB_ERROR_INVALID_ARGUMENT, {"15 bytes", "2 x 2"}, [&] { write_png(path, 2, 2, Bytes(15)); });
    // Beyond libpng's own limit of 1000000 on a side.
    expect_error(LB_ERROR_FILE, {path, "PNG"}, [&] { write_png(path, 1000001, 1, Bytes(4000004)); });
    assert_int_equal(folder.entries(), 0);
}

// ---- Eight bits -------------------------------------------------------------------------------------

// Every power of two and steps between them, over the range of float: rising, 0 at 0, below 1 for all that is finite.
void test_filmic_curve(void**) {
    assert_float_equal(filmic(0), 0, 0);
    double before = 0;
    for (double radiance = 1e-6; radiance < 1e6; radiance *= 1.01) {
        const double shown = filmic(radiance);
        assert_true(shown > before && shown < 1);
        before = shown;
    }
    for (const double radiance : {1e15, double(FLT_MAX), DBL_MAX}) assert_true(filmic(radiance) >= before && filmic(radiance) < 1);
    assert_float_equal(filmic(0.18), 0.18, 1e-12);
    // Hable's curve at the exposure that keeps mid-grey, x = 3.9454 times radiance, over its limit 14/15, by hand.
    const double x = 3.9453725;
    const double expected = ((x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.2 / 3) * 15 / 14;
    assert_float_equal(filmic(1), expected, 1e-6);
}

void test_eight_bits(void**) {
    // Linear 0.21404 is the code value 0.5; 2^-1 of 0.42808 as well. Half covered, a colour holds half of the light.
    const float rgba[] = {0, 0.21404114f, 1, 1, 0.42808228f, 3, -1, 0, 0.10702057f, 0.5f, 0, 0.5f};
    const Bytes plain = to_srgb(rgba, 3, {});
    assert_true(plain == Bytes({0, 128, 255, 255, 175, 255, 0, 0, 128, 255, 0, 128}));
    Display half;
    half.exposure = -1;
    assert_int_equal(to_srgb(rgba, 3, half)[4], 128);
    Display opaque;
    opaque.opaque = true;
    assert_true(to_srgb(rgba, 3, opaque) == Bytes({0, 128, 255, 255, 175, 255, 0, 255, 92, 188, 0, 255}));
    Display film;
    film.tone_curve = ToneCurve::filmic;
    const Bytes shown = to_srgb(rgba, 3, film);
    assert_true(shown[2] < shown[5] && shown[5] < 255);  // of radiance 1 and 3, no longer alike
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_file_round_trip),
        cmocka_unit_test(test_descriptors_are_closed),
        cmocka_unit_test(test_read_limits),
        cmocka_unit_test(test_read_failures),
        cmocka_unit_test(test_only_regular_files_are_read_and_replaced),
        cmocka_unit_test(test_write_failures_leave_nothing),
        cmocka_unit_test(test_links_and_modes_stay),
        cmocka_unit_test(test_full_disk_leaves_the_old_file),
        cmocka_unit_test(test_permissions_follow_the_umask),
        cmocka_unit_test(test_merl_values),
        cmocka_unit_test(test_merl_round_trip),
        cmocka_unit_test(test_merl_headers),
        cmocka_unit_test(test_merl_sizes),
        cmocka_unit_test(test_merl_cells),
        cmocka_unit_test(test_merl_writing_bad_tables),
        cmocka_unit_test(test_read_image),
        cmocka_unit_test(test_named_layers),
        cmocka_unit_test(test_write_exr),
        cmocka_unit_test(test_write_exr_bad_arguments),
        cmocka_unit_test(test_write_png),
        cmocka_unit_test(test_write_png_bad_arguments),
        cmocka_unit_test(test_filmic_curve),
        cmocka_unit_test(test_eight_bits),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
