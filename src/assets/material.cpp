#include "assets/material.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "base/error.h"

namespace lightband {

Material::Material(gl::DevicePtr device, Brdf brdf)
    : device_(std::move(device)), brdf_(std::move(brdf)), sampler_(brdf_) {
    if (const auto* table = std::get_if<BrdfTable>(&brdf_)) upload_table(*table);
}

void Material::check_albedo(const std::string& source, lb_result code) const {
    const std::vector<float>& albedos = sampler_.table().albedo;
    const auto most = std::max_element(albedos.begin(), albedos.end());
    if (most == albedos.end() || *most <= largest_albedo) return;
    const double degrees = (double(most - albedos.begin()) + 0.5) * 90 / LobeTable::views;
    throw Error(code, text(source, ": it reflects ", *most, " times the light that falls in at ", degrees,
                           " degrees; at most ", largest_albedo, " are taken"));
}

// Four halves a cell: RGB divided by a power of two that brings the largest value to at most 2^15, and whether the cell
// was measured. A half keeps 11 bits, 2^-12 of relative rounding, down to 2^-29 of the largest value.
void Material::upload_table(const BrdfTable& table) {
    const float largest = *std::max_element(table.rgb.begin(), table.rgb.end());
    table_scale_ = largest > 0 ? std::ldexp(1.0f, std::ilogb(largest) - 14) : 1.0f;
    std::vector<uint64_t> cells(BrdfTable::cell_count);
    for (size_t i = 0; i < cells.size(); ++i) {
        const float* rgb = &table.rgb[3 * i];
        const bool measured = rgb[0] >= 0;
        cells[i] = glm::packHalf4x16(
            measured ? glm::vec4(rgb[0], rgb[1], rgb[2], 0) / table_scale_ + glm::vec4(0, 0, 0, 1) : glm::vec4(0));
    }
    const gl::Functions& gl = device_->gl();
    if (size_t(device_->max_texture_buffer_texels()) < cells.size())
        throw Error(LB_ERROR_LIMIT,
                    text("a BRDF table of ", cells.size(), " cells exceeds the device's texture buffers of ",
                         device_->max_texture_buffer_texels(), " texels"));
    cells_ = gl::Buffer(gl, cells.size() * sizeof(uint64_t), cells.data());
    cells_texture_ = gl::Texture::of_buffer(gl, GL_RGBA16F, cells_);
    const LobeTable& lobes = sampler_.table();
    lobe_x_ = gl::Buffer(gl, lobes.x.size() * sizeof(LobeTable::Step), lobes.x.data());
    lobe_x_texture_ = gl::Texture::of_buffer(gl, GL_RG32F, lobe_x_);
    lobe_phi_ = gl::Buffer(gl, lobes.phi.size() * sizeof(LobeTable::Step), lobes.phi.data());
    lobe_phi_texture_ = gl::Texture::of_buffer(gl, GL_RG32F, lobe_phi_);
    lobe_albedo_ = gl::Buffer(gl, lobes.albedo.size() * sizeof(float), lobes.albedo.data());
    lobe_albedo_texture_ = gl::Texture::of_buffer(gl, GL_R32F, lobe_albedo_);
    lobe_denser_ = gl::Buffer(gl, lobes.denser.size() * sizeof(float), lobes.denser.data());
    lobe_denser_texture_ = gl::Texture::of_buffer(gl, GL_R32F, lobe_denser_);
    device_->check("uploading a BRDF");
}

std::string Material::definitions(Lookup lookup) const {
    const std::string views = text("LOBE_VIEWS ", LobeTable::views, "\nIMPORTANCE_SIDE ", LobeImportance::side);
    if (std::holds_alternative<Lambert>(brdf_)) return "LOBE_LAMBERT\n" + views;
    if (std::holds_alternative<Ggx>(brdf_)) return "LOBE_GGX\n" + views;
    return text("LOBE_TABLE\n", views, "\nLOBE_RADIAL ", LobeTable::radial, "\nLOBE_AZIMUTHAL ", LobeTable::azimuthal,
                "\nLOBE_DEFENSIVE ", LobeTable::defensive_part, "\nLOBE_OCTAVES ", LobeTable::octaves,
                "\nLOBE_FIRST_OCTAVE ", LobeTable::first_octave, lookup == Lookup::linear ? "\nBRDF_LINEAR" : "");
}

void Material::bind(const gl::Program& program) const {
    if (const auto* lambert = std::get_if<Lambert>(&brdf_)) {
        program.set("albedo", {float(lambert->albedo.x), float(lambert->albedo.y), float(lambert->albedo.z)});
    } else if (const auto* ggx = std::get_if<Ggx>(&brdf_)) {
        program.set("alpha", float(ggx->alpha));
        program.set("f0", {float(ggx->f0.x), float(ggx->f0.y), float(ggx->f0.z)});
    } else {
        program.set("table_scale", table_scale_);
        device_->gl().BindTextureUnit(2, cells_texture_.name());
        device_->gl().BindTextureUnit(3, lobe_x_texture_.name());
        device_->gl().BindTextureUnit(4, lobe_phi_texture_.name());
        device_->gl().BindTextureUnit(8, lobe_denser_texture_.name());
        device_->gl().BindTextureUnit(9, lobe_albedo_texture_.name());
    }
}

void Material::bind_importance() const {
    if (!importance_) {
        const LobeImportance importance = lobe_importance(brdf_);
        std::vector<float> all = importance.values;
        all.insert(all.end(), importance.peaks.begin(), importance.peaks.end());
        all.insert(all.end(), importance.albedos.begin(), importance.albedos.end());
        gl::Buffer made(device_->gl(), all.size() * sizeof(float), all.data());
        importance_texture_ = gl::Texture::of_buffer(device_->gl(), GL_R32F, made);
        importance_ = std::move(made);  // last: where it is there, its texture is
    }
    device_->gl().BindTextureUnit(12, importance_texture_.name());
}

void Material::bind_bandwidth(BandRule rule) const {
    if (!bandwidth_ || bandwidth_rule_ != rule) {
        const std::vector<float>& values = bandwidth(rule).values;
        gl::Buffer made(device_->gl(), values.size() * sizeof(float), values.data());
        bandwidth_texture_ = gl::Texture::of_buffer(device_->gl(), GL_R32F, made);
        bandwidth_ = std::move(made);
        bandwidth_rule_ = rule;
    }
    device_->gl().BindTextureUnit(6, bandwidth_texture_.name());
}

const LobeBandwidth& Material::bandwidth(BandRule rule) const {
    auto found = bandwidths_.find(rule);
    if (found == bandwidths_.end()) found = bandwidths_.emplace(rule, lobe_bandwidth(brdf_, rule)).first;
    return found->second;
}

const std::vector<Pilot>& Material::pilots(BandRule rule, uint32_t count) const {
    auto found = pilots_.find({rule, count});
    if (found == pilots_.end())
        found = pilots_.emplace(std::make_pair(rule, count), lightband::pilots(brdf_, sampler_, bandwidth(rule), count))
                    .first;
    return found->second;
}

}  // namespace lightband
