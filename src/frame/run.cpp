#include "frame/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/columns.h"
#include "base/text.h"
#include "frame/combine.h"
#include "frame/error_control.h"
#include "passes/gbuffer.h"
#include "passes/upsample.h"
#include "picture/constants.h"

namespace lightband {
namespace {

// Samples of a round from which on it draws new directions of the map: the 65,536 of one seed would limit the error.
// Drawing them costs as much as half a million samples or so.
constexpr uint64_t worth_new_points = 1u << 23;

// Of a frame that is asked for an error it is not known how many rounds will come. Further ones, with what lies between
// them, are expected to take this part of the time that the shading of the last one took.
constexpr double further_rounds = 0.25;
// Before the first is planned, a covered pixel is expected to get so many times its pilot samples: README's picture
// got 2.1, 1.6 and 2.2 times as many where 5, 2 and 1 % were asked for.
constexpr double times_pilot_samples = 2;
// Milliseconds that every frame takes after its shading.
constexpr double least_left = 1;

// Adds a frame's radiance to a sum in double precision.
void add_radiance(const gl::Texture& radiance, std::vector<float>* scratch, std::vector<double>* sum) {
    scratch->resize(sum->size());
    radiance.read(0, GL_RGBA, GL_FLOAT, scratch->size() * sizeof(float), scratch->data());
    for (size_t i = 0; i < sum->size(); ++i) (*sum)[i] += double((*scratch)[i]);
}

}  // namespace

PlanInput plan_input(const Scene& scene, const Scene::Slots& slots, uint32_t width, uint32_t height) {
    return {width, height, scene.instances().size(), slots.materials.size(), scene.lights().size()};
}

const Run::NamedPass Run::passes_by_name[] = {
    {"gbuffer", [](Run& run) { return run.geometry(); }},
    {"covered", [](Run& run) { return run.list_covered(); }},
    {"environment", [](Run& run) { return run.make_tables(); }},
    {"bandwidth", [](Run& run) { return run.predict(); }},
    {"control", [](Run& run) { return run.subset_.shade_control(); }},
    {"pilot", [](Run& run) { return run.subset_.shade_pilot(); }},
    {"recheck", [](Run& run) { return run.subset_.recheck(); }},
    {"replace", [](Run& run) { return run.subset_.replace_sampler(); }},
    {"pyramids", [](Run& run) { return run.make_levels(); }},
    {"classify", [](Run& run) { return run.classify(); }},
    {"list", [](Run& run) { return run.list_shaded(); }},
    {"shade", [](Run& run) { return run.shade(); }},
    {"upsample", [](Run& run) { return run.upsample(); }},
    {"estimate", [](Run& run) { return run.estimate(); }},
    {"combine", [](Run& run) { return run.combine(); }},
    {"background", [](Run& run) { return run.background(); }},
};

Run::Run(gl::Device& device, const Scene& scene, const Settings& settings, uint32_t width, uint32_t height,
         const Throughput& throughput, const Progress& progress)
    : state_{device,
             scene,
             settings,
             settings,
             Meter(progress),
             scene.slots(),
             passes::slot_table(device.gl(), scene.slots()),
             Lights(scene.lights(), settings),
             throughput,
             std::make_shared<FrameResult>(device.gl(), settings, width, height,
                                           Plan(settings, plan_input(scene, scene.slots(), width, height)))} {
#if defined(LIGHTBAND_STUDY)
    constants::choose_studied();
#endif
    next().stats.width = width;
    next().stats.height = height;
    next().eye = scene.camera->eye;
    next().radiance_unit = state_.lights.unit();
    next().slot_of = state_.slots.of_instance;
    next().slots = state_.slots.materials.size();
}

void Run::pass(std::string_view name) {
    if (next().plan.find(name) == nullptr) return;
    for (const NamedPass& each : passes_by_name) {
        if (name != each.name) continue;
        const double begun = state_.elapsed();
        Done done = each.run(*this);
        if (state_.asked.pass_times()) state_.device.gl().Finish();
        next().record.add(name, std::move(done), state_.elapsed() - begun);
    }
}

void Run::execute() {
    state_.meter.report(std::numeric_limits<double>::infinity());
    pass("gbuffer");
    pass("covered");
    state_.expected = expected_shading();
    report_preparation();
    state_.forecast.covered = state_.covered.all.count;
    pass("environment");
    pass("bandwidth");
    if (state_.lights.empty()) {
        stay_black();
    } else {
        examine_control_subset();
        // Rounds end at once where the sampler is replaced, and are planned again for the other.
        while (!rounds()) subset_.tell(&state_.forecast);
        accumulate();
    }
    pass("background");
    state_.device.check("rendering a frame");
    finish();
    state_.meter.report(0);
}

// ---- Passes before the first round ---------------------------------------------------------------------

Done Run::geometry() {
    passes::gbuffer(state_.device, state_.scene, next().width, next().height, &next().gbuffer);
    return {next().pixels()};
}

Done Run::list_covered() {
    state_.covered = passes::covered(state_.device.gl(), next().gbuffer, next().width, next().height,
                                     state_.asked.coarsest_level(), &next().material);
    return {next().pixels()};
}

// What was already made for another frame takes no time.
Done Run::make_tables() {
    const Settings& settings = state_.asked;
    for (const Material* material : state_.slots.materials) {
        material->pilots(settings.band_rule(), settings.pilots());
        report_preparation();
    }
    const bool shades = state_.covered.all.count > 0;
    state_.lights.prepare(settings, settings.seed(), shades, [this] { report_preparation(); });
    for (const Material* material : state_.slots.materials) {
        if (shades && state_.lights.needs_importance(settings)) material->bind_importance();
        if (state_.lights.predicts_by_lobe()) material->bind_bandwidth(settings.band_rule());
    }
    report_preparation();
    const size_t split = state_.lights.split();
    return {state_.slots.materials.size(), "materials",
            text(two_decimals(double(state_.scene.light_bytes()) / 1e6), " MB held by lights",
                 split > 0 ? text(", ", split, " suns split off the map") : "")};
}

Done Run::predict() {
    const Prediction& prediction = next().prediction.emplace(state_.device.gl(), next().width, next().height);
    passes::predict(state_.device, state_.scene, state_.lights, state_.slots, state_.slot_of, state_.asked,
                    next().height, state_.covered, next().gbuffer, prediction);
    state_.forecast = passes::forecast(state_.device, state_.covered, prediction, next().height);
    next().mean_radiance = state_.forecast.mean_radiance;
    return {state_.covered.all.count};
}

// A scene without light: no pixel needs a sample, and nothing errs.
void Run::stay_black() {
    next().shading.clear(state_.device.gl());
    next().shading.decide_nothing(state_.device.gl());
    next().estimate.slots.resize(next().slots);
}

void Run::examine_control_subset() {
    if (state_.asked.method() != Method::adaptive || !subset_.choose()) return;
    if (subset_.needs_control()) pass("control");
    if (subset_.needs_pilot()) pass("pilot");
    if (subset_.needs_recheck()) pass("recheck");
    if (subset_.contradicted()) pass("replace");
    subset_.tell(&state_.forecast);
}

// ---- Passes of a round ---------------------------------------------------------------------------------

// How fine the bandwidth times the scales that error control has chosen asks pixels to be shaded.
Done Run::make_levels() {
    const Scales& scales = control_->scales();
    scales_ = scales.of;
    const auto [least, most] = std::minmax_element(scales_.begin(), scales_.end());
    passes::pyramids(state_.device, state_.forecast, scales, state_.settings, state_.covered, next().width,
                     next().height, *next().prediction, *next().prediction->pyramids);
    return {next().pixels(), "pixels", text("bandwidth times ", *least, " to ", *most)};
}

Done Run::classify() {
    const Prediction* prediction = next().prediction ? &*next().prediction : nullptr;
    const bool interpolates = prediction != nullptr && prediction->pyramids;
    const passes::Criteria criteria{
        state_.settings,
        state_.lights,
        {control_->validation_part(), subset_.part(), state_.asked.seed(), next().stats.rounds},
        control_->tolerance(),
        resampling_.bins,
        int(std::lround(bins_per_octave * std::log2(growth_)))};
    counts_ = passes::classify(state_.device, state_.slot_of, next().slots, criteria, state_.forecast, next().width,
                               state_.covered, next().gbuffer, prediction, next().shading);
    return {state_.covered.all.count, "pixels", interpolates || !prediction ? "" : "every covered pixel is shaded"};
}

Done Run::list_shaded() {
    list_ = passes::shading_list(state_.device, state_.slot_of, counts_, control_->budget(), state_.covered,
                                 next().gbuffer, next().shading);
    return {state_.covered.all.count};
}

Done Run::shade() {
    const auto report = [&](uint64_t samples) { report_shading(double(samples)); };
    state_.meter.begin();
    report(0);
    passes::shade(state_.device, state_.lights, state_.slots, state_.settings, seeds_, list_, next().gbuffer,
                  next().shading, report);
    return {list_.total_samples, "samples", text(list_.pixels, " pixels")};
}

Done Run::upsample() {
    passes::upsample(state_.device, state_.asked, state_.covered, *next().prediction->pyramids, next().shading);
    return {state_.covered.all.count};
}

Done Run::estimate() {
    RoundPixels pixels = next().read_round();
    pixels.neighbour_part = neighbour_parts(pixels, subset_.control(), tiles_, next().width,
                                            state_.asked.coarsest_level(), state_.asked.accumulate());
    next().estimate = estimate_error(pixels, next().slot_of, next().slots, subset_.control(), tiles_);
    samples_ = std::accumulate(pixels.sample_count.begin(), pixels.sample_count.end(), uint64_t(0));
    // A pixel was sampled again from the start or left as it was.
    const std::vector<uint32_t>& before = pixels_.sample_count;
    cost_.pixels = cost_.samples = 0;
    for (size_t i = 0; i < pixels.sample_count.size(); ++i) {
        if (pixels.sample_count[i] == (before.empty() ? 0 : before[i])) continue;
        ++cost_.pixels;
        cost_.samples += pixels.sample_count[i];
    }
    pixels_ = std::move(pixels);
    next().record.count("shade", samples_);
    const ErrorEstimate& found = next().estimate;
    return {next().pixels(), "pixels",
            text("by noise ", found.noise_error(), ", by interpolation ", found.interpolation_error(), ", by bias ",
                 found.bias_error())};
}

// ---- Rounds --------------------------------------------------------------------------------------------

void Run::begin_rounds() {
    next().stats.rounds = 0;
    scales_.clear();
    tiles_ = {};
    next().shading.clear(state_.device.gl());
    if (next().plan.find("pyramids") == nullptr) return;
    next().prediction->pyramids.emplace(state_.device.gl(), next().width, next().height, state_.asked.coarsest_level(),
                                        state_.settings.shares_follow_variance());
    tiles_ = tiles_of_picture(next().width, next().height);
}

// Which pixels are shaded.
void Run::decide(ErrorControl* control) {
    if (next().prediction && !control->interpolates()) {
        next().prediction->pyramids.reset();
        tiles_ = {};
    }
    if (next().prediction && next().prediction->pyramids && scales_ != control->scales().of) pass("pyramids");
    pass("classify");
}

// False: the sampler was replaced, and what is planned is void.
bool Run::plan_round(ErrorControl* control) {
    const bool first = next().stats.rounds == 1;
    if (!first) {
        resampling_ = plan_resampling(pixels_, control->interpolates() ? next().areas() : std::vector<float>(),
                                      next().estimate.mean_luminance, state_.asked.allocation(), control->budget(),
                                      control->wanted_part());
        growth_ *= resampling_.growth;
    }
    decide(control);
    if (control->replan(counts_.bins(), state_.elapsed())) decide(control);
    const Histogram new_pixels = counts_.new_bins();
    const Budget& budget = first ? control->plan(new_pixels, state_.elapsed())
                                 : control->plan_further(resampling_.sampled, new_pixels, state_.elapsed());
    planned_ = round_samples(resampling_.sampled, new_pixels, budget);
    if (first && subset_.is_outgrown_by(planned_.samples / std::max(planned_.pixels, 1.0))) {
        pass("control");  // in targets that hold nothing yet but decisions, which are lost
        pass("recheck");
        if (subset_.contradicted()) {
            pass("replace");
            return false;
        }
        next().shading.clear(state_.device.gl());
        decide(control);
    }
    pass("list");
    return true;
}

// False: see plan_round.
bool Run::rounds() {
    begin_rounds();
    const size_t tiles = size_t(tiles_along(next().width)) * tiles_along(next().height);
    ErrorControl control(state_.settings, state_.forecast, tiles, state_.throughput, state_.elapsed());
    control_ = &control;
    const bool one = state_.asked.target_error() <= 0 && state_.asked.time_budget() <= 0;
    uint32_t points_seed = state_.asked.seed();
    do {
        ++next().stats.rounds;
        further_ = one ? state_.asked.accumulate() - 1 : further_rounds;
        const double begun = state_.elapsed(), shaded = next().record.milliseconds_of("shade");
        const size_t programs = state_.device.program_count();
        if (!plan_round(&control)) return false;
        const bool nothing_left = planned_.pixels == 0 && next().stats.rounds > 1;  // that would be worth it
        if (planned_.samples >= worth_new_points) points_seed = state_.asked.seed() + next().stats.rounds - 1;
        seeds_ = {state_.asked.seed() + next().stats.rounds - 1, points_seed};
        pass("shade");
        if (next().prediction && next().prediction->pyramids) pass("upsample");
        pass("estimate");
        if (nothing_left) {
            --next().stats.rounds;
            break;
        }
        cost_.elapsed_milliseconds = state_.elapsed();
        cost_.shading_milliseconds = next().record.milliseconds_of("shade") - shaded;
        cost_.other_milliseconds = cost_.elapsed_milliseconds - begun - cost_.shading_milliseconds;
        cost_.made_programs = state_.device.program_count() > programs;
    } while (control.needs_another_round(next().estimate, cost_));
    if (!pixels_.neighbour_part.empty()) pass("combine");
    state_.throughput = control.throughput();
    control_ = nullptr;
    return true;
}

// ---- Passes after the last round -----------------------------------------------------------------------

// Makes shaded pixels show the mean that the estimate is of.
Done Run::combine() {
    passes::combine(state_.device, state_.covered, *next().prediction->pyramids, pixels_.neighbour_part, next().width,
                    next().shading);
    next().neighbour_part = pixels_.neighbour_part;
    return {state_.covered.all.count};
}

Done Run::background() {
    passes::background(state_.device, state_.lights, state_.asked, next().width, next().height, next().gbuffer,
                       next().shading);
    return {next().pixels()};
}

// Further frames of other seeds on the same levels; the mean of all.
void Run::accumulate() {
    const uint32_t frames = state_.asked.accumulate();
    if (frames == 1) return;
    std::vector<double> sum(next().pixels() * 4);
    std::vector<float> scratch;
    add_radiance(next().shading.radiance, &scratch, &sum);
    const uint64_t each = samples_;
    for (uint32_t frame = 1; frame < frames; ++frame) {
        further_ = frames - 1 - frame;
        next().shading.clear(state_.device.gl());
        seeds_ = {state_.asked.seed() + frame, state_.asked.seed() + frame};
        pass("shade");
        if (next().prediction && next().prediction->pyramids) pass("upsample");
        if (!pixels_.neighbour_part.empty()) pass("combine");
        add_radiance(next().shading.radiance, &scratch, &sum);
        samples_ += each;
        next().record.count("shade", samples_);
    }
    for (const double value : sum) next().accumulated.push_back(float(value / frames));
    average_error(next().read_round(), subset_.control(), frames, &next().estimate);
}

void Run::finish() {
    FrameResult& result = next();
    lb_frame_stats& stats = result.stats;
    stats.frames = state_.asked.accumulate();
    stats.covered_pixels = state_.covered.all.count;
    const Histogram bins = counts_.bins();
    stats.shaded_pixels = list_.pixels;
    if (state_.asked.method() == Method::adaptive && !list_.samples.empty())
        for (uint32_t bin = 0; bin < budget_bins; ++bin)
            if (list_.samples[bin] >= state_.asked.max_samples()) stats.capped_pixels += bins[bin];
    stats.saturated_pixels = counts_.saturated;
    stats.bent_normals = counts_.bent;
    stats.samples = samples_;
    stats.device_bytes = state_.scene.device_bytes() + result.gbuffer.bytes() + state_.covered.entries.bytes() +
                         (result.prediction ? result.prediction->bytes() : 0) + result.shading.bytes() +
                         list_.entries.bytes();
    stats.error = result.estimate.error();
    stats.noise_error = result.estimate.noise_error();
    stats.interpolation_error = result.estimate.interpolation_error();
    stats.bias_error = result.estimate.bias_error();
    stats.control_pixels = uint32_t(subset_.control().pixels.size());
    state_.device.gl().Finish();  // the one wait of a frame that is not for something read back
    stats.milliseconds = state_.elapsed();
    stats.bandwidth_milliseconds = result.record.milliseconds_of("bandwidth");
    stats.shading_milliseconds = result.record.milliseconds_of("shade");
}

// ---- Progress ------------------------------------------------------------------------------------------

// Milliseconds that the frame's shading is expected to take, before its first round is planned.
double Run::expected_shading() const {
    const Settings& settings = state_.asked;
    if (settings.time_budget() > 0) return settings.time_budget();
    const double covered = state_.covered.all.count;
    const double each = settings.target_error() > 0
                            ? times_pilot_samples * ControlSet::effort(settings, covered, 0).pilot
                            : double(settings.samples()) * settings.accumulate();
    return covered * (constants::pixel_samples + each) / state_.throughput.samples_per_millisecond;
}

// Tells the progress callback how far a frame is whose tables may still be made, which takes seconds once: as long as
// they have taken is expected to be left, if not more.
void Run::report_preparation() {
    state_.meter.report(std::max(state_.expected, state_.meter.since_start()));
}

// Tells the progress callback how far the frame is when the round that is shaded has so many samples.
void Run::report_shading(double samples) {
    const double all = double(list_.total_samples);
    const double left = state_.meter.left(samples, all, all / state_.throughput.samples_per_millisecond);
    double all_left = left + further_ * (state_.meter.passed() + left);
    const double budget = state_.asked.time_budget();
    if (budget > 0) {
        const double in_time = std::max(budget - state_.elapsed(), left);
        all_left = state_.asked.target_error() > 0 ? std::min(all_left, in_time) : in_time;
    }
    // No frame is done before its last report.
    state_.meter.report(std::max(all_left, least_left));
}

}  // namespace lightband
