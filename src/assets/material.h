// A BRDF on a device: its table, its sampling tables, and what prediction needs, each made when first asked for.
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "bandwidth/lobe_bandwidth.h"
#include "gl/objects.h"
#include "sampling/lobe_sampler.h"
#include "sampling/pilots.h"

namespace lightband {

class Material {
public:
    Material(gl::DevicePtr device, Brdf brdf);

    const gl::DevicePtr& device() const { return device_; }
    const Brdf& brdf() const { return brdf_; }
    // Throws code where a table reflects more than so many times the light from some direction; the message names
    // source and value. Nothing real reflects more than once that; what noise squares, under the brightest map
    // (largest_radiance), stays within float.
    static constexpr double largest_albedo = 100;
    void check_albedo(const std::string& source, lb_result code) const;

    // Definitions of the lobe.glsl variant, and binding of its tables and uniforms.
    std::string definitions(Lookup lookup) const;
    void bind(const gl::Program& program) const;
    // What the map's clusters and the trunk of its tree are weighed by (src/sampling/lobe_sampler.h), made when first
    // asked for.
    void bind_importance() const;

    // The same for what predicts_by_lobe asks for (src/lights/light.h).
    void bind_bandwidth(BandRule rule) const;

    const LobeBandwidth& bandwidth(BandRule rule) const;
    const std::vector<Pilot>& pilots(BandRule rule, uint32_t count) const;
    size_t device_bytes() const {
        return cells_.bytes() + lobe_x_.bytes() + lobe_phi_.bytes() + lobe_albedo_.bytes() + lobe_denser_.bytes() +
               importance_.bytes() + bandwidth_.bytes();
    }

private:
    void upload_table(const BrdfTable& table);

    gl::DevicePtr device_;
    const Brdf brdf_;
    const LobeSampler sampler_;
    float table_scale_ = 1;
    gl::Buffer cells_, lobe_x_, lobe_phi_, lobe_albedo_, lobe_denser_;
    gl::Texture cells_texture_, lobe_x_texture_, lobe_phi_texture_, lobe_albedo_texture_, lobe_denser_texture_;
    mutable gl::Buffer importance_, bandwidth_;
    mutable gl::Texture importance_texture_, bandwidth_texture_;
    mutable BandRule bandwidth_rule_{};  // of the one on the device
    mutable std::map<BandRule, LobeBandwidth> bandwidths_;
    mutable std::map<std::pair<BandRule, uint32_t>, std::vector<Pilot>> pilots_;
};

}  // namespace lightband
