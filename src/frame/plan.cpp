#include "frame/plan.h"

#include <algorithm>

#include "base/columns.h"
#include "base/text.h"

namespace lightband {
namespace {

// "name=choice", of those settings that choose between programs.
std::string variant_of(const Settings& settings, const std::vector<const char*>& names) {
    std::string result;
    for (const char* name : names) result += text(result.empty() ? "" : " ", name, "=", settings.choice(name));
    return result;
}

std::string joined(const std::vector<std::string>& names) {
    std::string result;
    for (const std::string& name : names) result += (result.empty() ? "" : ", ") + name;
    return result;
}

// The shading integral of listed pixels, wherever it is computed.
PlannedPass shading(const char* name, const std::string& reason, const Settings& settings) {
    return {name,
            reason,
            variant_of(settings, {"sampler", "sequence", "brdf_lookup", "environment_lookup"}),
            {"surface", "material", "decision", "shading_list"},
            {"radiance", "spread", "sample_count"}};
}

std::vector<PlannedPass> planned_passes(const Settings& settings, const PlanInput& input) {
    const bool adaptive = settings.method() == Method::adaptive;
    const bool interpolates = adaptive && settings.coarsest_level() > 0;
    const bool biased = settings.sampler() == Sampler::cut || settings.sampler() == Sampler::filtered;
    const bool target = adaptive && settings.target_error() > 0;
    std::vector<PlannedPass> passes;
    passes.push_back(
        {"gbuffer", text(input.instances, " instances, rasterised"), "", {}, {"surface", "material", "depth"}});
    passes.push_back({"covered", "list of the pixels that see a mesh", "", {"material"}, {"covered"}});
    const bool lit = input.lights > 0;  // else the picture is black
    if (adaptive && lit)
        passes.push_back({"environment",
                          "bandwidth of lights and lobes, tables of the sampler; made once for each light and material",
                          variant_of(settings, {"band_rule", "sampler", "split_suns"}),
                          {},
                          {}});
    if (adaptive)
        passes.push_back({"bandwidth",
                          lit ? text("equations 5, 6 and 9 with ", settings.pilots(), " directions a pixel")
                              : "curvature alone: there is no light",
                          variant_of(settings, {"transport", "variance", "sampler"}),
                          {"surface", "material", "covered"},
                          {"bandwidth", "prediction"}});
    if (!lit) return passes;
    if (adaptive && biased)
        passes.push_back(shading(
            "control", "some pixels with four times the samples, which tell how much the others err", settings));
    if (target || (adaptive && settings.sampler() == Sampler::cut && !(settings.time_budget() > 0)))
        passes.push_back(
            shading("pilot", "the same pixels with as many samples as are expected, which tell how much samples vary",
                    settings));
    if (adaptive && settings.sampler() == Sampler::cut) {
        passes.push_back(shading("recheck", "some of these pixels by a sampler without bias", settings));
        passes.push_back(shading("replace",
                                 "another sampler, where the light cut does not converge to what was seen without bias",
                                 settings));
    }
    if (interpolates)
        passes.push_back({"pyramids",
                          settings.shares_follow_variance() ? "least level and largest variance of each block"
                                                            : "least level of each block",
                          "",
                          {"covered", "bandwidth", "prediction"},
                          {"levels"}});
    if (interpolates && settings.shares_follow_variance()) passes.back().writes.push_back("variances");
    PlannedPass classify{"classify",
                         interpolates ? "shade or interpolate" : "every covered pixel is shaded",
                         adaptive ? variant_of(settings, {"allocation"}) : "",
                         {"surface", "material", "covered"},
                         {"decision"}};
    if (adaptive) classify.reads.insert(classify.reads.end(), {"bandwidth", "prediction", "sample_count"});
    if (interpolates) {
        classify.reads.push_back("levels");
        if (settings.shares_follow_variance()) classify.reads.push_back("variances");
        classify.writes.push_back("weights");
    }
    passes.push_back(classify);
    passes.push_back({"list",
                      "pixels to shade, those with the most samples first",
                      "",
                      {"covered", "decision", "material"},
                      {"shading_list"}});
    passes.push_back(shading("shade", text("the shading integral, ", input.materials, " materials"), settings));
    if (interpolates)
        passes.push_back({"upsample",
                          "pixels between shaded ones; at shaded ones, what interpolation would show",
                          "",
                          {"covered", "decision", "weights", "sample_count", "radiance", "spread"},
                          {"radiance", "spread"}});
    passes.push_back({"estimate",
                      "the error of what is shown",
                      "",
                      {"radiance", "spread", "sample_count", "decision", "material"},
                      {}});
    if (interpolates)
        passes.push_back({"combine",
                          "shaded pixels joined with what is interpolated there",
                          "",
                          {"covered", "decision", "weights", "sample_count", "radiance"},
                          {"radiance"}});
    if (settings.background())
        passes.push_back({"background",
                          "the lights behind the meshes",
                          variant_of(settings, {"environment_lookup"}),
                          {"material"},
                          {"radiance"}});
    return passes;
}

}  // namespace

uint64_t bytes_of(const FrameBuffer& buffer, const PlanInput& input, uint32_t coarsest_level) {
    uint64_t rows = input.height;
    if (buffer.pyramid)
        for (uint32_t level = 1, height = input.height; level <= coarsest_level; ++level)
            rows += height = (height + 1) / 2;
    return rows * input.width * buffer.bytes;
}

Plan::Plan(const Settings& settings, const PlanInput& input) : passes_(planned_passes(settings, input)) {
    std::vector<std::string> made;
    for (PlannedPass& pass : passes_)
        for (const std::string& name : pass.writes) {
            if (std::find(made.begin(), made.end(), name) != made.end()) continue;
            made.push_back(name);
            for (const FrameBuffer& buffer : frame_buffers)
                if (name == buffer.name) pass.bytes += bytes_of(buffer, input, settings.coarsest_level());
        }
}

const PlannedPass* Plan::find(std::string_view name) const {
    const auto found =
        std::find_if(passes_.begin(), passes_.end(), [&](const PlannedPass& pass) { return pass.name == name; });
    return found == passes_.end() ? nullptr : &*found;
}

std::string Plan::text() const {
    std::string out;
    for (const PlannedPass& pass : passes_) {
        out += at_left(pass.name, pass_name_width) + megabytes(pass.bytes) + "  " + pass.reason;
        if (!pass.variant.empty()) out += " (" + pass.variant + ")";
        if (!pass.reads.empty()) out += "; reads " + joined(pass.reads);
        if (!pass.writes.empty()) out += "; writes " + joined(pass.writes);
        out += '\n';
    }
    return out;
}

}  // namespace lightband
