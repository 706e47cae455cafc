// A frame's audit: before it is drawn, some of its pixels are shaded with about as many samples as it will have, and with more.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "frame/job.h"
#include "passes/gather.h"

namespace lightband {
namespace {

// An audit draws its own directions of the map, the same for every frame, so that they are drawn once.
constexpr uint32_t audit_seed = 0x61756469;

}  // namespace

// Pixels drawn by chance.
std::vector<uint32_t> Frame::draw(const Job& job, double part) const {
    std::vector<uint32_t> drawn;
    for (uint32_t y = 0; y < height_; ++y)
        for (uint32_t x = 0; x < width_; ++x)
            if (job.material[size_t(y) * width_ + x] != 0 && is_drawn(x, y, settings.seed(), part)) drawn.push_back(y * width_ + x);
    return drawn;
}

// Pixels with the same number of samples each; into targets that the rounds will write anew.
std::vector<Audit::Pixel> Frame::shade_alike(const Job& job, const std::vector<uint32_t>& drawn, const Settings& own, uint32_t samples,
                                             uint32_t seed) const {
    const Result& next = *job.result;
    next.shading.forget(device_->gl());
    next.shading.decide_all(device_->gl());
    const auto slot_of = [&](uint32_t at) { return next.slot_of[job.material[at] - 1u]; };
    std::vector<std::vector<uint32_t>> of_slot(job.slots.materials.size());  // y << 16 | x
    for (const uint32_t at : drawn) of_slot[slot_of(at)].push_back(at / width_ << 16 | at % width_);
    const passes::ShadingList list = passes::even_list(*device_, of_slot, samples);
    job.meter.begin();
    passes::shade(*device_, job.scene, job.slots, own, {seed, seed}, list, next.gbuffer, next.shading,
                  [&](uint64_t done) {
                      const double all = double(list.total_samples);
                      job.meter.report(job.meter.left(double(done), all, all / pace_.samples_per_millisecond) + job.expected);
                  });
    const std::vector<passes::Gathered> shown =
        passes::gather(*device_, list, next.shading, next.prediction ? &*next.prediction : nullptr);
    std::vector<size_t> next_of(of_slot.size());  // slot by slot, as listed
    for (size_t slot = 1; slot < of_slot.size(); ++slot) next_of[slot] = next_of[slot - 1] + of_slot[slot - 1].size();
    std::vector<Audit::Pixel> seen;
    for (const uint32_t at : drawn) {
        const passes::Gathered& pixel = shown[next_of[slot_of(at)]++];
        const double mean = luminance(Vec3(pixel.rgb[0], pixel.rgb[1], pixel.rgb[2]));
        const double variance = std::max(pixel.square - mean * mean, 0.0) / (samples - 1);
        seen.push_back({at, float(mean), pixel.spread, float(std::sqrt(variance)), pixel.expected, own.sampler() == Sampler::cut});
    }
    return seen;
}

void Frame::audit(Job* job, Forecast* forecast) const {
    Result& next = *job->result;
    const double left = settings.time_budget() - next.plan.total_milliseconds() - pace_.round_milliseconds;
    const Audit::Effort effort = Audit::effort(settings, forecast->covered, std::max(left, 0.0) * pace_.samples_per_millisecond);
    if (effort.part == 0) return;
    job->material.resize(pixels());
    next.gbuffer.material.read(0, GL_RED_INTEGER, GL_UNSIGNED_BYTE, job->material.size(), job->material.data());
    const std::vector<uint32_t> drawn = draw(*job, effort.part);
    if (effort.samples > 0) {
        job->audited = effort.part;
        look_closely(job, drawn, effort.samples);
    }
    if (effort.probe > 0) draw_pilots(job, drawn, effort.probe);
    const bool cut = settings.sampler() == Sampler::cut && !drawn.empty();
    if (cut && recheck(job, forecast->mean_radiance).contradicts(harmless_difference(*job, forecast->mean_radiance)))
        replace_sampler(job, forecast->mean_radiance);
    plan_from_pilots(*job, forecast);
}

// Pixels with about as many samples as will be planned.
void Frame::draw_pilots(Job* job, const std::vector<uint32_t>& drawn, uint32_t samples) const {
    job->pilots = shade_alike(*job, drawn, job->settings, samples, settings.seed());
    job->pilot_samples = samples;
    job->result->plan.finished("probe", text(drawn.size(), " pixels, to know how much they vary"), 0, drawn.size() * samples, "samples");
}

void Frame::plan_from_pilots(const Job& job, Forecast* forecast) const {
    if (job.pilots.empty() || settings.target_error() <= 0) return;
    forecast->probe_samples = job.pilot_samples;
    forecast->probed_error = probed_error(job, job.pilots, *forecast);
}

// The mean squared error that a probe's pixels have.
double Frame::probed_error(const Job& job, const std::vector<Audit::Pixel>& probe, const Forecast& forecast) const {
    AuditSum sum(job.audited);
    SharedError shared;
    for (size_t k = 0; k < job.audit.pixels.size(); ++k) {
        const Audit::Pixel& seen = job.audit.pixels[k];
        const double known = scale_of(seen, forecast.mean_radiance);
        if (seen.biased && known > 0)
            shared.add(double(probe[k].mean - seen.mean) / known, double(forecast.probe_samples) / job.audit.samples);
    }
    const double hidden = shared.hidden();
    for (size_t k = 0; k < probe.size(); ++k) {
        const double scale = scale_of(probe[k].mean, probe[k].expected, forecast.mean_radiance);
        if (!(scale > 0)) continue;
        const double told = std::pow(probe[k].spread / scale, 2);
        if (job.audited > 0) {
            const Audit::Pixel& seen = job.audit.pixels[k];
            const double square = job.audit.square(seen, probe[k].mean, scale_of(seen, forecast.mean_radiance), forecast.probe_samples);
            sum.add(square + (seen.biased ? hidden : 0), told);
        } else {
            sum.add_believed(told);
        }
    }
    return sum.error();
}

void Frame::look_closely(Job* job, const std::vector<uint32_t>& drawn, uint32_t samples) const {
    const Settings closer = settings.sampler() == Sampler::filtered ? with_sampler("combined") : settings;
    std::vector<Audit::Pixel> seen = shade_alike(*job, drawn, closer, samples, audit_seed);
    // What was seen without bias stays.
    for (size_t k = 0; k < job->audit.pixels.size(); ++k)
        if (!job->audit.pixels[k].biased) seen[k] = job->audit.pixels[k];
    job->audit.pixels = std::move(seen);
    job->audit.samples = samples;
    job->result->plan.finished("audit", text(drawn.size(), " pixels more closely, to know how far the others err"), 0,
                               drawn.size() * samples, "samples");
}

// Validation pixels to be shaded without bias: a part of them chosen by chance, and those where pilot pass and validation differ most,
// which are the likeliest to miss light.
std::vector<Frame::Rechecked> Frame::choose_rechecked(const Job& job, double mean_radiance) const {
    const std::vector<Audit::Pixel>& validated = job.audit.pixels;
    const size_t count = validated.size(), stride = count <= Audit::fewest_rechecked ? 1 : Audit::recheck_stride;
    std::vector<double> difference(count);
    std::vector<size_t> by_difference(count);
    for (size_t k = 0; k < count; ++k) {
        const double scale = scale_of(validated[k], mean_radiance);
        difference[k] = scale > 0 && !job.pilots.empty() ? std::abs(job.pilots[k].mean - validated[k].mean) / scale : 0;
        by_difference[k] = k;
    }
    std::sort(by_difference.begin(), by_difference.end(), [&](size_t a, size_t b) { return difference[a] > difference[b]; });
    std::vector<bool> differs(count);
    for (size_t i = 0; i < size_t(std::ceil(Audit::doubted_part * double(count))); ++i) differs[by_difference[i]] = true;
    std::vector<Rechecked> chosen;
    for (size_t k = 0; k < count; ++k) {
        const bool regular = k % stride == 0;  // pixels lie in the picture's order: so these are spread over it
        if (regular || differs[k]) chosen.push_back({k, regular, differs[k]});
    }
    return chosen;
}

// Holds the cut's pixels against samples without bias; where pilot pass and validation differ and these see more light, they take the place
// of the validation.
Recheck Frame::recheck(Job* job, double mean_radiance) const {
    std::vector<Audit::Pixel>& validated = job->audit.pixels;
    const std::vector<Rechecked> chosen = choose_rechecked(*job, mean_radiance);
    std::vector<uint32_t> pixels;
    for (const Rechecked& one : chosen) pixels.push_back(validated[one.place].at);
    job->unbiased_samples = Audit::unbiased_samples(job->audit.samples / Audit::gain);
    const std::vector<Audit::Pixel> seen = shade_alike(*job, pixels, with_sampler("combined"), job->unbiased_samples, audit_seed);
    std::vector<RecheckedPixel> rechecked;
    for (size_t i = 0; i < chosen.size(); ++i) {
        Audit::Pixel& cut = validated[chosen[i].place];
        const double scale = 0.5 * (scale_of(seen[i], mean_radiance) + scale_of(cut, mean_radiance));
        const double few = job->pilots.empty() ? double(cut.mean) : double(job->pilots[chosen[i].place].mean);
        if (chosen[i].by_chance && cut.biased && scale > 0)
            rechecked.push_back({few / scale, cut.mean / scale, seen[i].mean / scale, seen[i].spread / scale, seen[i].deviation / scale});
        if (chosen[i].differs && Audit::refutes(seen[i], cut)) cut = seen[i];
    }
    const double few_samples = job->pilots.empty() ? job->audit.samples / Audit::gain : job->pilot_samples;
    const Recheck result = lightband::recheck(rechecked, {few_samples, double(job->audit.samples), double(job->unbiased_samples)});
    job->result->plan.finished("recheck", text(pixels.size(), " validation pixels without bias; they differ by ", result.difference,
                                               " in the mean, standard error ", result.difference_error),
                               0, pixels.size() * job->unbiased_samples, "samples");
    return result;
}

// What a frame may err by to one side before its error shows it. Where no error is asked for, the pilots' own error counts: by their
// spreads, or, where all pixels err alike, by how far they are from the validation.
double Frame::harmless_difference(const Job& job, double mean_radiance) const {
    double error = settings.target_error();
    if (!(error > 0)) {
        double spreads = 0, differences = 0;
        for (size_t k = 0; k < job.pilots.size(); ++k) {
            const double scale = scale_of(job.audit.pixels[k], mean_radiance);
            if (!(scale > 0)) continue;
            spreads += std::pow(std::min(double(job.pilots[k].spread) / scale, 1.0), 2);
            differences += std::pow(std::min(std::abs(double(job.pilots[k].mean - job.audit.pixels[k].mean)) / scale, 1.0), 2);
        }
        error = std::sqrt(std::max(spreads, differences) / std::max(double(job.pilots.size()), 1.0));
    }
    return std::max(Audit::harmless_part * error, Audit::least_difference);
}

// The cut does not converge: the frame is drawn by the sampler without bias that errs less, and held against other samples without bias.
void Frame::replace_sampler(Job* job, double mean_radiance) const {
    std::vector<uint32_t> drawn;
    for (const Audit::Pixel& pixel : job->audit.pixels) drawn.push_back(pixel.at);
    const uint32_t samples = std::max(job->pilot_samples, uint32_t(job->audit.samples / Audit::gain));
    job->audit.pixels = shade_alike(*job, drawn, with_sampler("combined"), job->unbiased_samples, audit_seed);
    std::vector<double> errors;
    std::vector<std::vector<Audit::Pixel>> pilots;
    const char* const candidates[] = {"combined", "brdf"};
    for (const char* sampler : candidates) {
        pilots.push_back(shade_alike(*job, drawn, with_sampler(sampler), samples, settings.seed()));
        errors.push_back(0);
        for (size_t k = 0; k < drawn.size(); ++k) {
            const double scale = scale_of(job->audit.pixels[k], mean_radiance);
            if (scale > 0) errors.back() += job->audit.square(job->audit.pixels[k], pilots.back()[k].mean, scale, samples);
        }
    }
    const size_t better = errors[1] < errors[0] ? 1 : 0;
    job->settings.set_choice("sampler", candidates[better]);
    job->pilots = std::move(pilots[better]);
    job->pilot_samples = samples;
    job->result->stats.sampler_replaced = 1;
    const std::string reason = text("samples without bias contradict the light cut: sampler ", candidates[better], " takes its place");
    job->result->plan.finished("replace", reason, 0, drawn.size() * (job->unbiased_samples + 2 * samples), "samples");
    device_->log(reason);
}

Settings Frame::with_sampler(const char* sampler) const {
    Settings other = settings;
    other.set_choice("sampler", sampler);
    return other;
}

// Where the first round plans more than was thought. In targets that hold nothing yet but decisions, which are lost.
bool Frame::audit_again(Job* job) const {
    const double planned = job->drawn.samples / std::max(job->drawn.pixels, 1.0);
    if (job->settings.sampler() != Sampler::cut || job->audited == 0 || settings.time_budget() > 0 || planned == 0) return false;
    if (job->audit.knows_better(planned)) return false;
    look_closely(job, draw(*job, job->audited), uint32_t(Audit::gain * planned));
    if (recheck(job, job->result->mean_radiance).contradicts(harmless_difference(*job, job->result->mean_radiance)))
        replace_sampler(job, job->result->mean_radiance);
    job->result->shading.clear(device_->gl());
    return true;
}

}  // namespace lightband
