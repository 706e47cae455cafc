// lb_brdf, lb_environment, lb_light, lb_mesh and lb_scene.
#include <algorithm>

#include "api/border.h"
#include "io/image_file.h"
#include "io/merl.h"
#include "lights/sun.h"
#include "materials/builtin_materials.h"
#include "materials/builtin_models.h"
#include "scene/unmeasured_cells.h"

using namespace lightband;
using namespace lightband::api;

namespace {

// read: reads or computes the reflectance, without the device. source: what is wrong where it is not to be had, and
// how.
template <class Read>
lb_result create_brdf(lb_context context, lb_brdf* brdf, Read read, const char* source = "values",
                      lb_result wrong = LB_ERROR_INVALID_ARGUMENT) {
    return border([&] {
        require(brdf, "brdf");
        const auto owner = contexts().get(context, "context");
        Brdf reflectance = read(*owner);
        auto material = owner->device->run([&] { return make<const Material>(owner->device, std::move(reflectance)); });
        material->check_albedo(source, wrong);
        give<lb_brdf>(materials(), std::move(material), brdf);
    });
}

Vec3 unit_range(const float rgb[3], const char* name) {
    require(rgb, name);
    for (int c = 0; c < 3; ++c)
        if (!(rgb[c] >= 0 && rgb[c] <= 1))
            throw Error(LB_ERROR_INVALID_ARGUMENT, text(name, "[", c, "] is ", rgb[c], "; it must be 0 .. 1"));
    return {rgb[0], rgb[1], rgb[2]};
}

Vec3 direction(const float v[3], const char* name) {
    require(v, name);
    const Vec3 d(v[0], v[1], v[2]);
    const double length = glm::length(d);
    if (!(length > 0) || !std::isfinite(length))
        throw Error(LB_ERROR_INVALID_ARGUMENT,
                    text(name, " is (", v[0], ", ", v[1], ", ", v[2], "); it must be a direction"));
    return d / length;
}

void check_map_size(uint32_t width, uint32_t height) {
    if (width < 1 || width > io::max_map_width)
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("width is ", width, "; it must be 1 .. ", io::max_map_width));
    if (height < 1 || height > io::max_map_height)
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("height is ", height, "; it must be 1 .. ", io::max_map_height));
}

template <class Read>
lb_result create_environment(lb_context context, lb_environment* environment, Read read) {
    return border([&] {
        require(environment, "environment");
        const auto owner = contexts().get(context, "context");
        RgbImage map = read(*owner);
        auto light = owner->device->run([&] { return make<const EnvironmentLight>(owner->device, std::move(map)); });
        give<lb_environment>(environments(), std::move(light), environment);
    });
}

template <class Read>
lb_result create_mesh(lb_context context, lb_mesh* mesh, Read read) {
    return border([&] {
        require(mesh, "mesh");
        const auto owner = contexts().get(context, "context");
        const Triangles triangles = read();
        give<lb_mesh>(meshes(), owner->device->run([&] { return make<const Mesh>(owner->device, triangles); }), mesh);
    });
}

template <class Object>
void require_same_device(const Scene& scene, const Object& object, const char* name) {
    if (object.device() != scene.device())
        throw Error(LB_ERROR_INVALID_ARGUMENT, text(name, " belongs to another context than scene"));
}

HostArray environment_field(const EnvironmentLight& light, const std::string& name) {
    const RgbImage& map = light.map();
    if (name == "radiance") return HostArray::of(LB_TYPE_FLOAT32, {map.height, map.width, 3}, "radiance", map.rgb);
    if (name != "bandwidth")
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("there is no field \"", name, "\"; there are radiance, bandwidth"));
    const EnvironmentBandwidth& bandwidth = light.bandwidth(Settings().band_rule());
    std::vector<float> values(size_t(bandwidth.side) * bandwidth.side);
    bandwidth.bandwidth.read(0, GL_RED, GL_FLOAT, values.size() * sizeof(float), values.data());
    return HostArray::of(LB_TYPE_FLOAT32, {bandwidth.side, bandwidth.side}, "1/radian", values);
}

HostArray brdf_field(const Material& material, const std::string& name) {
    if (name == "bandwidth")
        return HostArray::of(LB_TYPE_FLOAT32, {LobeBandwidth::views, LobeBandwidth::side, LobeBandwidth::side},
                             "1/radian", material.bandwidth(Settings().band_rule()).values);
    if (name != "table")
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("there is no field \"", name, "\"; there are table, bandwidth"));
    const auto* table = std::get_if<BrdfTable>(&material.brdf());
    if (table == nullptr) throw Error(LB_ERROR_INVALID_STATE, "field table: the BRDF is analytic and has none");
    return HostArray::of(LB_TYPE_FLOAT32,
                         {BrdfTable::theta_half_cells, BrdfTable::theta_diff_cells, BrdfTable::phi_diff_cells, 3},
                         "1/steradian", table->rgb);
}

BrdfTable table_from(const float* values, size_t count) {
    require(values, "values");
    if (count != BrdfTable::cell_count * 3)
        throw Error(LB_ERROR_INVALID_ARGUMENT,
                    text("count is ", count, "; a table has 90 x 90 x 180 x 3 = ", BrdfTable::cell_count * 3));
    BrdfTable table;
    table.rgb.assign(values, values + count);
    for (size_t i = 0; i < count; i += 3) {
        float* rgb = &table.rgb[i];
        for (int c = 0; c < 3; ++c)
            if (!std::isfinite(rgb[c]) || rgb[c] > largest_reflectance)
                throw Error(LB_ERROR_INVALID_ARGUMENT, text("values[", i + size_t(c), "] is ", rgb[c],
                                                            "; it must be finite and at most ", largest_reflectance));
        if (*std::min_element(rgb, rgb + 3) < 0) std::fill(rgb, rgb + 3, -1.0f);
    }
    return table;
}

}  // namespace

extern "C" {

lb_result lb_brdf_load(lb_context context, const char* path, lb_brdf* brdf) {
    return create_brdf(
        context, brdf,
        [&](const Context& owner) -> Brdf {
            require(path, "path");
            BrdfTable table = io::read_merl(path);
            const UnmeasuredCells count = fill_unmeasured_cells(table);
            if (count.filled + count.left > 0)
                owner.device->log(text(path, ": ", count.filled, " unmeasured cells were filled from measured ones; ",
                                       count.left, " had none to be filled from and reflect nothing"));
            return table;
        },
        path, LB_ERROR_FORMAT);
}

lb_result lb_brdf_load_as_measured(lb_context context, const char* path, lb_brdf* brdf) {
    return create_brdf(
        context, brdf,
        [&](const Context&) -> Brdf {
            require(path, "path");
            return io::read_merl(path);
        },
        path, LB_ERROR_FORMAT);
}

lb_result lb_brdf_builtin(lb_context context, const char* name, lb_brdf* brdf) {
    return create_brdf(context, brdf, [&](const Context& owner) -> Brdf {
        require(name, "name");
        return builtin_material(name, owner.cache_path);
    });
}

uint32_t lb_brdf_builtin_count(void) {
    return uint32_t(builtin_models.size());
}

const char* lb_brdf_builtin_name(uint32_t index) {
    return index < builtin_models.size() ? builtin_models[index].name : nullptr;
}

lb_result lb_brdf_create_table(lb_context context, const float* values, size_t count, lb_brdf* brdf) {
    return create_brdf(context, brdf, [&](const Context&) -> Brdf { return table_from(values, count); });
}

lb_result lb_brdf_create_lambert(lb_context context, const float albedo[3], lb_brdf* brdf) {
    return create_brdf(context, brdf, [&](const Context&) -> Brdf { return Lambert{unit_range(albedo, "albedo")}; });
}

lb_result lb_brdf_create_ggx(lb_context context, float alpha, const float f0[3], lb_brdf* brdf) {
    return create_brdf(context, brdf, [&](const Context&) -> Brdf {
        if (!(alpha >= 1e-4f && alpha <= 1))
            throw Error(LB_ERROR_INVALID_ARGUMENT, text("alpha is ", alpha, "; it must be 0.0001 .. 1"));
        return Ggx{alpha, unit_range(f0, "f0")};
    });
}

lb_result lb_brdf_evaluate(lb_brdf brdf, const float wi[3], const float wo[3], float rgb[3]) {
    return border([&] {
        require(rgb, "rgb");
        const auto material = materials().get(brdf, "brdf");
        const Vec3 value = evaluate(material->brdf(), direction(wi, "wi"), direction(wo, "wo"));
        for (int c = 0; c < 3; ++c) rgb[c] = float(value[c]);
    });
}

lb_result lb_brdf_albedo(lb_brdf brdf, float theta_o, float rgb[3]) {
    return border([&] {
        require(rgb, "rgb");
        const auto material = materials().get(brdf, "brdf");
        if (!(theta_o >= 0 && theta_o < float(pi / 2)))
            throw Error(LB_ERROR_INVALID_ARGUMENT,
                        text("theta_o is ", theta_o, "; it must be at least 0 and below pi / 2"));
        const Vec3 albedo = directional_albedo(material->brdf(), theta_o);
        for (int c = 0; c < 3; ++c) rgb[c] = float(albedo[c]);
    });
}

lb_result lb_environment_load(lb_context context, const char* path, lb_environment* environment) {
    return create_environment(context, environment, [&](const Context& owner) {
        require(path, "path");
        RgbImage map = io::read_image(path);
        for (const std::string& note : map.notes) owner.device->log(text(path, ": ", note));
        check_radiance(map, path, LB_ERROR_FORMAT);
        return map;
    });
}

lb_result lb_environment_create(lb_context context, uint32_t width, uint32_t height, const float* rgb,
                                lb_environment* environment) {
    return create_environment(context, environment, [&](const Context&) {
        require(rgb, "rgb");
        check_map_size(width, height);
        RgbImage map{width, height, std::vector<float>(rgb, rgb + size_t(width) * height * 3), {}};
        check_radiance(map, "rgb", LB_ERROR_INVALID_ARGUMENT);
        return map;
    });
}

lb_result lb_environment_map(lb_environment environment, const char* name, lb_buffer* buffer, lb_buffer_view* view) {
    return border([&] {
        require(name, "name");
        const auto light = environments().get(environment, "environment");
        give_array(light->device()->run([&] { return environment_field(*light, name); }), buffer, view);
    });
}

lb_result lb_brdf_map(lb_brdf brdf, const char* name, lb_buffer* buffer, lb_buffer_view* view) {
    return border([&] {
        require(name, "name");
        const auto material = materials().get(brdf, "brdf");
        give_array(material->device()->run([&] { return brdf_field(*material, name); }), buffer, view);
    });
}

lb_result lb_mesh_create(lb_context context, const lb_mesh_desc* desc, lb_mesh* mesh) {
    return create_mesh(context, mesh, [&] { return Triangles::from(read_struct(desc, "desc")); });
}

lb_result lb_mesh_builtin(lb_context context, const char* name, uint32_t resolution, lb_mesh* mesh) {
    return create_mesh(context, mesh, [&] {
        require(name, "name");
        return Triangles::shape(name, resolution);
    });
}

lb_result lb_mesh_info(lb_mesh mesh, lb_mesh_stats* stats) {
    return border([&] { write_struct(stats, meshes().get(mesh, "mesh")->stats(), "stats"); });
}

lb_result lb_scene_create(lb_context context, lb_scene* scene) {
    return border([&] {
        require(scene, "scene");
        give(scenes(), make<Scene>(contexts().get(context, "context")->device), scene);
    });
}

lb_result lb_scene_set_environment(lb_scene scene, lb_environment environment) {
    return border([&] {
        const auto target = scenes().get(scene, "scene");
        const auto light = environments().get(environment, "environment");
        require_same_device(*target, *light, "environment");
        const auto locked = target->device()->lock();
        target->set_environment(light);
    });
}

lb_result lb_sun_create(lb_context context, const lb_sun_desc* desc, lb_light* light) {
    return border([&] {
        require(light, "light");
        const auto owner = contexts().get(context, "context");
        const Sun sun = SunLight::from(read_struct(desc, "desc"));
        give<lb_light>(lights(), std::shared_ptr<Light>(make<SunLight>(owner->device, sun)), light);
    });
}

lb_result lb_sun_set(lb_light light, const lb_sun_desc* desc) {
    return border([&] {
        const auto target = std::dynamic_pointer_cast<SunLight>(lights().get(light, "light"));
        if (target == nullptr) throw Error(LB_ERROR_INVALID_HANDLE, "light is not a sun");
        const Sun sun = SunLight::from(read_struct(desc, "desc"));
        const auto locked = target->device()->lock();
        target->set(sun);
    });
}

lb_result lb_scene_add_light(lb_scene scene, lb_light light) {
    return border([&] {
        const auto target = scenes().get(scene, "scene");
        const auto added = lights().get(light, "light");
        require_same_device(*target, *added, "light");
        const auto locked = target->device()->lock();
        target->add_light(added);
    });
}

lb_result lb_scene_remove_light(lb_scene scene, lb_light light) {
    return border([&] {
        const auto target = scenes().get(scene, "scene");
        const auto removed = lights().get(light, "light");
        const auto locked = target->device()->lock();
        target->remove_light(removed);
    });
}

lb_result lb_scene_set_camera(lb_scene scene, const lb_camera_desc* camera) {
    return border([&] {
        const auto target = scenes().get(scene, "scene");
        const Camera checked = Camera::from(read_struct(camera, "camera"));
        const auto locked = target->device()->lock();
        target->camera = checked;
    });
}

lb_result lb_scene_add(lb_scene scene, lb_mesh mesh, lb_brdf brdf, const float* transform, uint32_t* index) {
    return border([&] {
        const auto target = scenes().get(scene, "scene");
        Instance instance{meshes().get(mesh, "mesh"), materials().get(brdf, "brdf"), Transform::from(transform), true};
        require_same_device(*target, *instance.mesh, "mesh");
        require_same_device(*target, *instance.material, "brdf");
        const auto locked = target->device()->lock();
        const uint32_t added = target->add(std::move(instance));
        if (index != nullptr) *index = added;
    });
}

lb_result lb_scene_set_transform(lb_scene scene, uint32_t index, const float* transform) {
    return border([&] {
        const auto target = scenes().get(scene, "scene");
        const auto locked = target->device()->lock();
        target->instance(index).transform = Transform::from(transform);
    });
}

lb_result lb_scene_set_double_sided(lb_scene scene, uint32_t index, int32_t double_sided) {
    return border([&] {
        const auto target = scenes().get(scene, "scene");
        const auto locked = target->device()->lock();
        target->instance(index).double_sided = double_sided != 0;
    });
}

}  // extern "C"
