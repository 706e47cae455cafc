// lb_frame and its settings.
#include <algorithm>
#include <cstring>
#include <iterator>

#include "api/border.h"
#include "frame/save.h"

using namespace lightband;
using namespace lightband::api;

namespace {

void write_text(const std::string& whole, char* text, size_t size, size_t* needed) {
    if (size > 0) {
        require(text, "text");
        const size_t length = std::min(whole.size(), size - 1);
        std::memcpy(text, whole.data(), length);
        text[length] = 0;
    }
    if (needed != nullptr) *needed = whole.size() + 1;
}

}  // namespace

extern "C" {

lb_result lb_frame_create(lb_context context, uint32_t width, uint32_t height, lb_frame* frame) {
    return border([&] {
        require(frame, "frame");
        give(frames(), make<Frame>(contexts().get(context, "context")->device, width, height), frame);
    });
}

lb_result lb_frame_set_number(lb_frame frame, const char* name, double value) {
    return border([&] {
        require(name, "name");
        const auto target = frames().get(frame, "frame");
        const auto locked = target->device()->lock();
        target->settings.set_number(name, value);
    });
}

lb_result lb_frame_set_choice(lb_frame frame, const char* name, const char* value) {
    return border([&] {
        require(name, "name");
        require(value, "value");
        const auto target = frames().get(frame, "frame");
        const auto locked = target->device()->lock();
        target->settings.set_choice(name, value);
    });
}

lb_result lb_frame_get_number(lb_frame frame, const char* name, double* value) {
    return border([&] {
        require(name, "name");
        require(value, "value");
        const auto source = frames().get(frame, "frame");
        const auto locked = source->device()->lock();
        *value = source->settings.number(name);
    });
}

lb_result lb_frame_get_choice(lb_frame frame, const char* name, const char** value) {
    return border([&] {
        require(name, "name");
        require(value, "value");
        const auto source = frames().get(frame, "frame");
        const auto locked = source->device()->lock();
        *value = source->settings.choice(name);
    });
}

uint32_t lb_setting_count(void) {
    return Settings::count();
}

lb_result lb_setting_at(uint32_t index, lb_setting_info* info) {
    return border([&] {
        if (index >= Settings::count())
            throw Error(LB_ERROR_INVALID_ARGUMENT,
                        text("index is ", index, "; there are ", Settings::count(), " settings"));
        write_struct(info, Settings::info(index), "info");
    });
}

lb_result lb_frame_render(lb_frame frame, lb_scene scene, lb_progress_callback progress, void* user) {
    return border([&] {
        const auto target = frames().get(frame, "frame");
        const auto source = scenes().get(scene, "scene");
        gl::Device& device = *target->device();
        const auto report = [&](double fraction) {
            device.checkpoint();
            int32_t cancelled = 0;
            if (progress != nullptr) device.call_back([&] { cancelled = progress(user, fraction); });
            return cancelled != 0;
        };
        device.run([&] { target->render(*source, report); });
    });
}

lb_result lb_frame_info(lb_frame frame, lb_frame_stats* stats) {
    return border([&] {
        const auto source = frames().get(frame, "frame");
        const auto locked = source->device()->lock();
        write_struct(stats, source->stats(), "stats");
    });
}

lb_result lb_frame_plan(lb_frame frame, lb_scene scene, char* text, size_t size, size_t* needed) {
    return border([&] {
        const auto target = frames().get(frame, "frame");
        const auto source = scenes().get(scene, "scene");
        const auto locked = target->device()->lock();
        write_text(target->plan(*source), text, size, needed);
    });
}

lb_result lb_frame_explain(lb_frame frame, char* text, size_t size, size_t* needed) {
    return border([&] {
        const auto source = frames().get(frame, "frame");
        const auto locked = source->device()->lock();
        write_text(source->explain(), text, size, needed);
    });
}

lb_result lb_frame_map(lb_frame frame, const char* name, lb_buffer* buffer, lb_buffer_view* view) {
    return border([&] {
        require(name, "name");
        const auto source = frames().get(frame, "frame");
        give_array(source->device()->run([&] { return source->field(name); }), buffer, view);
    });
}

uint32_t lb_frame_buffer_count(void) {
    return uint32_t(std::size(field_names));
}

const char* lb_frame_buffer_name(uint32_t index) {
    return index < std::size(field_names) ? field_names[index].name : nullptr;
}

lb_result lb_frame_save(lb_frame frame, const char* path, const lb_save_desc* desc) {
    return border([&] {
        require(path, "path");
        lb_save_desc described = LB_SAVE_DESC_INIT;
        if (desc != nullptr) described = read_struct(desc, "desc");
        if (described.tone_curve > LB_TONE_FILMIC)
            throw Error(LB_ERROR_INVALID_ARGUMENT, text("desc: tone_curve is ", described.tone_curve,
                                                        "; it must be LB_TONE_NONE (0) or LB_TONE_FILMIC (1)"));
        if (described.alpha > LB_ALPHA_OPAQUE)
            throw Error(LB_ERROR_INVALID_ARGUMENT, text("desc: alpha is ", described.alpha,
                                                        "; it must be LB_ALPHA_COVERAGE (0) or LB_ALPHA_OPAQUE (1)"));
        const io::Display display{described.exposure,
                                  described.tone_curve == LB_TONE_FILMIC ? io::ToneCurve::filmic : io::ToneCurve::none,
                                  described.alpha == LB_ALPHA_OPAQUE};
        const auto source = frames().get(frame, "frame");
        source->device()->run(
            [&] { save(*source, path, described.names != nullptr ? described.names : "color", display); });
    });
}

}  // extern "C"
