// A picture: from scene and settings to passes, run in order, and their fields.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "assets/scene.h"
#include "frame/audit.h"
#include "frame/control.h"
#include "frame/host_array.h"
#include "frame/meter.h"
#include "frame/plan.h"
#include "frame/recheck.h"
#include "passes/shade.h"
#include "passes/uniforms.h"
#include "picture/settings.h"
#include "picture/targets.h"

namespace lightband {

class Frame {
public:
    static constexpr uint32_t largest_side = 8192;

    Frame(gl::DevicePtr device, uint32_t width, uint32_t height);

    const gl::DevicePtr& device() const { return device_; }
    Settings settings;

    // On any exception the frame stays as it was.
    void render(const Scene& scene, const Progress& progress);

    lb_frame_stats stats() const;
    const Settings& rendered_settings() const;  // those of the last render
    std::string explain() const;
    HostArray field(const std::string& name) const;

    struct FieldName {
        const char* name;
        bool predicted;  // absent from a reference frame
    };
    static constexpr FieldName field_names[] = {
        {"color", false},
        {"depth", false},
        {"position", false},
        {"normal", false},
        {"curvature", true},
        {"material", false},
        {"bandwidth_spatial", true},
        {"bandwidth_angular", true},
        {"bandwidth_image", true},
        {"level", true},
        {"shaded", false},
        {"sample_count", false},
        {"error", false},
        {"variance_predicted", true},
        {"variance_measured", false},
        {"level_pyramid", true},
        {"variance_pyramid", true},
    };

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }

private:
    struct Result;
    struct Job;  // a render call on its way
    const Result& result() const;
    Forecast predict(Job* job) const;
    std::vector<uint32_t> draw(const Job& job, double part) const;
    std::vector<Audit::Pixel> shade_alike(const Job& job, const std::vector<uint32_t>& drawn, const Settings& own, uint32_t samples,
                                          uint32_t seed) const;
    void audit(Job* job, Forecast* forecast) const;
    void draw_pilots(Job* job, const std::vector<uint32_t>& drawn, uint32_t samples) const;
    void plan_from_pilots(const Job& job, Forecast* forecast) const;
    double probed_error(const Job& job, const std::vector<Audit::Pixel>& probe, const Forecast& forecast) const;
    void look_closely(Job* job, const std::vector<uint32_t>& drawn, uint32_t samples) const;
    // A validation pixel that is to be rechecked: chosen by chance; and one where pilot pass and validation differ.
    struct Rechecked {
        size_t place;
        bool by_chance, differs;
    };
    std::vector<Rechecked> choose_rechecked(const Job& job, double mean_radiance) const;
    Recheck recheck(Job* job, double mean_radiance) const;
    double harmless_difference(const Job& job, double mean_radiance) const;
    void replace_sampler(Job* job, double mean_radiance) const;
    Settings with_sampler(const char* sampler) const;
    bool audit_again(Job* job) const;
    bool rounds(Job* job, const Forecast& forecast) const;
    void choose_levels(Job* job, const Control& control, const Forecast& forecast) const;
    void decide(Job* job, Control* control, const Forecast& forecast) const;
    bool list(Job* job, Control* control, const Forecast& forecast) const;
    double expected_shading(double covered) const;
    void report_preparation(const Job& job) const;
    void report_shading(const Job& job, double samples) const;
    void shade(Job* job, const passes::Seeds& seeds) const;
    void measure(Job* job) const;
    void combine(const Job& job) const;
    void accumulate(Job* job) const;
    void finish(Job* job) const;
    std::vector<float> interpolation_shape() const;
    // Fields by name; material: of each pixel, instance + 1 or 0.
    HostArray scalar(std::vector<float> values, const char* unit) const;
    HostArray seen(const std::string& name, const std::vector<uint8_t>& material) const;
    HostArray predicted(const std::string& name, const std::vector<uint8_t>& material) const;
    HostArray pyramid(const std::string& name, const std::vector<uint8_t>& material) const;
    HostArray shaded(const std::string& name, const std::vector<uint8_t>& material) const;
    uint64_t pixels() const { return uint64_t(width_) * height_; }

    gl::DevicePtr device_;
    uint32_t width_, height_;
    std::shared_ptr<const Result> result_;
    Pace pace_;  // of this frame's last rounds
};

}  // namespace lightband
