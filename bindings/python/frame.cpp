// lightband.Frame: a picture's size and settings, its rendering, and its fields as arrays.
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <filesystem>

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
    {"bandwidth_reflected",
     "float32, height x width: cycles/radian of the mirror direction, of the light that the lobe keeps; larger towards grazing angles. "
     "0 in a frame that did not interpolate over directions."},
    {"level",
     "uint8, height x width: log2 of the spacing at which the pixel may be shaded (eq. 11, Nyquist)."},
    {"cell_level",
     "uint8, height x width: log2 of the cells along a side of the square of mirror directions that the pixel asks for; 15 where it asks "
     "for finer ones than there are. 0 in a frame that did not interpolate over directions."},
    {"shaded", "uint8, height x width: 1 where the integral was computed; 0: interpolated, or nothing seen."},
    {"sample_count", "uint32, height x width: light samples drawn, by one of the frames that are accumulated."},
    {"error", "float32, height x width: error of the luminance L that is expected here, over L + 0.01 of the frame's mean L."},
    {"variance_predicted",
     "float32, height x width: radiance^2, predicted variance of one light sample's luminance, by the setting \"variance\" "
     "(eq. 9 where that is \"printed\")."},
    {"variance_measured",
     "float32, height x width: radiance^2, the same from the samples drawn; 0 where fewer than two were drawn."},
    {"level_pyramid",
     "uint8, rows x width: the levels' min pyramid, level below level; 255 where nothing is seen. pyramid() takes it "
     "apart."},
    {"variance_pyramid",
     "float32, rows x width: the relative variances' max pyramid, level below level; pyramid() takes it apart."},
};

constexpr const char* common_documentation = R"(

Rows run top-down; pixels that see no mesh hold 0 unless said otherwise. The array is read-only and shows the
library's memory without a copy; it stays as it is when the frame renders again or is deleted. Each access reads the
field back from the device anew: keep the array. Equations: Bagher et al. 2013.)";

py::array buffer(const Frame& self, const std::string& name) {
    return to_array(name, in_library([&] { return self.handle.map(name); }));
}

// Level k of a pyramid is ceil(height / 2^k) x ceil(width / 2^k) and lies below level k - 1.
py::list pyramid(const Frame& self, const std::string& name) {
    if (name != "level_pyramid" && name != "variance_pyramid") {
        throw lightband::Exception(LB_ERROR_INVALID_ARGUMENT, "name: \"" + name + "\" is not a pyramid");
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

void set_setting(Frame& self, const std::string& name, const py::object& value) {
    if (py::isinstance<py::str>(value)) {
        const std::string choice = py::cast<std::string>(value);
        in_library([&] { self.handle.set(name, choice); });
        return;
    }
    const double number = PyFloat_AsDouble(value.ptr());
    if (number == -1.0 && PyErr_Occurred() != nullptr) {
        throw py::error_already_set();
    }
    in_library([&] { self.handle.set(name, number); });
}

// Type of a setting; LB_SETTING_REAL for an unknown name, at which the call that follows fails.
uint32_t setting_type(const std::string& name) {
    for (uint32_t i = 0; i < lb_setting_count(); ++i) {
        lb_setting_info info = LB_SETTING_INFO_INIT;
        lightband::check(lb_setting_at(i, &info));
        if (name == info.name) {
            return info.type;
        }
    }
    return LB_SETTING_REAL;
}

py::object get_setting(const Frame& self, const std::string& name) {
    const uint32_t type = in_library([&] { return setting_type(name); });
    if (type == LB_SETTING_CHOICE) {
        return to_str(in_library([&] { return self.handle.choice(name); }).c_str());
    }
    const double value = in_library([&] { return self.handle.number(name); });
    if (type == LB_SETTING_INTEGER) {
        return py::int_(std::llround(value));
    }
    return py::float_(value);
}

// Between the parts of a frame Python may raise KeyboardInterrupt, run other threads, and be told how far it is.
void render(Frame& self, const Scene& scene, const py::object& progress) {
    if (!progress.is_none() && PyCallable_Check(progress.ptr()) == 0) {
        throw py::type_error("progress: a callable or None is expected");
    }
    const lightband::Progress step = [&progress](double fraction) {
        CallbackScope callback;
        if (PyErr_CheckSignals() != 0) {
            throw py::error_already_set();
        }
        if (progress.is_none()) {
            return false;
        }
        const int stop = PyObject_IsTrue(progress(fraction).ptr());
        if (stop == -1) {
            throw py::error_already_set();
        }
        return stop == 1;
    };
    in_library([&] { self.handle.render(scene.handle, step); });
}

py::object stats(const Frame& self) {
    const lb_frame_stats stats = in_library([&] { return self.handle.stats(); });
    return py::module_::import("lightband._records")
        .attr("FrameStats")(stats.width, stats.height, stats.frames, stats.covered_pixels, stats.shaded_pixels,
                            stats.samples, stats.saturated_pixels, stats.bent_normals, stats.device_bytes,
                            stats.milliseconds, stats.bandwidth_milliseconds, stats.shading_milliseconds, stats.error,
                            stats.noise_error, stats.interpolation_error, stats.capped_pixels, stats.rounds,
                            stats.audited_pixels, stats.bias_error, stats.sampler_replaced != 0);
}

py::str plan(const Frame& self) {
    return to_str(in_library([&] { return self.handle.explain(); }).c_str());
}

void save(const Frame& self, const std::filesystem::path& path, const py::object& names, float exposure) {
    std::string list;
    if (py::isinstance<py::str>(names)) {
        list = py::cast<std::string>(names);
    } else if (!names.is_none()) {
        list = py::cast<std::string>(py::str(",").attr("join")(names));
    }
    if (!names.is_none() && list.empty()) {
        throw lightband::Exception(LB_ERROR_INVALID_ARGUMENT, "fields: none is named");
    }
    in_library([&] { self.handle.save(path.string(), list, exposure); });
}

void bind_settings(FrameClass& type) {
    type.def("__getitem__", &get_setting, py::arg("name"), "The value of a setting.");
    type.def("__setitem__", &set_setting, py::arg("name"), py::arg("value"),
             "Sets a setting: a number or, for a choice, its name.");
    type.def_property_readonly(
        "settings",
        [](const py::object& self) { return py::module_::import("lightband._records").attr("Settings")(self); },
        "The settings as a mapping from name to value; deleting one restores its default.");
}

void bind_results(FrameClass& type) {
    type.def_property_readonly("stats", &stats, "Counts and times of the last frame, a FrameStats.");
    type.def_property_readonly("plan", &plan, "The passes of the last frame as text, each with its reason and cost.");
    type.def("save", &save, py::arg("path"), py::arg("fields") = py::none(), py::arg("exposure") = 0.0f,
             R"(Writes the frame to a file, which is complete or not there.

path: ends in ".exr" (float channels, any fields) or ".png" (color alone, as sRGB times 2**exposure).
fields: names, as a sequence or separated by commas; None: color alone.)");
    type.def("buffer", &buffer, py::arg("name"),
             (std::string("A field of the last frame as an array; lightband.buffer_names() lists the names.") +
              common_documentation)
                 .c_str());
    type.def("pyramid", &pyramid, py::arg("name"), R"(A pyramid level by level: a list of views of one array.

name: "level_pyramid" or "variance_pyramid". Level k has the size of the frame divided by 2**k, rounded up.)");
    for (const Field& field : fields) {
        type.def_property_readonly(
            field.name, [name = field.name](const Frame& self) { return buffer(self, name); },
            (std::string(field.documentation) + common_documentation).c_str());
    }
}

}  // namespace

void bind_frame(py::module_& module) {
    FrameClass type(module, "Frame", R"(A picture's size and settings; renders scenes and holds their fields.

Made by Context.frame. Settings are read and written by name: frame["samples"] = 64.)");
    bind_closing(type);
    type.def_property_readonly(
        "width", [](const Frame& self) { return self.width; }, "Pixels.");
    type.def_property_readonly(
        "height", [](const Frame& self) { return self.height; }, "Pixels.");
    type.def("render", &render, py::arg("scene"), py::arg("progress") = py::none(), R"(Renders the scene.

progress: called between parts of the frame with the fraction done, in [0, 1]. When it returns a true value, the call
    raises Cancelled; what it raises, the call raises. It must not call the library.

Other threads run meanwhile, and Ctrl-C raises KeyboardInterrupt at the next part. After any failure the frame holds
what it held before.)");
    bind_settings(type);
    bind_results(type);
    type.def("__repr__", [](const Frame& self) {
        return describe("Frame", self, std::to_string(self.width) + " x " + std::to_string(self.height));
    });
}

}  // namespace lightband_python
