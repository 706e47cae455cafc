// lightband in C++17: the handles of lightband.h as classes, its result codes as exceptions. Header only.
//
//     lightband::Context context({LB_DEVICE_ANY});
//     lightband::Scene scene = context.scene();
//     scene.add(context.builtin_mesh("sphere"), context.load_brdf("nickel.binary"));
//     scene.set_environment(context.load_environment("forest.exr"));
//     scene.set_camera({{0, 0, 3}, {0, 0, 0}});
//     lightband::Frame frame = context.frame(512, 512);
//     frame.render(scene);
//     frame.save("nickel.exr", "color,bandwidth_image");
//
// Every object is a counted reference to the library's: a copy shares it, a move hands it over, the last one gone
// releases it. An object without a handle (default-constructed, which a Context never is, or moved from) may be
// assigned to; any other use is answered with LB_ERROR_INVALID_HANDLE. Units, ranges, threads and the meaning of each
// call stand in lightband.h.
#pragma once

#include <array>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#if defined(__GLIBCXX__)
#include <cxxabi.h>
#endif

#include "lightband/lightband.h"

namespace lightband {

// Inline: users write lightband::Scene, yet the linker sees another name than that of any class of the same name
// within the library, so that a program may link the static library.
inline namespace wrapper {

// ---- Results ----------------------------------------------------------------------------------------------------

// A call failed. what() is the library's message: it names file or argument, field, value and limit.
class Exception : public std::runtime_error {
public:
    Exception(lb_result code, const std::string& message) : std::runtime_error(message), code_(code) {}
    lb_result code() const noexcept { return code_; }
    const char* name() const noexcept { return lb_result_name(code_); }  // "LB_ERROR_FORMAT"

private:
    lb_result code_;
};

// Objects that a callback was the last to hold: the library releases nothing while one runs. They are released when the call that the
// callback interrupted is over, or with the thread.
class PostponedReleases {
public:
    using Release = std::function<lb_result()>;

    static PostponedReleases& of_this_thread() {
        thread_local PostponedReleases releases;
        return releases;
    }
    ~PostponedReleases() { run(); }

    void add(Release release) { waiting_.push_back(std::move(release)); }
    void run() {
        while (!waiting_.empty() && waiting_.back()() != LB_ERROR_INVALID_STATE) {
            waiting_.pop_back();
        }
    }

private:
    std::vector<Release> waiting_;
};

// Turns the result of a C call into an exception.
inline void check(lb_result result) {
    if (result != LB_OK) {
        throw Exception(result, lb_error_message());
    }
    PostponedReleases::of_this_thread().run();
}

// The text as C reads it: a zero byte within would hide the rest.
inline const char* c_text(const std::string& text) {
    if (text.find('\0') != std::string::npos) {
        throw Exception(LB_ERROR_INVALID_ARGUMENT,
                        "the name or path \"" + std::string(text.c_str()) + "...\" contains a zero byte");
    }
    return text.c_str();
}

// ---- Callbacks --------------------------------------------------------------------------------------------------

// A callback that ends its thread (pthread_exit, pthread_cancel) unwinds the stack. The C library aborts where a handler does not pass
// that on.
#if defined(__GLIBCXX__)
using ForcedUnwind = abi::__forced_unwind;
#else
class ForcedUnwind {};
#endif

// Receives messages of driver and library. What it throws is dropped: the C code between cannot pass it on.
using Log = std::function<void(const char* message)>;

// Receives the fraction done, in [0, 1]; returns true to stop. What it throws ends the render call and leaves it.
using Progress = std::function<bool(double fraction)>;

// ---- Counted references -----------------------------------------------------------------------------------------

template <typename Raw, lb_result (*retain)(Raw), lb_result (*release)(Raw)>
class Handle {
public:
    Handle() = default;

    // Takes over one reference. log is the context's: any object may be the last that keeps the context.
    Handle(Raw raw, std::shared_ptr<const Log> log) : raw_(raw), log_(std::move(log)) {}

    Handle(const Handle& other) : raw_(other.raw_), log_(other.log_) {
        if (raw_ != nullptr) {
            check(retain(raw_));
        }
    }
    Handle(Handle&& other) noexcept : raw_(std::exchange(other.raw_, nullptr)), log_(std::move(other.log_)) {}
    Handle& operator=(Handle other) noexcept {
        std::swap(raw_, other.raw_);
        std::swap(log_, other.log_);
        return *this;
    }
    ~Handle() {
        if (raw_ != nullptr && release(raw_) == LB_ERROR_INVALID_STATE) {
            try {
                PostponedReleases::of_this_thread().add([raw = raw_, log = log_] { return release(raw); });
            } catch (const std::bad_alloc&) {  // not even that can be remembered: the object stays
            }
        }
    }

    Raw get() const noexcept { return raw_; }  // for calls of lightband.h; remains this object's
    explicit operator bool() const noexcept { return raw_ != nullptr; }

protected:
    const std::shared_ptr<const Log>& log() const noexcept { return log_; }

private:
    Raw raw_ = nullptr;
    std::shared_ptr<const Log> log_;
};

// ---- Buffers ----------------------------------------------------------------------------------------------------

// One field as an array in host memory: it stays as it is whatever happens to the object it came from.
class Buffer : public Handle<lb_buffer, lb_buffer_retain, lb_buffer_release> {
public:
    Buffer() = default;
    Buffer(lb_buffer raw, const lb_buffer_view& view, std::shared_ptr<const Log> log)
        : Handle(raw, std::move(log)), view_(view) {}

    const lb_buffer_view& view() const noexcept { return view_; }  // type, shape, strides in bytes, unit

    // First element; Element is float, uint32_t or uint8_t and must be the type that the field has.
    template <typename Element>
    const Element* data() const {
        if (view_.type != type_of(Element())) {
            throw Exception(LB_ERROR_INVALID_ARGUMENT, "Buffer::data: the field has elements of another type");
        }
        return static_cast<const Element*>(view_.data);
    }

private:
    static constexpr uint32_t type_of(float) { return LB_TYPE_FLOAT32; }
    static constexpr uint32_t type_of(uint32_t) { return LB_TYPE_UINT32; }
    static constexpr uint32_t type_of(uint8_t) { return LB_TYPE_UINT8; }

    lb_buffer_view view_ = LB_BUFFER_VIEW_INIT;
};

// Calls one of the lb_*_map functions.
template <typename Raw>
Buffer map_field(lb_result (*map)(Raw, const char*, lb_buffer*, lb_buffer_view*), Raw owner, const std::string& name,
                 std::shared_ptr<const Log> log) {
    lb_buffer raw = nullptr;
    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
    check(map(owner, c_text(name), &raw, &view));
    return Buffer(raw, view, std::move(log));
}

// ---- What a scene is made of ------------------------------------------------------------------------------------

using Vector = std::array<float, 3>;
using Transform = std::array<float, 12>;  // three rows of an affine 3x4 matrix, object to world

// Reflectance: made by Context::load_brdf, builtin_brdf, table_brdf, lambert and ggx.
class Brdf : public Handle<lb_brdf, lb_brdf_retain, lb_brdf_release> {
public:
    using Handle::Handle;

    // RGB in 1/steradian; directions in the local frame, +Z is the normal.
    Vector evaluate(const Vector& wi, const Vector& wo) const {
        Vector rgb{};
        check(lb_brdf_evaluate(get(), wi.data(), wo.data(), rgb.data()));
        return rgb;
    }
    // RGB; theta_o in [0, pi/2) radians.
    Vector albedo(float theta_o) const {
        Vector rgb{};
        check(lb_brdf_albedo(get(), theta_o, rgb.data()));
        return rgb;
    }
    Buffer map(const std::string& name) const { return map_field(lb_brdf_map, get(), name, log()); }
};

// Distant light: made by Context::load_environment and environment.
class Environment : public Handle<lb_environment, lb_environment_retain, lb_environment_release> {
public:
    using Handle::Handle;

    Buffer map(const std::string& name) const { return map_field(lb_environment_map, get(), name, log()); }
};

// A sun; lb_sun_desc says what the fields mean.
struct Sun {
    Vector direction{};
    Vector irradiance{};
    float angular_radius = 0;  // zero: that of the sun seen from the earth
};

inline lb_sun_desc described(const Sun& sun) {
    const Vector &direction = sun.direction, &irradiance = sun.irradiance;
    return {sizeof(lb_sun_desc),
            {direction[0], direction[1], direction[2]},
            sun.angular_radius,
            {irradiance[0], irradiance[1], irradiance[2]}};
}

// Other lights: made by Context::sun.
class Light : public Handle<lb_light, lb_light_retain, lb_light_release> {
public:
    using Handle::Handle;

    void set(const Sun& sun) const {
        const lb_sun_desc desc = described(sun);
        check(lb_sun_set(get(), &desc));
    }
};

// Triangles: made by Context::mesh and builtin_mesh.
class Mesh : public Handle<lb_mesh, lb_mesh_retain, lb_mesh_release> {
public:
    using Handle::Handle;

    lb_mesh_stats stats() const {
        lb_mesh_stats stats = LB_MESH_STATS_INIT;
        check(lb_mesh_info(get(), &stats));
        return stats;
    }
};

// Zero means the default that lb_camera_desc names.
struct Camera {
    Vector eye{};     // metres
    Vector target{};  // metres
    Vector up{};
    float fov_y = 0;       // radians
    float near_plane = 0;  // metres
    float far_plane = 0;   // metres
};

class Scene : public Handle<lb_scene, lb_scene_retain, lb_scene_release> {
public:
    using Handle::Handle;

    void set_environment(const Environment& environment) { check(lb_scene_set_environment(get(), environment.get())); }
    void add_light(const Light& light) { check(lb_scene_add_light(get(), light.get())); }
    void remove_light(const Light& light) { check(lb_scene_remove_light(get(), light.get())); }
    void set_camera(const Camera& camera) {
        const Vector &eye = camera.eye, &target = camera.target, &up = camera.up;
        const lb_camera_desc desc = {sizeof(lb_camera_desc),
                                     {eye[0], eye[1], eye[2]},
                                     {target[0], target[1], target[2]},
                                     {up[0], up[1], up[2]},
                                     camera.fov_y,
                                     camera.near_plane,
                                     camera.far_plane};
        check(lb_scene_set_camera(get(), &desc));
    }
    // Returns the instance's number, counted from 0.
    uint32_t add(const Mesh& mesh, const Brdf& brdf, const std::optional<Transform>& transform = std::nullopt) {
        uint32_t index = 0;
        check(lb_scene_add(get(), mesh.get(), brdf.get(), transform ? transform->data() : nullptr, &index));
        return index;
    }
    void set_transform(uint32_t index, const Transform& transform) {
        check(lb_scene_set_transform(get(), index, transform.data()));
    }
    // False: only the front of its triangles is drawn, from which their vertices run counter-clockwise.
    void set_double_sided(uint32_t index, bool double_sided) { check(lb_scene_set_double_sided(get(), index, double_sided)); }
};

// ---- Frame ------------------------------------------------------------------------------------------------------

class Frame : public Handle<lb_frame, lb_frame_retain, lb_frame_release> {
public:
    using Handle::Handle;

    // Settings by name; lb_setting_at lists them.
    void set(const std::string& name, double value) { check(lb_frame_set_number(get(), c_text(name), value)); }
    void set(const std::string& name, const std::string& choice) {
        check(lb_frame_set_choice(get(), c_text(name), c_text(choice)));
    }
    double number(const std::string& name) const {
        double value = 0;
        check(lb_frame_get_number(get(), c_text(name), &value));
        return value;
    }
    std::string choice(const std::string& name) const {
        const char* value = nullptr;
        check(lb_frame_get_choice(get(), c_text(name), &value));
        return value;
    }

    void render(const Scene& scene, const Progress& progress = nullptr) {
        ProgressCall call{progress, nullptr};
        const lb_result result =
            lb_frame_render(get(), scene.get(), progress ? &ProgressCall::forward : nullptr, &call);
        if (call.thrown) {
            std::rethrow_exception(call.thrown);
        }
        check(result);
    }

    lb_frame_stats stats() const {
        lb_frame_stats stats = LB_FRAME_STATS_INIT;
        check(lb_frame_info(get(), &stats));
        return stats;
    }
    // What a render of this scene would do: one line for each pass.
    std::string plan(const Scene& scene) const {
        return text_of([&](char* text, size_t size, size_t* needed) { return lb_frame_plan(get(), scene.get(), text, size, needed); });
    }
    // What the last render did: one line for each pass that ran.
    std::string explain() const {
        return text_of([&](char* text, size_t size, size_t* needed) { return lb_frame_explain(get(), text, size, needed); });
    }
    Buffer map(const std::string& name) const { return map_field(lb_frame_map, get(), name, log()); }

    // names: comma-separated fields for an .exr file; empty: color alone. The others are for a .png file.
    void save(const std::string& path, const std::string& names = "", float exposure = 0,
              uint32_t tone_curve = LB_TONE_NONE, uint32_t alpha = LB_ALPHA_COVERAGE) const {
        lb_save_desc desc = LB_SAVE_DESC_INIT;
        desc.names = names.empty() ? nullptr : c_text(names);
        desc.exposure = exposure;
        desc.tone_curve = tone_curve;
        desc.alpha = alpha;
        check(lb_frame_save(get(), c_text(path), &desc));
    }

private:
    template <class Write>
    std::string text_of(Write write) const {
        size_t needed = 0;  // with the final 0
        check(write(nullptr, size_t(0), &needed));
        std::vector<char> text(needed);
        check(write(text.data(), text.size(), &needed));
        return std::string(text.data());
    }

    // Carries an exception of the callback past the C code.
    struct ProgressCall {
        const Progress& progress;
        std::exception_ptr thrown;

        static int32_t forward(void* user, double fraction) {
            ProgressCall& call = *static_cast<ProgressCall*>(user);
            try {
                return call.progress(fraction) ? 1 : 0;
            } catch (ForcedUnwind&) {
                throw;
            } catch (...) {
                call.thrown = std::current_exception();
                return 1;
            }
        }
    };
};

// ---- Context ----------------------------------------------------------------------------------------------------

struct ContextOptions {
    uint32_t device = LB_DEVICE_HARDWARE;
    std::optional<std::string> cache_path = std::nullopt;  // none: the user's cache folder; "": no cache
    Log log = nullptr;                                     // lives as long as the context and all that is made from it
};

// One OpenGL device; everything else is made by it and keeps it alive.
class Context : public Handle<lb_context, lb_context_retain, lb_context_release> {
public:
    explicit Context(const ContextOptions& options = {}) : Handle(create(options)) {}

    std::string device_name() const {
        const char* name = nullptr;
        check(lb_context_device_name(get(), &name));
        return name;
    }
    bool is_software() const {
        uint32_t software = 0;
        check(lb_context_is_software(get(), &software));
        return software != 0;
    }

    // fill_unmeasured: whether cells that were not measured are filled from those that were; else they reflect nothing.
    Brdf load_brdf(const std::string& path, bool fill_unmeasured = true) const {
        return make<Brdf>(fill_unmeasured ? lb_brdf_load : lb_brdf_load_as_measured, c_text(path));
    }
    Brdf builtin_brdf(const std::string& name) const { return make<Brdf>(lb_brdf_builtin, c_text(name)); }
    // values: [90][90][180][3], 1/steradian.
    Brdf table_brdf(const float* values, size_t count) const { return make<Brdf>(lb_brdf_create_table, values, count); }
    Brdf lambert(const Vector& albedo) const { return make<Brdf>(lb_brdf_create_lambert, albedo.data()); }
    Brdf ggx(float alpha, const Vector& f0) const { return make<Brdf>(lb_brdf_create_ggx, alpha, f0.data()); }

    Environment load_environment(const std::string& path) const {
        return make<Environment>(lb_environment_load, c_text(path));
    }
    // rgb: [height][width][3], radiance.
    Environment environment(uint32_t width, uint32_t height, const float* rgb) const {
        return make<Environment>(lb_environment_create, width, height, rgb);
    }

    Light sun(const Sun& sun) const {
        const lb_sun_desc desc = described(sun);
        return make<Light>(lb_sun_create, &desc);
    }

    Mesh mesh(const lb_mesh_desc& desc) const { return make<Mesh>(lb_mesh_create, &desc); }
    Mesh builtin_mesh(const std::string& name, uint32_t resolution = 0) const {
        return make<Mesh>(lb_mesh_builtin, c_text(name), resolution);
    }

    Scene scene() const { return make<Scene>(lb_scene_create); }
    Frame frame(uint32_t width, uint32_t height) const { return make<Frame>(lb_frame_create, width, height); }

private:
    static Handle create(const ContextOptions& options) {
        auto log = options.log ? std::make_shared<const Log>(options.log) : nullptr;
        lb_context_desc desc = LB_CONTEXT_DESC_INIT;
        desc.device = options.device;
        desc.log = log ? &forward_log : nullptr;
        desc.log_user = const_cast<Log*>(log.get());
        desc.cache_path = options.cache_path ? c_text(*options.cache_path) : nullptr;
        lb_context raw = nullptr;
        check(lb_context_create(&desc, &raw));
        return Handle(raw, std::move(log));
    }

    static void forward_log(void* user, const char* message) {
        try {
            (*static_cast<const Log*>(user))(message);
        } catch (ForcedUnwind&) {
            throw;
        } catch (...) {
            // See Log.
        }
    }

    // Calls create(context, arguments..., &raw) and wraps what it made.
    template <typename Object, typename Create, typename... Arguments>
    Object make(Create create_object, Arguments... arguments) const {
        decltype(Object().get()) raw = nullptr;
        check(create_object(get(), arguments..., &raw));
        return Object(raw, log());
    }
};

}  // namespace wrapper
}  // namespace lightband
