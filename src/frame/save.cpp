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
        // OpenEXR's own names ("Technical Introduction to OpenEXR", "Channel Names") where it has one.
        const std::string name = field == "color"   ? std::string(1, "RGBA"[c])
                                 : field == "depth" ? "Z"
                                 : components > 1   ? field + '.' + "XYZ"[c]
                                                    : field + ".Y";
        io::NamedChannel channel{name, std::vector<float>(pixels)};
        for (size_t i = 0; i < pixels; ++i) channel.values[i] = element(array, i * components + c);
        channels->push_back(std::move(channel));
    }
}

// The settings with which the frame was rendered, and its statistics: "lightband.<setting>", "lightband.stats.<field>".
std::vector<io::Attribute> attributes_of(const Frame& frame) {
    std::vector<io::Attribute> attributes = {
        {"lightband.version", text(LB_VERSION_MAJOR, ".", LB_VERSION_MINOR, ".", LB_VERSION_PATCH)}};
    const Settings& settings = frame.rendered_settings();
    for (uint32_t i = 0; i < Settings::count(); ++i) {
        const std::string name = Settings::info(i).name;
        if (Settings::info(i).type == LB_SETTING_CHOICE)
            attributes.push_back({"lightband." + name, std::string(settings.choice(name))});
        else
            attributes.push_back({"lightband." + name, settings.number(name)});
    }
    const lb_frame_stats stats = frame.stats();
    const auto add = [&](const char* field, double value) {
        attributes.push_back({std::string("lightband.stats.") + field, value});
    };
    add("frames", stats.frames);
    add("covered_pixels", double(stats.covered_pixels));
    add("shaded_pixels", double(stats.shaded_pixels));
    add("samples", double(stats.samples));
    add("saturated_pixels", double(stats.saturated_pixels));
    add("bent_normals", double(stats.bent_normals));
    add("device_bytes", double(stats.device_bytes));
    add("milliseconds", stats.milliseconds);
    add("bandwidth_milliseconds", stats.bandwidth_milliseconds);
    add("shading_milliseconds", stats.shading_milliseconds);
    add("error", stats.error);
    add("noise_error", stats.noise_error);
    add("interpolation_error", stats.interpolation_error);
    add("bias_error", stats.bias_error);
    add("capped_pixels", double(stats.capped_pixels));
    add("rounds", stats.rounds);
    add("control_pixels", stats.control_pixels);
    add("sampler_replaced", stats.sampler_replaced);
    return attributes;
}

void save_exr(const Frame& frame, const std::string& path, const std::string& fields) {
    std::vector<io::NamedChannel> channels;
    for (const std::string_view piece : split(fields, ',')) {
        const std::string name(piece);
        if (name.empty())
            throw Error(LB_ERROR_INVALID_ARGUMENT, text("names \"", fields, "\" holds an empty field name"));
        const HostArray array = frame.field(name);
        if (array.shape[0] != frame.height())
            throw Error(LB_ERROR_INVALID_ARGUMENT,
                        text("field ", name, " is not of the picture's size and cannot be saved"));
        append_channels(name, array, &channels);
    }
    io::write_exr(path, frame.width(), frame.height(), channels, attributes_of(frame));
}

void save_png(const Frame& frame, const std::string& path, const std::string& fields, const io::Display& display) {
    if (fields != "color")
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("names is \"", fields, "\"; a PNG holds color alone"));
    if (!std::isfinite(display.exposure))
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("exposure is ", display.exposure, "; it must be finite"));
    const HostArray color = frame.field("color");
    io::write_png(path, frame.width(), frame.height(), io::to_srgb(color.as<float>(), color.size / 4, display));
}

}  // namespace

void save(const Frame& frame, const std::string& path, const std::string& fields, const io::Display& display) {
    if (ends_in(path, ".exr")) return save_exr(frame, path, fields);
    if (ends_in(path, ".png")) return save_png(frame, path, fields, display);
    throw Error(LB_ERROR_INVALID_ARGUMENT, text("path \"", path, "\" must end in .exr or .png"));
}

}  // namespace lightband
