// lightband.Frame: a picture's size and settings, its rendering, and its fields as arrays.
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>

#include "arrays.h"
#include "objects.h"

namespace lightband_python {

namespace {

using FrameClass = py::class_<Frame, std::shared_ptr<Frame>>;

struct Field {
    const char* name;
    const char* documentation;
};

// The fields of lb_frame_map, in its order.
constexpr Field fields[] = {
    {"color", "float32, height x width x 4: radiance RGB (linear, Rec. 709) and coverage (0 or 1)."},
    {"depth", "float32, height x width: metres from the eye's plane; infinity where nothing is seen."},
    {"position", "float32, height x width x 3: metres, world."},
    {"normal", "float32, height x width x 3: unit length, world, towards the eye."},
    {"curvature", "float32, height x width: 1/metre, the largest principal curvature in magnitude."},
    {"material", "uint8, height x width: 0 where nothing is seen; else the instance's number plus one."},
    {"bandwidth_spatial", "float32, height x width: cycles/metre at the surface (first component of eq. 5)."},
    {"bandwidth_angular", "float32, height x width: cycles/radian at the eye (second component of eq. 5)."},
    {"bandwidth_image", "float32, height x width: cycles/pixel, at most 0.5 (eq. 6)."},
    {"level", "uint8, height x width: log2 of the spacing at which the pixel may be shaded (eq. 11, Nyquist)."},
    {"shaded", "uint8, height x width: 1 where the integral was computed; 0: interpolated, or nothing seen."},
    {"sample_count", "uint32, height x width: light samples drawn, by one of the frames that are accumulated."},
    {"error", R"(float32, height x width: error of the luminance L that is expected here.

It is relative to L + 0.01 of the frame's mean L.)"},
    {"variance_predicted", R"(float32, height x width: radiance^2, predicted variance of one light sample's luminance.

By the setting "variance" (eq. 9 where that is "printed").)"},
    {"variance_measured", R"(float32, height x width: radiance^2, variance of one light sample's luminance, from the samples drawn.

0 where fewer than two were drawn.)"},
    {"level_pyramid", R"(uint8, rows x width: the levels' min pyramid, level below level; 255 where nothing is seen.

pyramid() takes it apart.)"},
    {"variance_pyramid", R"(float32, rows x width: the relative variances' max pyramid, level below level.

pyramid() takes it apart.)"},
};

constexpr const char* frame_documentation = R"(A picture's size and settings; renders scenes and holds their fields.

Made by Context.frame. Settings are read and written by name: frame["samples"] = 64.

The fields of the last frame are arrays (frame.color, frame.depth, ...). Rows run top-down; pixels that see no mesh
hold 0 unless said otherwise. An array is read-only and shows the library's memory without a copy; it stays as it is
when the frame renders again or is deleted. Each access reads the field back from the device anew: keep the array.
Equations: Bagher et al. 2013.)";

py::array buffer(const Frame& self, const std::string& name) {
    return to_array(name, in_library([&] { return self.handle.map(name); }));
}

// Level k of a pyramid is ceil(height / 2^k) x ceil(width / 2^k) and lies below level k - 1.
py::list pyramid(const Frame& self, const std::string& name) {
    if (name != "level_pyramid" && name != "variance_pyramid") {
        throw lightband::Exception(LB_ERROR_INVALID_ARGUMENT, "Frame.pyramid: name is \"" + name +
                                                                  "\"; it must be \"level_pyramid\" or \"variance_pyramid\"");
    }
    const py::array packed = buffer(self, name);
    py::ssize_t height = self.height;
    py::ssize_t width = self.width;
    py::list levels;
    for (py::ssize_t row = 0; row < packed.shape(0);) {
        levels.append(packed[py::make_tuple(py::slice(row, row + height, 1), py::slice(0, width, 1))]);
        row += height;
        height = (height + 1) / 2;
        width = (width + 1) / 2;
    }
    return levels;
}

// What the library says of a setting; nothing of an unknown name, at which the call that follows fails.
std::optional<lb_setting_info> find_setting(const std::string& name) {
    return in_library([&]() -> std::optional<lb_setting_info> {
        for (uint32_t i = 0; i < lb_setting_count(); ++i) {
            lb_setting_info info = LB_SETTING_INFO_INIT;
            lightband::check(lb_setting_at(i, &info));
            if (name == info.name) {
                return info;
            }
        }
        return std::nullopt;
    });
}

std::string expected_value(const lb_setting_info& info) {
    switch (info.type) {
        case LB_SETTING_INTEGER:
            return "a whole number";
        case LB_SETTING_REAL:
            return "a number";
        default:
            return "a str, one of " + std::string(info.choices);
    }
}

void set_item(Frame& self, const Given& name, const Given& value) { set_setting(self, to_text(name), value); }

py::object get_item(const Frame& self, const std::string& name) {
    const std::optional<lb_setting_info> info = find_setting(name);
    if (info && info->type == LB_SETTING_CHOICE) {
        return to_str(in_library([&] { return self.handle.choice(name); }).c_str());
    }
    const double value = in_library([&] { return self.handle.number(name); });
    if (info->type == LB_SETTING_INTEGER) {
        return py::int_(std::llround(value));
    }
    return py::float_(value);
}

// Between the parts of a frame Python may raise KeyboardInterrupt, run other threads, and be told how far it is.
void render(Frame& self, const Scene& scene, const Given& given) {
    const py::object progress = to_callable(given);
    const py::object cancel = py::module_::import("lightband._records").attr("CANCEL");
    const lightband::Progress step = [&](double fraction) {
        CallbackScope callback;
        if (surviving_finalization([] { return PyErr_CheckSignals(); }) != 0) {
            throw py::error_already_set();
        }
        return !progress.is_none() && call_python(progress, py::make_tuple(fraction)).is(cancel);
    };
    in_library([&] { self.handle.render(scene.handle, step); });
}

py::object stats(const Frame& self) {
    const lb_frame_stats stats = in_library([&] { return self.handle.stats(); });
    const py::tuple values = py::make_tuple(
        stats.width, stats.height, stats.frames, stats.covered_pixels, stats.shaded_pixels, stats.samples,
        stats.saturated_pixels, stats.bent_normals, stats.device_bytes, stats.milliseconds,
        stats.bandwidth_milliseconds, stats.shading_milliseconds, stats.error, stats.noise_error,
        stats.interpolation_error, stats.capped_pixels, stats.rounds, stats.control_pixels, stats.bias_error,
        stats.sampler_replaced != 0);
    return call_python(py::module_::import("lightband._records").attr("FrameStats"), values);
}

py::str plan_for(const Frame& self, const Scene& scene) {
    return to_str(in_library([&] { return self.handle.plan(scene.handle); }).c_str());
}

py::str plan(const Frame& self) {
    return to_str(in_library([&] { return self.handle.explain(); }).c_str());
}

// The names of fields, separated by commas; "" for None.
std::string to_list(const Given& names) {
    constexpr const char* expected = "names of fields, as one str or an iterable of str";
    if (names.value.is_none()) {
        return "";
    }
    if (py::isinstance<py::str>(names.value)) {
        const std::string list = to_text(names);
        if (list.empty()) {
            names.refuse_value("is empty: it must name a field");
        }
        return list;
    }
    PyObject* const iterator = PyBytes_Check(names.value.ptr()) ? nullptr : PyObject_GetIter(names.value.ptr());
    if (iterator == nullptr) {
        if (PyErr_Occurred() != nullptr && PyErr_ExceptionMatches(PyExc_TypeError) == 0) {
            throw py::error_already_set();
        }
        PyErr_Clear();
        names.refuse_type(expected);
    }
    std::string list;
    for (const py::handle name : py::reinterpret_steal<py::iterator>(iterator)) {
        if (!py::isinstance<py::str>(name)) {
            throw WrongType(names.place() + " must be " + expected + " or None; one is " +
                            describe_value(py::reinterpret_borrow<py::object>(name)));
        }
        list += (list.empty() ? "" : ",") +
                to_text({names.function, names.name, py::reinterpret_borrow<py::object>(name)});
    }
    if (list.empty()) {
        names.refuse_value("is empty: it must name a field");
    }
    return list;
}

uint32_t to_choice(const Given& given, const char* first, const char* second) {
    const std::string value = to_text(given);
    if (value != first && value != second) {
        given.refuse_value("is '" + value + "'; it must be '" + first + "' or '" + second + "'");
    }
    return value == first ? 0 : 1;
}

void save(const Frame& self, const std::filesystem::path& path, const Given& names, float exposure, const Given& tone_curve,
          const Given& alpha) {
    const std::string list = to_list(names);
    const uint32_t curve = to_choice(tone_curve, "none", "filmic"), opaque = to_choice(alpha, "coverage", "opaque");
    in_library([&] { self.handle.save(path.string(), list, exposure, curve, opaque); });
}

template <size_t index>
py::array field(const Frame& self) {
    return buffer(self, fields[index].name);
}

template <size_t... indices>
void bind_fields(const FrameClass& type, std::index_sequence<indices...> /*indices*/) {
    (define_property(type, fields[indices].name, &field<indices>, fields[indices].documentation), ...);
}

void bind_settings(const FrameClass& type) {
    define(type, "__getitem__(self, name)", &get_item, "The value of a setting.");
    define(type, "__setitem__(self, name, value)", &set_item, "Sets a setting: a number or, for a choice, its name.");
    define_property(
        type, "settings",
        +[](const Given& self) {
            From<const Frame*>::take(self);
            return call_python(py::module_::import("lightband._records").attr("Settings"), py::make_tuple(self.value));
        },
        "The settings as a mapping from name to value; deleting one restores its default.");
}

void bind_results(const FrameClass& type) {
    define_property(type, "stats", &stats, "Counts and times of the last frame, a FrameStats.");
    define_property(type, "plan", &plan, R"(The passes that the last render ran, as text: each with its reason, bytes and invocations.

Where the setting pass_times is "on", with its milliseconds as well.)");
    define(type, "save(self, path, fields=None, exposure=0.0, tone_curve='none', alpha='coverage')", &save,
           R"(Writes the frame to a file, which is complete or, on any failure, what it was before.

path: ends in ".exr" (float channels, any fields; settings and statistics as attributes) or ".png" (color alone, as sRGB).
fields: names, as a sequence or separated by commas; None: color alone.
The others are for ".png" alone:
exposure: radiance is multiplied by 2**exposure.
tone_curve: "none" shows what is above 1 as 1; "filmic" (Hable 2010) lets it fade towards 1 and leaves mid-grey where it is.
alpha: "coverage" makes a cut-out, in which the background, drawn or not, is transparent; "opaque" shows it.)");
    define(type, "buffer(self, name)", &buffer,
           "A field of the last frame as an array; lightband.buffer_names() lists the names.");
    define(type, "pyramid(self, name)", &pyramid, R"(A pyramid level by level: a list of views of one array.

name: "level_pyramid" or "variance_pyramid". Level k has the size of the frame divided by 2**k, rounded up.)");
    bind_fields(type, std::make_index_sequence<std::size(fields)>());
}

}  // namespace

void set_setting(Frame& self, const std::string& name, const Given& value) {
    if (py::isinstance<py::str>(value.value)) {
        const std::string choice = to_text({value.function, name, value.value});
        in_library([&] { self.handle.set(name, choice); });
        return;
    }
    const std::optional<lb_setting_info> info = find_setting(name);
    const double number = info ? to_double({value.function, name, value.value}, expected_value(*info)) : 0;
    in_library([&] { self.handle.set(name, number); });
}

void bind_frame(py::module_& module) {
    FrameClass type(module, "Frame", frame_documentation, collectable<Frame>());
    refuse_construction(type, "Context.frame makes one");
    bind_closing(type);
    define_property(
        type, "width", +[](const Frame* self) { return self->width; }, "Pixels.");
    define_property(
        type, "height", +[](const Frame* self) { return self->height; }, "Pixels.");
    define(type, "render(self, scene, progress=None)", &render, R"(Renders the scene.

progress: called between parts of the frame with the fraction of the call's time that has passed, which rises
    from 0 to 1; an estimate where the number of rounds is not known beforehand. When it returns lightband.CANCEL,
    the call raises Cancelled; what it raises, the call raises. Any other value is ignored. It must not call the
    library.

Other threads run meanwhile, and Ctrl-C raises KeyboardInterrupt at the next part. After any failure the frame
holds what it held before.)");
    define(type, "plan_for(self, scene)", &plan_for, R"(What render would do for a scene, as text: one line for each pass.

Each with the device memory that it fills, its reason, and the buffers that it reads and writes. Nothing runs.)");
    bind_settings(type);
    bind_results(type);
    define(
        type, "__repr__(self)",
        +[](const Frame* self) {
            return describe("Frame", *self, std::to_string(self->width) + " x " + std::to_string(self->height));
        },
        "The size.");
}

}  // namespace lightband_python
