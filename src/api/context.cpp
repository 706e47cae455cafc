// lb_context, and retaining and releasing every kind of object.
#include <cstdlib>

#include "api/border.h"
#include "base/process.h"

using namespace lightband;
using namespace lightband::api;

namespace {

std::string default_cache_path() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache != 0)
        return std::string(cache) + "/lightband";
    if (const char* home = std::getenv("HOME"); home != nullptr && *home != 0)
        return std::string(home) + "/.cache/lightband";
    return "";
}

template <class Object>
lb_result retain(HandleTable<Object>& table, const void* handle) {
    return border([&] { table.retain(handle); });
}

// Where the process was forked or ends, nothing is released, and no destructor of the host has to hear of it.
template <class Object>
lb_result release(HandleTable<Object>& table, const void* handle) {
    if (handle == nullptr) return LB_OK;
    if (!HostThread::in_callback() && refusal() != nullptr) return LB_OK;
    return border([&] { table.release(handle); });
}

}  // namespace

extern "C" {

lb_result lb_context_create(const lb_context_desc* desc, lb_context* context) {
    return border([&] {
        require(context, "context");
        lb_context_desc described = LB_CONTEXT_DESC_INIT;
        if (desc != nullptr) described = read_struct(desc, "desc");
        if (described.device > LB_DEVICE_ANY)
            throw Error(LB_ERROR_INVALID_ARGUMENT,
                        text("desc: device is ", described.device, "; it must be LB_DEVICE_HARDWARE (0), ",
                             "LB_DEVICE_SOFTWARE (1) or LB_DEVICE_ANY (2)"));
        const auto made = std::make_shared<Context>();
        made->cache_path = described.cache_path != nullptr ? described.cache_path : default_cache_path();
        claim_process();
        made->device = std::make_shared<gl::Device>(described.device, described.log, described.log_user);
        made->device->log(text("rendering on ", made->device->name()));
        give(contexts(), made, context);
    });
}

lb_result lb_context_device_name(lb_context context, const char** name) {
    return border([&] {
        require(name, "name");
        *name = contexts().get(context, "context")->device->name().c_str();
    });
}

lb_result lb_context_is_software(lb_context context, uint32_t* software) {
    return border([&] {
        require(software, "software");
        *software = contexts().get(context, "context")->device->software() ? 1 : 0;
    });
}

lb_result lb_context_retain(lb_context context) {
    return retain(contexts(), context);
}
lb_result lb_context_release(lb_context context) {
    return release(contexts(), context);
}
lb_result lb_brdf_retain(lb_brdf brdf) {
    return retain(materials(), brdf);
}
lb_result lb_brdf_release(lb_brdf brdf) {
    return release(materials(), brdf);
}
lb_result lb_environment_retain(lb_environment environment) {
    return retain(environments(), environment);
}
lb_result lb_environment_release(lb_environment environment) {
    return release(environments(), environment);
}
lb_result lb_light_retain(lb_light light) {
    return retain(lights(), light);
}
lb_result lb_light_release(lb_light light) {
    return release(lights(), light);
}
lb_result lb_mesh_retain(lb_mesh mesh) {
    return retain(meshes(), mesh);
}
lb_result lb_mesh_release(lb_mesh mesh) {
    return release(meshes(), mesh);
}
lb_result lb_scene_retain(lb_scene scene) {
    return retain(scenes(), scene);
}
lb_result lb_scene_release(lb_scene scene) {
    return release(scenes(), scene);
}
lb_result lb_frame_retain(lb_frame frame) {
    return retain(frames(), frame);
}
lb_result lb_frame_release(lb_frame frame) {
    return release(frames(), frame);
}
lb_result lb_buffer_retain(lb_buffer buffer) {
    return retain(arrays(), buffer);
}
lb_result lb_buffer_release(lb_buffer buffer) {
    return release(arrays(), buffer);
}

}  // extern "C"
