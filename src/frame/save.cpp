#include "frame/save.h"

#include <algorithm>
#include <cmath>

#include "io/image_file.h"

namespace lightband {
namespace {

bool ends_in(const std::string& path, const std::string& ending) {
    return path.size() >= ending.size() && path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
}

float element(const HostArray& array, size_t i) {
    if (array.type == LB_TYPE_UINT8) return float(array.as<uint8_t>()[i]);
    if (array.type == LB_TYPE_UINT32) return float(array.as<uint32_t>()[i]);
    return array.as<float>()[i];
}

void append_channels(const std::string& field, const HostArray& array, std::vector<io::NamedChannel>* channels) {
    const size_t components = array.shape.size() > 2 ? size_t(array.shape[2]) : 1;
    const size_t pixels = size_t(array.shape[0] * array.shape[1]);
    for (size_t c = 0; c < components; ++c) {
        const std::string name = field == "color" ? std::string(1, "RGBA"[c])
                                 : components > 1 ? field + '.' + "XYZ"[c]
                                                  : field + ".Y";
        io::NamedChannel channel{name, std::vector<float>(pixels)};
        for (size_t i = 0; i < pixels; ++i) channel.values[i] = element(array, i * components + c);
        channels->push_back(std::move(channel));
    }
}

void save_exr(const Frame& frame, const std::string& path, const std::string& fields) {
    std::vector<io::NamedChannel> channels;
    for (const std::string_view piece : split(fields, ',')) {
        const std::string name(piece);
        if (name.empty()) throw Error(LB_ERROR_INVALID_ARGUMENT, text("names \"", fields, "\" holds an empty field name"));
        const HostArray array = frame.field(name);
        if (array.shape[0] != frame.height())
            throw Error(LB_ERROR_INVALID_ARGUMENT, text("field ", name, " is not of the picture's size and cannot be saved"));
        append_channels(name, array, &channels);
    }
    io::write_exr(path, frame.width(), frame.height(), channels);
}

// IEC 61966-2-1.
uint8_t srgb(double linear) {
    const double v = std::clamp(linear, 0.0, 1.0);
    return uint8_t(std::lround(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055)));
}

void save_png(const Frame& frame, const std::string& path, const std::string& fields, float exposure) {
    if (fields != "color")
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("names is \"", fields, "\"; a PNG holds color alone"));
    if (!std::isfinite(exposure)) throw Error(LB_ERROR_INVALID_ARGUMENT, text("exposure is ", exposure, "; it must be finite"));
    const HostArray color = frame.field("color");
    const double gain = std::exp2(double(exposure));
    std::vector<uint8_t> rgba(color.size);
    for (size_t i = 0; i < rgba.size(); ++i) rgba[i] = i % 4 == 3 ? 255 : srgb(gain * color.as<float>()[i]);
    io::write_png(path, frame.width(), frame.height(), rgba);
}

}  // namespace

void save(const Frame& frame, const std::string& path, const std::string& fields, float exposure) {
    if (ends_in(path, ".exr")) return save_exr(frame, path, fields);
    if (ends_in(path, ".png")) return save_png(frame, path, fields, exposure);
    throw Error(LB_ERROR_INVALID_ARGUMENT, text("path \"", path, "\" must end in .exr or .png"));
}

}  // namespace lightband
