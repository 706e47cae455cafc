#include "frame/control_subset.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "passes/gather.h"
#include "passes/shade.h"

namespace lightband {
namespace {

// The seed of control samples is the same for every frame, so that directions of the map are drawn for it only once.
constexpr uint32_t control_seed = 0x61756469;

}  // namespace

bool ControlSubset::choose() {
    const double left = run_.asked.time_budget() - run_.elapsed() - run_.throughput.round_milliseconds;
    effort_ = ControlSet::effort(run_.asked, run_.forecast.covered,
                                 std::max(left, 0.0) * run_.throughput.samples_per_millisecond);
    if (effort_.part == 0) return false;
    const FrameResult& result = *run_.result;
    for (uint32_t at = 0; at < result.pixels(); ++at)
        if (result.material[at] != 0 &&
            is_chosen_by(at % result.width, at / result.width, run_.asked.seed(), effort_.part))
            pixels_.push_back(at);
    return true;
}

bool ControlSubset::needs_recheck() const {
    return run_.settings.sampler() == Sampler::cut && !pixels_.empty();
}

bool ControlSubset::is_outgrown_by(double planned) {
    if (run_.settings.sampler() != Sampler::cut || part_ == 0 || run_.asked.time_budget() > 0 || planned == 0)
        return false;
    if (control_.has_enough_samples_for(planned)) return false;
    effort_.samples = uint32_t(constants::control_gain * planned);
    return true;
}

// Shades pixels with the same number of samples each, into targets that the rounds will write again.
std::vector<ControlSet::Pixel> ControlSubset::shade_alike(const std::vector<uint32_t>& pixels, const Settings& settings,
                                                          uint32_t samples, uint32_t seed) const {
    const FrameResult& result = *run_.result;
    const gl::Functions& gl = run_.device.gl();
    result.shading.forget(gl);
    result.shading.decide_all(gl);
    const auto slot_of = [&](uint32_t at) { return result.slot_of[result.material[at] - 1u]; };
    std::vector<std::vector<uint32_t>> of_slot(run_.slots.materials.size());  // y << 16 | x
    for (const uint32_t at : pixels) of_slot[slot_of(at)].push_back(at / result.width << 16 | at % result.width);
    const passes::ShadingList list = passes::even_list(run_.device, of_slot, samples);
    run_.meter.begin();
    passes::shade(
        run_.device, run_.lights, run_.slots, settings, {seed, seed}, list, result.gbuffer, result.shading,
        [&](uint64_t done) {
            const double all = double(list.total_samples);
            run_.meter.report(run_.meter.left(double(done), all, all / run_.throughput.samples_per_millisecond) +
                              run_.expected);
        });
    const std::vector<passes::Gathered> shown =
        passes::gather(run_.device, list, result.shading, result.prediction ? &*result.prediction : nullptr);
    std::vector<size_t> next_of(of_slot.size());  // slot by slot, as listed
    for (size_t slot = 1; slot < of_slot.size(); ++slot) next_of[slot] = next_of[slot - 1] + of_slot[slot - 1].size();
    std::vector<ControlSet::Pixel> seen;
    for (const uint32_t at : pixels) {
        const passes::Gathered& pixel = shown[next_of[slot_of(at)]++];
        const double mean = luminance(Vec3(pixel.rgb[0], pixel.rgb[1], pixel.rgb[2]));
        const double variance = std::max(pixel.square - mean * mean, 0.0) / (samples - 1);
        seen.push_back({at, float(mean), pixel.spread, float(std::sqrt(variance)), pixel.expected,
                        settings.sampler() == Sampler::cut});
    }
    return seen;
}

Done ControlSubset::shade_control() {
    part_ = effort_.part;
    const Settings closer =
        run_.settings.sampler() == Sampler::filtered ? with_sampler(run_.settings, "combined") : run_.settings;
    std::vector<ControlSet::Pixel> seen = shade_alike(pixels_, closer, effort_.samples, control_seed);
    // Pixels that were shaded without bias stay as they are.
    for (size_t k = 0; k < control_.pixels.size(); ++k)
        if (!control_.pixels[k].biased) seen[k] = control_.pixels[k];
    control_.pixels = std::move(seen);
    control_.samples = effort_.samples;
    return {pixels_.size() * effort_.samples, "samples", text(pixels_.size(), " pixels")};
}

Done ControlSubset::shade_pilot() {
    pilot_samples_ = effort_.pilot;
    pilots_ = shade_alike(pixels_, run_.settings, pilot_samples_, run_.asked.seed());
    return {pixels_.size() * pilot_samples_, "samples", text(pixels_.size(), " pixels")};
}

void ControlSubset::tell(Forecast* forecast) const {
    if (pilots_.empty() || run_.asked.target_error() <= 0) return;
    forecast->pilot_samples = pilot_samples_;
    forecast->pilot_error = pilot_error();
}

// The mean squared error that pilot samples leave.
double ControlSubset::pilot_error() const {
    const double mean_radiance = run_.forecast.mean_radiance;
    BiasEstimate sum(part_);
    CommonModeError shared;
    for (size_t k = 0; k < control_.pixels.size(); ++k) {
        const ControlSet::Pixel& seen = control_.pixels[k];
        const double known = scale_of(seen, mean_radiance);
        if (seen.biased && known > 0)
            shared.add(double(pilots_[k].mean - seen.mean) / known, double(pilot_samples_) / control_.samples);
    }
    const double hidden = shared.unseen();
    for (size_t k = 0; k < pilots_.size(); ++k) {
        const double scale = scale_of(pilots_[k].mean, pilots_[k].expected, mean_radiance);
        if (!(scale > 0)) continue;
        const double estimated = std::pow(pilots_[k].spread / scale, 2);
        if (part_ > 0) {
            const ControlSet::Pixel& seen = control_.pixels[k];
            const double square = control_.square(seen, pilots_[k].mean, scale_of(seen, mean_radiance), pilot_samples_);
            sum.add(square + (seen.biased ? hidden : 0), estimated);
        } else {
            sum.add_clamped(estimated);
        }
    }
    return sum.error();
}

// Control pixels to be shaded without bias: a part of them chosen by chance, and those where pilot samples and control
// samples differ most, which are the likeliest to miss light.
std::vector<ControlSubset::Rechecked> ControlSubset::choose_rechecked() const {
    const std::vector<ControlSet::Pixel>& control = control_.pixels;
    const size_t count = control.size(),
                 stride = double(count) <= constants::fewest_rechecked ? 1 : size_t(constants::recheck_stride);
    std::vector<double> difference(count);
    std::vector<size_t> by_difference(count);
    for (size_t k = 0; k < count; ++k) {
        const double scale = scale_of(control[k], run_.forecast.mean_radiance);
        difference[k] = scale > 0 && !pilots_.empty() ? std::abs(pilots_[k].mean - control[k].mean) / scale : 0;
        by_difference[k] = k;
    }
    std::sort(by_difference.begin(), by_difference.end(),
              [&](size_t a, size_t b) { return difference[a] > difference[b]; });
    std::vector<bool> differs(count);
    for (size_t i = 0; i < size_t(std::ceil(constants::differing_part * double(count))); ++i)
        differs[by_difference[i]] = true;
    std::vector<Rechecked> chosen;
    for (size_t k = 0; k < count; ++k) {
        const bool regular = k % stride == 0;  // pixels lie in the picture's order: so these are spread over it
        if (regular || differs[k]) chosen.push_back({k, regular, differs[k]});
    }
    return chosen;
}

// Compares the light cut's control pixels with samples without bias; where pilot and control samples differ and these
// see more light, they take the place of the control samples.
Done ControlSubset::recheck() {
    const double mean_radiance = run_.forecast.mean_radiance;
    std::vector<ControlSet::Pixel>& control = control_.pixels;
    const std::vector<Rechecked> chosen = choose_rechecked();
    std::vector<uint32_t> pixels;
    for (const Rechecked& one : chosen) pixels.push_back(control[one.place].at);
    unbiased_samples_ = ControlSet::unbiased_samples(control_.samples / constants::control_gain);
    const std::vector<ControlSet::Pixel> seen =
        shade_alike(pixels, with_sampler(run_.asked, "combined"), unbiased_samples_, control_seed);
    std::vector<RecheckedPixel> rechecked;
    for (size_t i = 0; i < chosen.size(); ++i) {
        ControlSet::Pixel& cut = control[chosen[i].place];
        const double scale = 0.5 * (scale_of(seen[i], mean_radiance) + scale_of(cut, mean_radiance));
        const double few = pilots_.empty() ? double(cut.mean) : double(pilots_[chosen[i].place].mean);
        if (chosen[i].by_chance && cut.biased && scale > 0)
            rechecked.push_back({few / scale, cut.mean / scale, seen[i].mean / scale, seen[i].spread / scale,
                                 seen[i].deviation / scale});
        if (chosen[i].differs && ControlSet::sees_more_than(seen[i], cut)) cut = seen[i];
    }
    const double few_samples = pilots_.empty() ? control_.samples / constants::control_gain : pilot_samples_;
    const Recheck result =
        lightband::recheck(rechecked, {few_samples, double(control_.samples), double(unbiased_samples_)});
    contradicted_ = result.contradicts(harmless_difference());
    return {pixels.size() * unbiased_samples_, "samples",
            text(pixels.size(), " pixels differ by ", result.difference, " in the mean, standard error ",
                 result.difference_error)};
}

// What a frame may err by to one side before its error shows it. Where no error is asked for, that of the pilot samples
// counts: by their spreads, or, where all pixels err alike, by how far they are from the control samples.
double ControlSubset::harmless_difference() const {
    double error = run_.asked.target_error();
    if (!(error > 0)) {
        double spreads = 0, differences = 0;
        for (size_t k = 0; k < pilots_.size(); ++k) {
            const double scale = scale_of(control_.pixels[k], run_.forecast.mean_radiance);
            if (!(scale > 0)) continue;
            spreads += std::pow(std::min(double(pilots_[k].spread) / scale, 1.0), 2);
            differences +=
                std::pow(std::min(std::abs(double(pilots_[k].mean - control_.pixels[k].mean)) / scale, 1.0), 2);
        }
        error = std::sqrt(std::max(spreads, differences) / std::max(double(pilots_.size()), 1.0));
    }
    return std::max(constants::harmless_part * error, constants::least_difference);
}

// The light cut does not converge: the frame is shaded by the sampler without bias that errs less, and compared with
// other samples without bias.
Done ControlSubset::replace_sampler() {
    const uint32_t samples = std::max(pilot_samples_, uint32_t(control_.samples / constants::control_gain));
    control_.pixels = shade_alike(pixels_, with_sampler(run_.asked, "combined"), unbiased_samples_, control_seed);
    std::vector<double> errors;
    std::vector<std::vector<ControlSet::Pixel>> pilots;
    const char* const candidates[] = {"combined", "brdf"};
    for (const char* sampler : candidates) {
        pilots.push_back(shade_alike(pixels_, with_sampler(run_.asked, sampler), samples, run_.asked.seed()));
        errors.push_back(0);
        for (size_t k = 0; k < pixels_.size(); ++k) {
            const double scale = scale_of(control_.pixels[k], run_.forecast.mean_radiance);
            if (scale > 0) errors.back() += control_.square(control_.pixels[k], pilots.back()[k].mean, scale, samples);
        }
    }
    const size_t better = errors[1] < errors[0] ? 1 : 0;
    run_.settings.set_choice("sampler", candidates[better]);
    pilots_ = std::move(pilots[better]);
    pilot_samples_ = samples;
    contradicted_ = false;
    run_.result->stats.sampler_replaced = 1;
    run_.device.log(
        text("samples without bias contradict the light cut: sampler ", candidates[better], " takes its place"));
    return {pixels_.size() * (unbiased_samples_ + 2 * samples), "samples", text("sampler ", candidates[better])};
}

}  // namespace lightband
