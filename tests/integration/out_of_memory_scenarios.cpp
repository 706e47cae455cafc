#include "out_of_memory_scenarios.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <utility>

#include "lightband/lightband.hpp"
#include "out_of_memory_files.h"

namespace {

using Setting = std::pair<const char*, double>;
using Choice = std::pair<const char*, const char*>;

constexpr int of_openexr = 40;  // sampled, of files that other libraries read and write; bench/ tries all of them
constexpr uint32_t side = 32;

// Of calls that no allocation fails in.
void ok(lb_result result) {
    if (result == LB_OK) return;
    std::fprintf(stderr, "a call without a failure gave %s: %s\n", lb_result_name(result), lb_error_message());
    std::exit(EXIT_FAILURE);
}

// A field's elements.
template <class Owner>
void append_field(lb_result (*map)(Owner, const char*, lb_buffer*, lb_buffer_view*), Owner owner, const char* name,
                  Bytes* out) {
    lb_buffer buffer = nullptr;
    lb_buffer_view view = LB_BUFFER_VIEW_INIT;
    ok(map(owner, name, &buffer, &view));
    const auto* first = static_cast<const uint8_t*>(view.data);
    out->insert(out->end(), first, first + view.shape[0] * uint64_t(view.strides[0]));
    ok(lb_buffer_release(buffer));
}

// ---- What scenarios share ---------------------------------------------------------------------------------------

// One object of each kind. Null: not made.
struct World {
    lb_context context = nullptr;
    lb_environment environment = nullptr;
    lb_brdf brdf = nullptr;
    lb_mesh mesh = nullptr;
    lb_scene scene = nullptr;
    lb_frame frame = nullptr;
    bool composed = false;  // whether the scene holds its instance

    // All but the context.
    void release() {
        ok(lb_frame_release(std::exchange(frame, nullptr)));
        ok(lb_scene_release(std::exchange(scene, nullptr)));
        ok(lb_mesh_release(std::exchange(mesh, nullptr)));
        ok(lb_brdf_release(std::exchange(brdf, nullptr)));
        ok(lb_environment_release(std::exchange(environment, nullptr)));
        composed = false;
    }
};
World world;

std::string cache;  // folder of built-in materials

void ignore_log(void*, const char*) {}

lb_result make_context(lb_context* context) {
    lb_context_desc desc = LB_CONTEXT_DESC_INIT;
    desc.device = LB_DEVICE_SOFTWARE;
    desc.cache_path = cache.c_str();
    desc.log = ignore_log;
    return lb_context_create(&desc, context);
}

lb_result make_environment() {
    const std::vector<float> rgb = map_in_memory();
    return lb_environment_create(world.context, map_width, map_height, rgb.data(), &world.environment);
}

lb_result make_ggx(float alpha) {
    const float f0[3] = {0.9f, 0.6f, 0.3f};
    return lb_brdf_create_ggx(world.context, alpha, f0, &world.brdf);
}

// So narrow that its bandwidth is known without its being analysed, which would take a second.
lb_result make_brdf() { return make_ggx(0.01f); }

lb_result make_table() {
    static const std::vector<float> values(size_t(90) * 90 * 180 * 3, 0.1f);
    return lb_brdf_create_table(world.context, values.data(), values.size(), &world.brdf);
}

lb_result make_mesh() { return lb_mesh_builtin(world.context, "sphere", 16, &world.mesh); }

// A triangle whose normals are to be computed.
lb_result make_triangle() {
    const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t indices[3] = {0, 1, 2};
    lb_mesh_desc desc = LB_MESH_DESC_INIT;
    desc.vertex_count = 3;
    desc.triangle_count = 1;
    desc.positions = positions;
    desc.indices = indices;
    return lb_mesh_create(world.context, &desc, &world.mesh);
}

// New ones, whose tables are yet to be made.
void make_objects() {
    ok(make_environment());
    ok(make_brdf());
    ok(make_mesh());
}

// Those of a former call, whose tables are there.
void take_objects() {
    static const World kept = [] {
        make_objects();
        return world;
    }();
    world = kept;
    ok(lb_environment_retain(world.environment));
    ok(lb_brdf_retain(world.brdf));
    ok(lb_mesh_retain(world.mesh));
}

void make_scene() {
    lb_camera_desc camera = LB_CAMERA_DESC_INIT;
    camera.eye[2] = 2.0f;
    ok(lb_scene_create(world.context, &world.scene));
    ok(lb_scene_set_environment(world.scene, world.environment));
    ok(lb_scene_set_camera(world.scene, &camera));
    ok(lb_scene_add(world.scene, world.mesh, world.brdf, nullptr, nullptr));
    ok(lb_frame_create(world.context, side, side, &world.frame));
}

void set(const std::vector<Setting>& numbers, const std::vector<Choice>& choices) {
    for (const auto& [name, value] : numbers) ok(lb_frame_set_number(world.frame, name, value));
    for (const auto& [name, value] : choices) ok(lb_frame_set_choice(world.frame, name, value));
}

lb_result render() { return lb_frame_render(world.frame, world.scene, nullptr, nullptr); }

Bytes picture() {
    Bytes bytes;
    append_field(lb_frame_map, world.frame, "color", &bytes);
    append_field(lb_frame_map, world.frame, "error", &bytes);
    append_field(lb_frame_map, world.frame, "sample_count", &bytes);
    return bytes;
}

bool is_rendered() {
    lb_frame_stats stats = LB_FRAME_STATS_INIT;
    return world.frame != nullptr && lb_frame_info(world.frame, &stats) == LB_OK;
}

void release_world() { world.release(); }

// ---- Scenarios --------------------------------------------------------------------------------------------------

// The making of one object; state: of one of its fields, where it is there.
Scenario making(const char* name, int sampled, std::function<lb_result()> make, std::function<Bytes()> state) {
    return {name, sampled, [] {}, std::move(make), std::move(state), release_world};
}

Bytes map_of_environment() {
    Bytes bytes;
    if (world.environment != nullptr) append_field(lb_environment_map, world.environment, "radiance", &bytes);
    return bytes;
}

Bytes albedo_of_brdf() {
    float rgb[3] = {};
    if (world.brdf != nullptr) ok(lb_brdf_albedo(world.brdf, 0.5f, rgb));
    const auto* first = reinterpret_cast<const uint8_t*>(rgb);
    return Bytes(first, first + sizeof rgb);
}

Bytes stats_of_mesh() {
    lb_mesh_stats stats = LB_MESH_STATS_INIT;
    if (world.mesh != nullptr) ok(lb_mesh_info(world.mesh, &stats));
    const auto* first = reinterpret_cast<const uint8_t*>(&stats);
    return Bytes(first, first + sizeof stats);
}

Scenario loading(const char* name, int sampled, const std::string& path) {
    const auto load = [path] { return lb_environment_load(world.context, path.c_str(), &world.environment); };
    Scenario scenario = making(name, sampled, load, map_of_environment);
    scenario.recovers = true;
    return scenario;
}

Scenario loading_brdf(const std::string& path) {
    const auto load = [path] { return lb_brdf_load(world.context, path.c_str(), &world.brdf); };
    Scenario scenario = making("load_brdf", 1, load, albedo_of_brdf);
    scenario.prepare = [path] {
        if (!std::filesystem::exists(path)) write_merl(path);
    };
    return scenario;
}

// Everything that a scene and a frame are told. After a failure it goes on from there.
lb_result compose() {
    lb_camera_desc camera = LB_CAMERA_DESC_INIT;
    camera.eye[2] = 2.0f;
    double samples;
    lb_result result = LB_OK;
    const auto step = [&](auto call) {
        if (result == LB_OK) result = call();
    };
    if (world.scene == nullptr) step([] { return lb_scene_create(world.context, &world.scene); });
    if (world.frame == nullptr) step([] { return lb_frame_create(world.context, side, side, &world.frame); });
    step([] { return lb_scene_set_environment(world.scene, world.environment); });
    step([&] { return lb_scene_set_camera(world.scene, &camera); });
    step([] { return lb_frame_set_number(world.frame, "samples", 8); });
    step([] { return lb_frame_set_choice(world.frame, "environment_lookup", "nearest"); });
    step([&] { return lb_frame_get_number(world.frame, "samples", &samples); });
    if (!world.composed) step([] { return lb_scene_add(world.scene, world.mesh, world.brdf, nullptr, nullptr); });
    world.composed = result == LB_OK;
    return result;
}

Scenario composing() {
    const auto state = [] {
        double samples = 0;
        if (world.composed) ok(lb_frame_get_number(world.frame, "samples", &samples));
        return Bytes(1, uint8_t(samples));
    };
    return {"compose", 40, take_objects, compose, state, release_world};
}

// The first render of objects whose tables are made for it, in a context that has compiled its programs.
Scenario first_render(const char* name, int sampled, std::vector<Setting> numbers, std::vector<Choice> choices) {
    const auto prepare = [numbers, choices] {
        make_objects();
        make_scene();
        set(numbers, choices);
    };
    const auto state = [] { return !is_rendered() ? Bytes() : picture(); };
    return {name, sampled, prepare, render, state, release_world};
}

// A frame that has a picture already is drawn with another seed.
Scenario next_render(const char* name, int sampled, std::vector<Setting> numbers, std::vector<Choice> choices) {
    const auto prepare = [numbers, choices] {
        take_objects();
        make_scene();
        set(numbers, choices);
        ok(render());
        set({{"seed", 1}}, {});
    };
    return {name, sampled, prepare, render, picture, release_world};
}

// The analysis of a wide lobe, which works on several threads.
Scenario bandwidth_of_brdf() {
    const auto call = [] {
        lb_buffer buffer = nullptr;
        lb_buffer_view view = LB_BUFFER_VIEW_INIT;
        const lb_result result = lb_brdf_map(world.brdf, "bandwidth", &buffer, &view);
        ok(lb_buffer_release(buffer));
        return result;
    };
    return {"brdf_bandwidth", 1, [] { ok(make_ggx(0.2f)); }, call, albedo_of_brdf, release_world};
}

// A material that the library computes and keeps in its cache; state: also what lies there.
Scenario built_in(const char* name, bool cached) {
    const auto make = [] { return lb_brdf_builtin(world.context, "rough-gold", &world.brdf); };
    const auto prepare = [cached] {
        if (!cached) std::filesystem::remove_all(cache);
    };
    const auto state = [] {
        Bytes bytes = albedo_of_brdf();
        if (world.brdf == nullptr) return bytes;
        for (const auto& entry : std::filesystem::directory_iterator(cache)) bytes.push_back(entry.file_size() > 0);
        return bytes;
    };
    return {name, 0, prepare, make, state, release_world};
}

// A call about a picture.
Scenario about_picture(const char* name, int sampled, std::function<lb_result()> call, std::function<Bytes()> state) {
    const auto prepare = [] {
        take_objects();
        make_scene();
        set({{"samples", 4}}, {});
        ok(render());
    };
    return {name, sampled, prepare, std::move(call), std::move(state), release_world};
}

lb_result map_every_field() {
    for (uint32_t i = 0; i < lb_frame_buffer_count(); ++i) {
        lb_buffer buffer = nullptr;
        lb_buffer_view view = LB_BUFFER_VIEW_INIT;
        const lb_result result = lb_frame_map(world.frame, lb_frame_buffer_name(i), &buffer, &view);
        if (result != LB_OK) return result;
        ok(lb_buffer_release(buffer));
    }
    return LB_OK;
}

// A file with what a former call has left in it, and nothing beside it.
Scenario saving(const char* name, int sampled, const std::string& folder, const char* file, const char* fields) {
    const std::string path = folder + "/" + file;
    const auto state = [folder, path] {
        Bytes bytes = file_contents(path);
        for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) bytes.push_back(0);
        return bytes;
    };
    const auto save = [path, fields] {
        lb_save_desc desc = LB_SAVE_DESC_INIT;
        desc.names = fields;
        return lb_frame_save(world.frame, path.c_str(), &desc);
    };
    Scenario scenario = about_picture(name, sampled, save, state);
    scenario.prepare = [render_it = scenario.prepare, path] {
        render_it();
        std::ofstream(path, std::ios::binary) << "former";
    };
    return scenario;
}

// The C++ wrapper releases a handle that a call has made where the wrapper's own memory fails afterwards.
lb_result wrap() {
    const std::vector<float> rgb = map_in_memory();
    std::array<int, 8> received{};  // so large that the callback is kept in memory of its own
    const lightband::Log log = [received](const char* message) mutable { received[0] += *message != 0; };
    const lightband::Context context({LB_DEVICE_SOFTWARE, cache, log});
    const lightband::Environment environment = context.environment(map_width, map_height, rgb.data());
    const lightband::Buffer radiance = environment.map("radiance"), copy = radiance;
    lightband::Scene scene = context.scene();
    scene.set_environment(environment);
    const lightband::Transform identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    scene.add(context.builtin_mesh("sphere", 16), context.ggx(0.01f, {0.9f, 0.6f, 0.3f}), identity);
    lightband::Frame frame = context.frame(side, side);
    frame.set("environment_lookup", "nearest");
    frame.set("samples", frame.number("samples") + 1);
    return frame.choice("environment_lookup") == "nearest" && context.device_name() != "" ? LB_OK : LB_ERROR_INTERNAL;
}

// A context that renders: its programs are compiled.
Scenario fresh_context() {
    static lb_context shared;
    const auto prepare = [] { shared = std::exchange(world.context, nullptr); };
    const auto call = [] {
        if (world.context == nullptr)
            if (const lb_result result = make_context(&world.context)) return result;
        lb_result result = LB_OK;
        if (world.environment == nullptr) result = make_environment();
        if (result == LB_OK && world.brdf == nullptr) result = make_brdf();
        if (result == LB_OK && world.mesh == nullptr) result = make_mesh();
        if (result == LB_OK && !world.composed) result = compose();
        return result == LB_OK ? render() : result;
    };
    const auto state = [] {
        return !is_rendered() ? Bytes() : picture();
    };
    const auto release = [] {
        world.release();
        ok(lb_context_release(std::exchange(world.context, shared)));
    };
    return {"fresh_context", 3, prepare, call, state, release};
}

}  // namespace

std::vector<Scenario> make_scenarios() {
    static const std::string folder = [] {
        std::string name = (std::filesystem::temp_directory_path() / "lightband-memory-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) std::exit(EXIT_FAILURE);
        std::filesystem::create_directory(name + "/saved");
        std::atexit([] { std::filesystem::remove_all(folder); });
        return name;
    }();
    const std::string saved = folder + "/saved";
    cache = folder + "/cache";
    ok(make_context(&world.context));
    return {
        loading("load_dwab", of_openexr, write_exr(folder + "/dwab.exr", Imf::DWAB_COMPRESSION)),
        loading("load_zip", of_openexr, write_exr(folder + "/zip.exr", Imf::ZIP_COMPRESSION)),
        loading("load_hdr", 40, write_hdr(folder + "/map.hdr")),
        making("environment", 40, make_environment, map_of_environment),
        making("brdf", 40, make_brdf, albedo_of_brdf),
        making("brdf_table", 1, make_table, albedo_of_brdf),
        loading_brdf(folder + "/grazing.binary"),
        bandwidth_of_brdf(),
        built_in("builtin_brdf", false),
        built_in("cached_brdf", true),
        making("mesh", 40, make_mesh, stats_of_mesh),
        making("triangle", 40, make_triangle, stats_of_mesh),
        composing(),
        first_render("first_render", 8, {{"samples", 8}}, {}),
        next_render("next_render", 20, {{"samples", 8}}, {}),
        next_render("render_error", 20, {{"target_error", 0.1}}, {{"background", "environment"}}),
        next_render("render_accumulated", 8, {{"samples", 8}, {"accumulate", 2}}, {{"sampler", "combined"}}),
        next_render("render_reference", 20, {{"samples", 4}}, {{"method", "reference"}}),
        about_picture("plan", 40, [] {
            char text[4096];
            return lb_frame_plan(world.frame, world.scene, text, sizeof text, nullptr);
        }, picture),
        about_picture("explain", 40, [] {
            char text[4096];
            return lb_frame_explain(world.frame, text, sizeof text, nullptr);
        }, picture),
        about_picture("fields", 40, map_every_field, picture),
        saving("save_exr", of_openexr, saved, "picture.exr", "color,normal,depth"),
        saving("save_png", of_openexr, saved, "picture.png", "color"),
        {"wrapper", 20, [] {}, wrap, [] { return Bytes(); }, [] {}},
        fresh_context(),
    };
}
