// Radiance pictures: Ward, "Real Pixels", Graphics Gems II (1991), and "Radiance File Formats", section "Picture
// Files" (https://radsite.lbl.gov/radiance/refer/filefmts.pdf).
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "base/error.h"
#include "io/colour_space.h"
#include "io/image_file.h"
#include "io/printable.h"

namespace lightband::io {
namespace {

using Rgbe = std::array<uint8_t, 4>;

// Bytes taken one after another; an Error where they end early.
class Reader {
public:
    Reader(const std::vector<uint8_t>& bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    [[noreturn]] void fail(const std::string& what) const {
        throw Error(LB_ERROR_FORMAT, text(name_, ": ", what, " (byte ", position_, " of ", bytes_.size(), ")"));
    }

    size_t remaining() const { return bytes_.size() - position_; }

    uint8_t take() {
        if (remaining() == 0) fail("Radiance picture is truncated");
        return bytes_[position_++];
    }

    Rgbe take_texel() {
        Rgbe texel;
        for (uint8_t& byte : texel) byte = take();
        return texel;
    }

    // The text up to the next newline, which is consumed too; without the carriage return of CR LF.
    std::string_view take_line() {
        const auto start = bytes_.begin() + position_;
        const auto end = std::find(start, bytes_.end(), '\n');
        if (end == bytes_.end()) fail("Radiance header is truncated: a line has no end");
        position_ = size_t(end - bytes_.begin()) + 1;
        std::string_view line(reinterpret_cast<const char*>(bytes_.data()) + (start - bytes_.begin()),
                              size_t(end - start));
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        return line;
    }

    // The next texel without consuming it; zeros beyond the end.
    Rgbe peek_texel() const {
        Rgbe texel = {};
        std::copy_n(bytes_.begin() + position_, std::min(texel.size(), remaining()), texel.begin());
        return texel;
    }

    void skip(size_t count) { position_ += std::min(count, remaining()); }

private:
    const std::vector<uint8_t>& bytes_;
    const std::string& name_;
    size_t position_ = 0;
};

// ---- Header -------------------------------------------------------------------------------------

bool starts_with(std::string_view line, std::string_view start) {
    return line.substr(0, start.size()) == start;
}

// Cuts the next word, ended by blanks, off the front of line.
std::string_view take_word(std::string_view& line) {
    constexpr const char* blanks = " \t\r";
    line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(blanks));
    line.remove_prefix(word.size());
    return word;
}

// The number that the whole word is, as atof reads it but in every locale: a plus may precede it.
bool parse_number(std::string_view word, double* number) {
    if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), *number);
    return error == std::errc() && end == word.data() + word.size() && std::isfinite(*number);
}

double parse_factor(std::string_view word, std::string_view line, const Reader& reader) {
    double factor = 0;
    if (!parse_number(word, &factor) || factor < 0)
        reader.fail(text("Radiance header line '", printable(line), "' does not hold positive numbers"));
    return factor;
}

// What the header says of the values: stored = radiance * exposure, per channel.
struct Header {
    std::array<double, 3> exposure = {1, 1, 1};
    bool is_xyz = false;
    std::optional<Chromaticities> primaries;
    std::vector<std::string> notes;
};

// "PRIMARIES= rx ry gx gy bx by wx wy"
Chromaticities parse_primaries(std::string_view value, std::string_view line, const Reader& reader) {
    std::array<double, 8> xy;
    for (double& number : xy)
        if (!parse_number(take_word(value), &number))
            reader.fail(text("Radiance header line '", printable(line), "' does not hold eight numbers"));
    return {{xy[0], xy[1]}, {xy[2], xy[3]}, {xy[4], xy[5]}, {xy[6], xy[7]}};
}

void parse_line(std::string_view line, const Reader& reader, Header* header) {
    std::string_view value = line.substr(std::min(line.find('='), line.size() - 1) + 1);
    if (starts_with(line, "FORMAT=")) {
        const std::string_view format = take_word(value);
        header->is_xyz = format == "32-bit_rle_xyze";
        if (format != "32-bit_rle_rgbe" && !header->is_xyz)
            reader.fail(text("Radiance format '", printable(format),
                             "' is not supported, only '32-bit_rle_rgbe' and '32-bit_rle_xyze'"));
    } else if (starts_with(line, "EXPOSURE=")) {  // may occur several times: the factors multiply
        const double factor = parse_factor(take_word(value), line, reader);
        if (factor == 0)
            header->notes.push_back("its header line EXPOSURE=0, which FreeImage writes, was taken for none");
        for (double& channel : header->exposure) channel *= factor == 0 ? 1 : factor;
    } else if (starts_with(line, "COLORCORR=")) {  // the same, with one factor per channel
        for (double& channel : header->exposure) channel *= parse_factor(take_word(value), line, reader);
    } else if (starts_with(line, "PRIMARIES=")) {
        const Chromaticities primaries = parse_primaries(value, line, reader);
        // Adobe Photoshop, with which Poly Haven's maps are made, writes eight zeros.
        const Vec2 none(0);
        if (primaries.red == none && primaries.green == none && primaries.blue == none && primaries.white == none)
            header->notes.push_back(
                "its header line PRIMARIES of zeros, which Adobe Photoshop writes, was taken for none");
        else
            header->primaries = primaries;
    }
}

// As Radiance's checkheader: whatever program wrote it, and where no format is named, RGBE.
Header parse_header(Reader& reader) {
    if (!starts_with(reader.take_line(), "#?")) reader.fail("Radiance header does not begin with #?");
    Header header;
    for (std::string_view line = reader.take_line(); !line.empty(); line = reader.take_line())
        parse_line(line, reader, &header);
    for (const double channel : header.exposure)
        if (!std::isfinite(channel) || channel <= 0) reader.fail("the product of the EXPOSURE lines is out of range");
    return header;
}

// XYZE is CIE XYZ, whose Y is in candelas per square metre (color.h: WHTEFFICACY lumens per watt of white light). Its
// white is equal energy, whatever PRIMARIES says, as in Radiance's ra_xyze. Without PRIMARIES, RGBE is Rec. 709, as
// everyone but Radiance writes it.
void convert(const Header& header, const std::string& name, RgbImage* image) {
    constexpr double lumens_per_watt = 179;
    const Chromaticities from = header.is_xyz ? cie_xyz : header.primaries.value_or(rec709);
    std::optional<glm::dmat3> matrix = to_rec709(from, std::nullopt, name);
    if (header.is_xyz) matrix = matrix.value_or(glm::dmat3(1)) / lumens_per_watt;
    if (matrix) convert_colours(*matrix, image);
}

// ---- Resolution ---------------------------------------------------------------------------------

// One axis of the resolution line, "-Y 512": its sign, letter and number of texels.
struct Axis {
    bool increasing;
    char letter;
    uint32_t size;
};

Axis parse_axis(std::string_view& rest, std::string_view line, const Reader& reader) {
    const std::string_view name = take_word(rest);
    const std::string_view digits = take_word(rest);
    Axis axis = {};
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), axis.size);
    const bool good_name = name == "-Y" || name == "+Y" || name == "-X" || name == "+X";
    if (!good_name || error != std::errc() || end != digits.data() + digits.size() || axis.size == 0)
        reader.fail(text("Radiance resolution line '", printable(line), "' is not of the kind '-Y height +X width'"));
    axis.increasing = name[0] == '+';
    axis.letter = name[1];
    return axis;
}

// Where the texels of the file belong. A file is a sequence of scanlines: the first axis of the resolution line counts
// them, the second one runs along them. Radiance's +X points to the right and its +Y upwards.
struct Layout {
    Axis slow;
    Axis fast;

    uint32_t width() const { return slow.letter == 'X' ? slow.size : fast.size; }
    uint32_t height() const { return slow.letter == 'Y' ? slow.size : fast.size; }

    // Index of the texel in an image whose rows run top-down.
    size_t texel(uint32_t scanline, uint32_t along) const {
        const size_t first = along_image(slow, scanline);
        const size_t second = along_image(fast, along);
        return slow.letter == 'Y' ? first * width() + second : second * width() + first;
    }

private:
    // Rows count from the top, against +Y; columns from the left, along +X.
    static uint32_t along_image(const Axis& axis, uint32_t position) {
        const bool same_direction = axis.increasing == (axis.letter == 'X');
        return same_direction ? position : axis.size - 1 - position;
    }
};

Layout parse_resolution(Reader& reader) {
    const std::string_view line = reader.take_line();
    std::string_view rest = line;
    Layout layout = {};
    layout.slow = parse_axis(rest, line, reader);
    layout.fast = parse_axis(rest, line, reader);
    if (layout.slow.letter == layout.fast.letter || !take_word(rest).empty())
        reader.fail(text("Radiance resolution line '", printable(line), "' does not name X and Y once each"));
    if (layout.width() > max_map_width || layout.height() > max_map_height)
        reader.fail(text("image of ", layout.width(), " x ", layout.height(), " texels exceeds the limit of ",
                         max_map_width, " x ", max_map_height));
    constexpr size_t smallest_scanline = 4;  // bytes: one texel, or the start of a run-length encoded scanline
    if (reader.remaining() / smallest_scanline < layout.slow.size)
        reader.fail(text("Radiance picture is truncated: ", layout.slow.size, " scanlines announced"));
    return layout;
}

// ---- Scanlines ----------------------------------------------------------------------------------

// Run-length encoding by components: for red, green, blue, exponent in turn, packets of either 128 + n and one byte to
// be repeated n times, or n and n bytes as they are.
void take_components(Reader& reader, std::vector<Rgbe>& scanline) {
    for (size_t component = 0; component < 4; ++component) {
        for (size_t x = 0; x < scanline.size();) {
            const uint8_t code = reader.take();
            const bool repeated = code > 128;
            const size_t count = repeated ? code - 128 : code;
            if (count == 0 || count > scanline.size() - x) reader.fail("Radiance scanline: a run does not fit");
            const uint8_t value = repeated ? reader.take() : 0;
            for (const size_t end = x + count; x < end; ++x) scanline[x][component] = repeated ? value : reader.take();
        }
    }
}

// Texels one by one. Where one is (1, 1, 1, n), the texel before it is repeated n times; several in a row give the
// digits of n to the base 256, the lowest first. (A flat file is one without repetitions.)
void take_texels(Reader& reader, std::vector<Rgbe>& scanline) {
    uint64_t digit = 1;
    for (size_t x = 0; x < scanline.size();) {
        const Rgbe texel = reader.take_texel();
        const bool repetition = texel[0] == 1 && texel[1] == 1 && texel[2] == 1;
        if (!repetition) {
            scanline[x++] = texel;
            digit = 1;
            continue;
        }
        if (x == 0) reader.fail("Radiance scanline: begins with a repetition");
        // A digit worth more than a scanline is useless; refusing it keeps the product in range.
        const uint64_t count = texel[3] * digit;
        if (digit > max_map_width || count > scanline.size() - x) reader.fail("Radiance scanline: a run does not fit");
        std::fill_n(scanline.begin() + x, count, scanline[x - 1]);
        x += count;
        digit *= 256;
    }
}

void take_scanline(Reader& reader, std::vector<Rgbe>& scanline) {
    constexpr size_t shortest = 8, longest = 0x7fff;  // MINELEN and MAXELEN of Radiance's color.c
    const Rgbe start = reader.peek_texel();
    const bool by_components =
        scanline.size() >= shortest && scanline.size() <= longest && start[0] == 2 && start[1] == 2 && start[2] < 128;
    if (!by_components) return take_texels(reader, scanline);
    const size_t length = size_t(start[2]) << 8 | start[3];
    if (length != scanline.size())
        reader.fail(text("Radiance scanline announces ", length, " texels, expected ", scanline.size()));
    reader.skip(start.size());
    take_components(reader, scanline);
}

// The value of one component. Half a step is added to the mantissa, as Radiance's own colr_color does, so that the
// quantisation is unbiased; an exponent of zero means black.
double decode(uint8_t mantissa, uint8_t exponent) {
    return exponent == 0 ? 0.0 : std::ldexp((mantissa + 0.5) / 256.0, int(exponent) - 128);
}

}  // namespace

// Bytes after the last scanline are ignored, as Radiance does.
RgbImage parse_hdr(const std::vector<uint8_t>& bytes, const std::string& name) {
    Reader reader(bytes, name);
    const Header header = parse_header(reader);
    const Layout layout = parse_resolution(reader);

    RgbImage image;
    image.notes = header.notes;
    image.width = layout.width();
    image.height = layout.height();
    image.rgb.resize(size_t(image.width) * image.height * 3);
    std::vector<Rgbe> scanline(layout.fast.size);
    for (uint32_t y = 0; y < layout.slow.size; ++y) {
        take_scanline(reader, scanline);
        for (uint32_t x = 0; x < layout.fast.size; ++x) {
            float* texel = &image.rgb[layout.texel(y, x) * 3];
            for (size_t channel = 0; channel < 3; ++channel) {
                const double value = decode(scanline[x][channel], scanline[x][3]) / header.exposure[channel];
                if (value > std::numeric_limits<float>::max())
                    reader.fail(text("a texel divided by the EXPOSURE exceeds the range of float32: ", value));
                texel[channel] = float(value);
            }
        }
    }
    convert(header, name, &image);
    return image;
}

}  // namespace lightband::io
