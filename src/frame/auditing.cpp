// A frame's audit: before it is drawn, some of its pixels are shaded with about as many samples as it will have, and with more.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "frame/job.h"
#include "frame/rehearsal.h"
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
    passes::shade(*device_, job.scene, job.slots, own, {seed, seed}, list, next.gbuffer, next.shading,
                  [&](uint64_t) { job.report(0); });
    const std::vector<passes::Gathered> shown =
        passes::gather(*device_, list, next.gbuffer, next.shading, next.prediction ? &*next.prediction : nullptr);
    std::vector<size_t> next_of(of_slot.size());  // slot by slot, as listed
    for (size_t slot = 1; slot < of_slot.size(); ++slot) next_of[slot] = next_of[slot - 1] + of_slot[slot - 1].size();
    std::vector<Audit::Pixel> seen;
    for (const uint32_t at : drawn) {
        const passes::Gathered& pixel = shown[next_of[slot_of(at)]++];
        const double mean = luminance(Vec3(pixel.rgb[0], pixel.rgb[1], pixel.rgb[2]));
        const double variance = std::max(pixel.square - mean * mean, 0.0) / (samples - 1);
        seen.push_back({at, float(mean), pixel.spread, float(std::sqrt(variance)), pixel.expected, own.sampler() == Sampler::cut,
                        {pixel.normal[0], pixel.normal[1], pixel.normal[2]}});
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
    if (effort.probe == 0) return;
    const std::vector<Audit::Pixel> probe = shade_alike(*job, drawn, settings, effort.probe, settings.seed());
    next.plan.finished("probe", text(drawn.size(), " pixels, to know how much they vary"), 0, drawn.size() * effort.probe, "samples");
    if (settings.sampler() == Sampler::cut) doubt_audit(job, probe, effort.probe, forecast->mean_radiance);
    if (settings.target_error() <= 0) return;  // nothing is planned from it
    forecast->probe_samples = effort.probe;
    forecast->probed_error = probed_error(*job, probe, *forecast);
}

// By what the pilots' foresight of interpolation is to be multiplied, squared.
double Frame::rehearsed(const Job& job, double mean_radiance) const {
    const Result& next = *job.result;
    std::vector<RehearsedPixel> pixels;
    for (const Audit::Pixel& seen : job.audit.pixels) {
        const Vec3 normal(seen.normal[0], seen.normal[1], seen.normal[2]);
        const Vec3 wo = -glm::normalize(next.gbuffer.rays.through(double(seen.at % width_), double(seen.at / width_)));
        pixels.push_back({normal, 2 * glm::dot(normal, wo) * normal - wo, next.slot_of[job.material[seen.at] - 1u], double(seen.mean),
                          double(seen.expected)});
    }
    return rehearse(pixels, dark_part * mean_radiance);
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
    Settings closer = settings;
    if (settings.sampler() == Sampler::filtered) closer.set_choice("sampler", "combined");
    std::vector<Audit::Pixel> seen = shade_alike(*job, drawn, closer, samples, audit_seed);
    // What was seen without bias stays.
    for (size_t k = 0; k < job->audit.pixels.size(); ++k)
        if (!job->audit.pixels[k].biased) seen[k] = job->audit.pixels[k];
    job->audit.pixels = std::move(seen);
    job->audit.samples = samples;
    job->result->plan.finished("audit", text(drawn.size(), " pixels more closely, to know how far the others err"), 0,
                               drawn.size() * samples, "samples");
}

// Looks again, without bias, where a probe and the audit disagree most.
void Frame::doubt_audit(Job* job, const std::vector<Audit::Pixel>& probe, uint32_t probe_samples, double mean_radiance) const {
    std::vector<Audit::Pixel>& audited = job->audit.pixels;
    std::vector<double> disagreement;
    for (size_t k = 0; k < audited.size(); ++k) {
        const double scale = scale_of(audited[k], mean_radiance);
        disagreement.push_back(scale > 0 ? std::abs(probe[k].mean - audited[k].mean) / scale : 0);
    }
    std::vector<size_t> order(audited.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return disagreement[a] > disagreement[b]; });
    order.resize(size_t(std::ceil(Audit::doubted_part * double(order.size()))));
    std::sort(order.begin(), order.end());
    std::vector<uint32_t> doubted;
    for (const size_t k : order) doubted.push_back(audited[k].at);
    Settings unbiased = settings;
    unbiased.set_choice("sampler", "combined");
    const uint32_t samples = Audit::unbiased_samples(probe_samples);
    const std::vector<Audit::Pixel> seen = shade_alike(*job, doubted, unbiased, samples, audit_seed);
    for (size_t k = 0; k < order.size(); ++k)
        if (Audit::refutes(seen[k], audited[order[k]])) audited[order[k]] = seen[k];
    job->result->plan.finished("doubt", text(doubted.size(), " audited pixels without bias"), 0, doubted.size() * samples, "samples");
}

// Where the first round plans more than was thought. In targets that hold nothing yet but decisions, which are lost. Of a frame that
// interpolates over directions most pixels err by interpolation, of which an audit of as many samples tells enough.
bool Frame::audit_again(Job* job) const {
    const double planned = job->drawn.samples / std::max(job->drawn.pixels, 1.0);
    if (settings.sampler() != Sampler::cut || job->audited == 0 || settings.time_budget() > 0 || planned == 0) return false;
    const bool over_directions = job->result->prediction->mirrors.has_value();
    if (over_directions ? job->audit.samples >= planned : job->audit.knows_better(planned)) return false;
    look_closely(job, draw(*job, job->audited), uint32_t(Audit::gain * planned));
    job->result->shading.clear(device_->gl());
    return true;
}

}  // namespace lightband
