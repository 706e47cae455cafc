#include "frame/frame.h"

#include <algorithm>
#include <cmath>

#include "frame/result.h"
#include "passes/gbuffer.h"

namespace lightband {
namespace {

// Adds a frame's radiance to a sum in double precision.
void add_radiance(const gl::Texture& radiance, std::vector<float>* scratch, std::vector<double>* sum) {
    scratch->resize(sum->size());
    radiance.read(0, GL_RGBA, GL_FLOAT, scratch->size() * sizeof(float), scratch->data());
    for (size_t i = 0; i < sum->size(); ++i) (*sum)[i] += double((*scratch)[i]);
}

}  // namespace

Frame::Frame(gl::DevicePtr device, uint32_t width, uint32_t height)
    : device_(std::move(device)), width_(width), height_(height) {
    for (const auto& [side, name] : {std::pair(width, "width"), std::pair(height, "height")})
        if (side < 1 || side > largest_side)
            throw Error(LB_ERROR_INVALID_ARGUMENT, text(name, " is ", side, "; it must be 1 .. ", largest_side));
}

const Frame::Result& Frame::result() const {
    if (result_ == nullptr) throw Error(LB_ERROR_INVALID_STATE, "the frame has not been rendered yet");
    return *result_;
}

void Frame::render(const Scene& scene, const Progress& progress) {
    if (scene.device() != device_) throw Error(LB_ERROR_INVALID_ARGUMENT, "scene belongs to another context than frame");
    if (!scene.light) throw Error(LB_ERROR_INVALID_STATE, "the scene has no environment");
    if (!scene.camera) throw Error(LB_ERROR_INVALID_STATE, "the scene has no camera");
    const gl::Functions& gl = device_->gl();
    if (sequence_ == nullptr) sequence_ = std::make_unique<passes::SequenceTable>(gl);
    const auto next = std::make_shared<Result>(gl, width_, height_);
    next->settings = settings;
    next->eye = scene.camera->eye;
    const uint64_t pixels = uint64_t(width_) * height_;
    if (progress && progress(0.0)) throw Error(LB_ERROR_CANCELLED, "the progress callback cancelled the frame");

    passes::gbuffer(*device_, scene, width_, height_, next->gbuffer);
    next->plan.finished("gbuffer", text(scene.instances().size(), " instances"), next->gbuffer.bytes(), pixels, "pixels");

    const Scene::Slots slots = scene.slots();
    const passes::SlotTable slot_of = passes::slot_table(gl, slots);
    passes::Counts counts;
    predict(scene, next.get(), &counts, slot_of, slots);
    const passes::ShadingList list =
        passes::shading_list(*device_, slot_of, counts, settings, width_, height_, next->gbuffer, next->shading);
    next->plan.finished("list", "pixels to shade, longest first", list.entries.bytes(), pixels, "pixels");

    shade(scene, next.get(), list, slots, progress);
    device_->check("rendering a frame");

    lb_frame_stats& stats = next->stats;
    stats.width = width_;
    stats.height = height_;
    stats.frames = settings.accumulate();
    stats.covered_pixels = counts.covered;
    stats.shaded_pixels = list.pixels;
    stats.saturated_pixels = counts.saturated;
    stats.bent_normals = counts.bent;
    stats.device_bytes = scene.device_bytes() + next->gbuffer.bytes() + next->shading.bytes() +
                         (next->prediction ? next->prediction->bytes() : 0) + list.entries.bytes() + sequence_->buffer.bytes();
    stats.milliseconds = next->plan.total_milliseconds();
    stats.bandwidth_milliseconds = next->plan.milliseconds_of({"environment", "bandwidth", "pyramids", "classify", "list"});
    stats.shading_milliseconds = next->plan.milliseconds_of({"shade"});
    result_ = next;
}

void Frame::predict(const Scene& scene, Result* next, passes::Counts* counts, const passes::SlotTable& slot_of,
                    const Scene::Slots& slots) const {
    const uint64_t pixels = uint64_t(width_) * height_;
    const Prediction* prediction = nullptr;
    if (settings.method() == Method::adaptive) {
        scene.light->bandwidth(settings.band_rule());
        for (const Material* material : slots.materials) material->pilots(settings.band_rule(), settings.pilots());
        next->plan.finished("environment", "bandwidth of the map and the lobes; once for each", scene.light->device_bytes(), 0, "");

        next->prediction.emplace(device_->gl(), width_, height_, settings.coarsest_level());
        prediction = &*next->prediction;
        passes::predict(*device_, scene, slots, slot_of, settings, width_, height_, next->gbuffer, *prediction);
        next->plan.finished("bandwidth", text("eq. 5, 6 and 9 with ", settings.pilots(), " directions"),
                            prediction->bandwidth.bytes() + prediction->prediction.bytes(), pixels, "pixels");
        const passes::Forecast forecast = passes::forecast(*device_, next->gbuffer, *prediction, width_, height_);
        passes::pyramids(*device_, forecast, settings, next->gbuffer, width_, height_, *prediction);
        next->plan.finished("pyramids", text("least level and largest variance of each block, bandwidth times ",
                                             passes::bandwidth_scale(settings, forecast)),
                            prediction->levels.bytes() + prediction->variances.bytes(), pixels, "pixels");
    }
    *counts = passes::classify(*device_, *scene.camera, slot_of, slots.materials.size(), settings, width_, height_,
                               next->gbuffer, prediction, next->shading);
    next->plan.finished("classify", prediction != nullptr ? "shade or interpolate" : "every covered pixel is shaded",
                        next->shading.decision.bytes(), pixels, "pixels");
}

void Frame::shade(const Scene& scene, Result* next, const passes::ShadingList& list, const Scene::Slots& slots,
                  const Progress& progress) {
    const gl::Functions& gl = device_->gl();
    const float zero[4] = {0, 0, 0, 0};
    gl.ClearTexImage(next->shading.radiance.name(), 0, GL_RGBA, GL_FLOAT, zero);
    const uint32_t frames = settings.accumulate();
    std::vector<double> sum(frames > 1 ? size_t(width_) * height_ * 4 : 0);
    std::vector<float> scratch;
    const uint64_t all_samples = std::max<uint64_t>(list.total_samples, 1) * frames;
    for (uint32_t frame = 0; frame < frames; ++frame) {
        const auto drawn = [&](uint64_t samples) {
            if (progress && progress(double(frame * list.total_samples + samples) / double(all_samples)))
                throw Error(LB_ERROR_CANCELLED, "the progress callback cancelled the frame");
        };
        passes::shade(*device_, scene, slots, settings, settings.seed() + frame, *sequence_, list, next->gbuffer,
                      next->shading, drawn);
        next->plan.finished("shade", text(list.pixels, " pixels in ", list.parts.size(), " materials"),
                            next->shading.radiance.bytes() + next->shading.sample_count.bytes(), list.total_samples, "samples");
        if (next->prediction && settings.coarsest_level() > 0) {
            passes::upsample(*device_, *scene.camera, settings, width_, height_, next->gbuffer, *next->prediction, next->shading);
            next->plan.finished("upsample", "pixels between shaded ones", 0, uint64_t(width_) * height_, "pixels");
        }
        if (frames > 1) add_radiance(next->shading.radiance, &scratch, &sum);
    }
    for (double value : sum) next->accumulated.push_back(float(value / frames));
    if (settings.background()) {
        passes::background(*device_, scene, width_, height_, next->gbuffer, next->shading);
        next->plan.finished("background", "the map behind the meshes", 0, uint64_t(width_) * height_, "pixels");
    }
}

lb_frame_stats Frame::stats() const {
    lb_frame_stats stats = result().stats;
    std::vector<uint32_t> counts(size_t(width_) * height_);
    result().shading.sample_count.read(0, GL_RED_INTEGER, GL_UNSIGNED_INT, counts.size() * sizeof(uint32_t), counts.data());
    for (uint32_t count : counts) stats.samples += uint64_t(count) * stats.frames;
    return stats;
}

std::string Frame::explain() const { return result().plan.text(); }

}  // namespace lightband
