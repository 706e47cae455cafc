#include "frame/frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "frame/combine.h"
#include "frame/job.h"
#include "passes/gbuffer.h"
#include "passes/upsample.h"

namespace lightband {
namespace {

// Adds a frame's radiance to a sum in double precision.
void add_radiance(const gl::Texture& radiance, std::vector<float>* scratch, std::vector<double>* sum) {
    scratch->resize(sum->size());
    radiance.read(0, GL_RGBA, GL_FLOAT, scratch->size() * sizeof(float), scratch->data());
    for (size_t i = 0; i < sum->size(); ++i) (*sum)[i] += double((*scratch)[i]);
}

// Samples of a round for which the map's directions are drawn anew: those of one drawing, 65,536, would limit the error. It costs as
// much as half a million samples or so.
constexpr uint64_t worth_new_points = 1u << 23;

// Of a frame that is asked for an error it is not known how many rounds will come. Further ones, with what lies between them, are expected
// to take this part of the time that the shading of the last one took.
constexpr double further_rounds = 0.25;
// Before the first is planned, a covered pixel is expected to be drawn so many times the samples of a probe: README's picture was drawn
// 2.1, 1.6 and 2.2 times as many where 5, 2 and 1 % were asked for.
constexpr double times_probed = 2;
// Milliseconds that every frame takes after its shading.
constexpr double least_left = 1;

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
    const bool controlled = settings.target_error() > 0 || settings.time_budget() > 0;
    if (controlled && settings.accumulate() > 1)
        throw Error(LB_ERROR_INVALID_STATE, text("accumulate is ", settings.accumulate(),
                                                 "; a frame with a target_error or a time_budget needs 1"));
    const gl::Functions& gl = device_->gl();
    const Scene::Slots slots = scene.slots();
    Meter meter(progress);
    Job job{scene, meter, std::make_shared<Result>(gl, width_, height_), settings, slots, passes::slot_table(gl, slots)};
    Result& next = *job.result;
    next.settings = settings;
    next.stats.width = width_;
    next.stats.height = height_;
    next.eye = scene.camera->eye;
    next.radiance_unit = scene.light->unit();
    next.slot_of = slots.of_instance;
    next.slots = slots.materials.size();
    meter.report(std::numeric_limits<double>::infinity());

    passes::gbuffer(*device_, scene, width_, height_, &next.gbuffer);
    next.plan.finished("gbuffer", text(scene.instances().size(), " instances"), next.gbuffer.bytes(), pixels(), "pixels");
    job.covered = passes::covered(gl, next.gbuffer, width_, height_, settings.coarsest_level());
    next.plan.finished("covered", "list of the pixels that see a mesh", job.covered.entries.bytes(), pixels(), "pixels");
    job.expected = expected_shading(job.covered.all.count);
    report_preparation(job);
    Forecast forecast = predict(&job);
    audit(&job, &forecast);
    // Rounds end at once where they find that the sampler has to be replaced, and are planned anew for the other.
    while (!rounds(&job, forecast)) plan_from_pilots(job, &forecast);
    if (settings.accumulate() > 1) accumulate(&job);
    if (settings.background()) {
        passes::background(*device_, scene, width_, height_, next.gbuffer, settings.environment_lookup(), next.shading);
        next.plan.finished("background", "the map behind the meshes", 0, pixels(), "pixels");
    }
    device_->check("rendering a frame");
    finish(&job);
    meter.report(0);
    result_ = job.result;
    pace_ = job.pace;
}

void Frame::finish(Job* job) const {
    Result& next = *job->result;
    lb_frame_stats& stats = next.stats;
    stats.frames = settings.accumulate();
    stats.covered_pixels = job->covered.all.count;
    const Histogram bins = job->counts.bins();
    stats.shaded_pixels = job->list.pixels;
    if (settings.method() == Method::adaptive)
        for (uint32_t bin = 0; bin < budget_bins; ++bin)
            if (job->list.samples[bin] >= settings.max_samples()) stats.capped_pixels += bins[bin];
    stats.saturated_pixels = job->counts.saturated;
    stats.bent_normals = job->counts.bent;
    stats.samples = job->samples;
    stats.device_bytes = job->scene.device_bytes() + next.gbuffer.bytes() + job->covered.entries.bytes() +
                         (next.prediction ? next.prediction->bytes() : 0) + next.shading.bytes() + job->list.entries.bytes();
    stats.milliseconds = next.plan.total_milliseconds();
    stats.bandwidth_milliseconds = stats.milliseconds - next.plan.milliseconds_of({"gbuffer", "shade"});
    stats.shading_milliseconds = next.plan.milliseconds_of({"shade"});
    stats.error = next.estimate.error();
    stats.noise_error = next.estimate.noise_error();
    stats.interpolation_error = next.estimate.interpolation_error();
    stats.audited_pixels = uint32_t(job->audit.pixels.size());
    stats.bias_error = next.estimate.bias_error();
}

Forecast Frame::predict(Job* job) const {
    Result& next = *job->result;
    if (settings.method() == Method::reference) return {double(job->covered.all.count), 0, 0};
    job->scene.light->bandwidth(settings.band_rule());
    report_preparation(*job);
    for (const Material* material : job->slots.materials) {
        material->pilots(settings.band_rule(), settings.pilots());
        report_preparation(*job);
    }
    if (job->covered.all.count > 0) passes::make_tables(job->scene, job->slots, settings, settings.seed());
    report_preparation(*job);
    next.plan.finished("environment", "bandwidth of the map and the lobes, tables of the sampler; once for each", job->scene.light->device_bytes(), 0, "");

    const Prediction& prediction = next.prediction.emplace(device_->gl(), width_, height_);
    passes::predict(*device_, job->scene, job->slots, job->slot_of, settings, height_, job->covered, next.gbuffer, prediction);
    const Forecast forecast = passes::forecast(*device_, job->covered, prediction, height_);
    next.mean_radiance = forecast.mean_radiance;
    next.plan.finished("bandwidth", text("eq. 5, 6 and 9 with ", settings.pilots(), " directions"),
                       prediction.bandwidth.bytes() + prediction.prediction.bytes(), job->covered.all.count, "pixels");
    return forecast;
}

// How fine the bandwidth times the scales that control has chosen asks pixels to be shaded.
void Frame::choose_levels(Job* job, const Control& control, const Forecast& forecast) const {
    Result& next = *job->result;
    const Scales& scales = control.scales();
    if (job->scales == scales.of) return;
    job->scales = scales.of;
    const auto [least, most] = std::minmax_element(scales.of.begin(), scales.of.end());
    const Pyramids& pyramids = *next.prediction->pyramids;
    passes::pyramids(*device_, forecast, scales, job->settings, job->covered, width_, height_, *next.prediction, pyramids);
    const char* made = pyramids.variances ? "least level and largest variance" : "least level";
    next.plan.finished("pyramids", text(made, " of each block, bandwidth times ", *least, " to ", *most), pyramids.bytes(), pixels(),
                       "pixels");
}

// Which pixels are shaded.
void Frame::decide(Job* job, Control* control, const Forecast& forecast) const {
    Result& next = *job->result;
    if (next.prediction && !control->interpolates()) {
        next.prediction->pyramids.reset();
        job->tiles = {};
    }
    const Prediction* prediction = next.prediction ? &*next.prediction : nullptr;
    const passes::Witnesses witnesses{control->witnesses(), job->audited, settings.seed(), next.stats.rounds};
    const bool interpolates = prediction != nullptr && prediction->pyramids;
    if (interpolates) choose_levels(job, *control, forecast);
    const std::vector<Lamp> none;
    const passes::Criteria criteria{job->settings, interpolates ? job->scene.light->lamps() : none, witnesses, control->tolerance(),
                                    job->redraw.bins, int(std::lround(bins_per_octave * std::log2(job->grown)))};
    job->counts = passes::classify(*device_, job->slot_of, next.slots, criteria, forecast, width_, job->covered, next.gbuffer, prediction,
                                   next.shading);
    next.plan.finished("classify", interpolates ? "shade or interpolate" : "every covered pixel is shaded",
                       next.shading.decision.bytes(), job->covered.all.count, "pixels");
}

// False: the sampler was replaced, and what is planned is void.
bool Frame::list(Job* job, Control* control, const Forecast& forecast) const {
    Result& next = *job->result;
    const bool first = next.stats.rounds == 1;
    if (!first) {
        job->redraw = redraw(job->pixels, control->interpolates() ? next.areas() : std::vector<float>(), next.estimate.mean_luminance,
                             settings.allocation(), control->budget(), control->wanted_part());
        job->grown *= job->redraw.growth;
    }
    decide(job, control, forecast);
    if (control->reconsider(job->counts.bins(), next.plan.total_milliseconds())) decide(job, control, forecast);
    const double elapsed = next.plan.total_milliseconds();
    const Histogram fresh = job->counts.fresh_bins();
    const Budget& budget = first ? control->plan(fresh, elapsed) : control->plan_further(job->redraw.drawn, fresh, elapsed);
    job->drawn = redrawing(job->redraw.drawn, fresh, budget);
    if (first && audit_again(job)) {
        if (next.stats.sampler_replaced != 0) return false;
        decide(job, control, forecast);
    }
    job->list = passes::shading_list(*device_, job->slot_of, job->counts, budget, job->covered, next.gbuffer,
                                     next.shading);
    next.plan.finished("list", "pixels to shade, longest first", job->list.entries.bytes(), job->covered.all.count, "pixels");
    return true;
}

// Milliseconds that the frame's shading is expected to take, before its first round is planned.
double Frame::expected_shading(double covered) const {
    if (settings.time_budget() > 0) return settings.time_budget();
    const double each = settings.target_error() > 0 ? times_probed * Audit::effort(settings, covered, 0).probe
                                                    : double(settings.samples()) * settings.accumulate();
    return covered * (Pace::pixel_samples + each) / pace_.samples_per_millisecond;
}

// Tells the progress callback how far a frame is whose tables may still be made, which takes seconds once: as long as they have taken is
// expected to be left, if not more.
void Frame::report_preparation(const Job& job) const { job.meter.report(std::max(job.expected, job.meter.since_start())); }

// Tells the progress callback how far the frame is when the round that is shaded has drawn so many samples.
void Frame::report_shading(const Job& job, double samples) const {
    const double all = double(job.list.total_samples);
    const double left = job.meter.left(samples, all, all / pace_.samples_per_millisecond);
    const double elapsed = job.result->plan.total_milliseconds() + job.meter.passed();
    double all_left = left + job.further * (job.meter.passed() + left);
    if (settings.time_budget() > 0) {
        const double in_time = std::max(settings.time_budget() - elapsed, left);
        all_left = settings.target_error() > 0 ? std::min(all_left, in_time) : in_time;
    }
    // No frame is done before its last report.
    job.meter.report(std::max(all_left, least_left));
}

void Frame::shade(Job* job, const passes::Seeds& seeds) const {
    Result& next = *job->result;
    const passes::ShadingList& list = job->list;
    const auto drawn = [&](uint64_t samples) { report_shading(*job, double(samples)); };
    job->meter.begin();
    drawn(0);
    passes::shade(*device_, job->scene, job->slots, job->settings, seeds, list, next.gbuffer,
                  next.shading, drawn);
    next.plan.finished("shade", text(list.pixels, " pixels in ", job->slots.materials.size(), " materials"),
                       next.shading.radiance.bytes() + next.shading.spread.bytes() + next.shading.sample_count.bytes(),
                       list.total_samples, "samples");
    if (!next.prediction || !next.prediction->pyramids) return;
    passes::upsample(*device_, settings, job->covered, *next.prediction->pyramids, next.shading);
    next.plan.finished("upsample", "pixels between shaded ones, and what they would be at witnesses", 0, job->covered.all.count, "pixels");
}

void Frame::measure(Job* job) const {
    Result& next = *job->result;
    RoundPixels pixels = next.read_round();
    pixels.neighbour_part = neighbour_parts(pixels, job->audit, job->tiles, width_, settings.coarsest_level(), settings.accumulate());
    next.estimate = estimate_error(pixels, next.slot_of, next.slots, job->audit, job->tiles);
    job->samples = std::accumulate(pixels.sample_count.begin(), pixels.sample_count.end(), uint64_t(0));
    // A pixel is drawn anew or left as it was.
    const std::vector<uint32_t>& before = job->pixels.sample_count;
    job->cost.pixels = job->cost.samples = 0;
    for (size_t i = 0; i < pixels.sample_count.size(); ++i) {
        if (pixels.sample_count[i] == (before.empty() ? 0 : before[i])) continue;
        ++job->cost.pixels;
        job->cost.samples += pixels.sample_count[i];
    }
    job->pixels = std::move(pixels);
    next.plan.count("shade", job->samples);
    next.plan.finished("estimate",
                       text("error by noise ", next.estimate.noise_error(), ", by interpolation ", next.estimate.interpolation_error(),
                            ", by bias ", next.estimate.bias_error()),
                       0, this->pixels(), "pixels");
}

// Makes shaded pixels show what the estimate took them to show.
void Frame::combine(const Job& job) const {
    Result& next = *job.result;
    if (job.pixels.neighbour_part.empty()) return;
    passes::combine(*device_, job.covered, *next.prediction->pyramids, job.pixels.neighbour_part, width_, next.shading);
    next.neighbour_part = job.pixels.neighbour_part;
    next.plan.finished("combine", "shaded pixels joined with what is interpolated there", 0, job.covered.all.count, "pixels");
}

// False: see Frame::list.
bool Frame::rounds(Job* job, const Forecast& forecast) const {
    Result& next = *job->result;
    next.stats.rounds = 0;
    job->scales.clear();
    next.shading.clear(device_->gl());
    if (next.prediction && settings.coarsest_level() > 0) {
        next.prediction->pyramids.emplace(device_->gl(), width_, height_, settings.coarsest_level(), job->settings.shares_follow_variance());
        job->tiles = tiles_of_picture(width_, height_);
    }
    const size_t tiles = size_t(tiles_along(width_)) * tiles_along(height_);
    Control control(job->settings, forecast, tiles, pace_, next.plan.total_milliseconds());
    const bool one = settings.target_error() <= 0 && settings.time_budget() <= 0;
    uint32_t points_seed = settings.seed();
    RoundCost& cost = job->cost;
    do {
        ++next.stats.rounds;
        job->further = one ? settings.accumulate() - 1 : further_rounds;
        const double begun = next.plan.total_milliseconds(), shaded = next.plan.milliseconds_of({"shade"});
        const size_t programs = device_->program_count();
        if (!list(job, &control, forecast)) return false;
        const bool nothing_left = job->drawn.pixels == 0 && next.stats.rounds > 1;  // that would be worth it
        if (job->drawn.samples >= worth_new_points) points_seed = settings.seed() + next.stats.rounds - 1;
        shade(job, {settings.seed() + next.stats.rounds - 1, points_seed});
        measure(job);
        if (nothing_left) {
            --next.stats.rounds;
            break;
        }
        cost.elapsed_milliseconds = next.plan.total_milliseconds();
        cost.shading_milliseconds = next.plan.milliseconds_of({"shade"}) - shaded;
        cost.other_milliseconds = cost.elapsed_milliseconds - begun - cost.shading_milliseconds;
        cost.made_programs = device_->program_count() > programs;
    } while (control.again(next.estimate, cost));
    combine(*job);
    job->pace = control.pace();
    return true;
}

// Further frames of other seeds on the same levels; the mean of all.
void Frame::accumulate(Job* job) const {
    Result& next = *job->result;
    const uint32_t frames = settings.accumulate();
    std::vector<double> sum(pixels() * 4);
    std::vector<float> scratch;
    add_radiance(next.shading.radiance, &scratch, &sum);
    const uint64_t each = job->samples;
    for (uint32_t frame = 1; frame < frames; ++frame) {
        job->further = frames - 1 - frame;
        next.shading.clear(device_->gl());
        shade(job, {settings.seed() + frame, settings.seed() + frame});
        combine(*job);
        add_radiance(next.shading.radiance, &scratch, &sum);
        job->samples += each;
        next.plan.count("shade", job->samples);
    }
    for (double value : sum) next.accumulated.push_back(float(value / frames));
    average_error(next.read_round(), job->audit, frames, &next.estimate);
}

lb_frame_stats Frame::stats() const {
    return result().stats;
}

std::string Frame::explain() const { return result().plan.text(); }

}  // namespace lightband
