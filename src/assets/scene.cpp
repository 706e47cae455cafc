#include "assets/scene.h"

#include <algorithm>
#include <set>

namespace lightband {

Transform Transform::from(const float* rows) {
    Transform transform;
    if (rows == nullptr) return transform;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) {
            const float value = rows[4 * row + column];
            if (!std::isfinite(value))
                throw Error(LB_ERROR_INVALID_ARGUMENT,
                            text("transform[", row, "][", column, "] is ", value, "; it must be finite"));
            transform.matrix[column][row] = value;
        }
    const glm::dmat3 linear(transform.matrix);
    const double volume = std::abs(glm::determinant(linear));
    const double lengths = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
    // Columns come as float: a volume below ten of its roundings cannot be told from a flat matrix.
    constexpr double flat = 1e-6;
    if (!(volume > flat * lengths))
        throw Error(LB_ERROR_INVALID_ARGUMENT,
                    text("transform is singular: its determinant is ", glm::determinant(linear)));
    return transform;
}

uint32_t Scene::add(Instance instance) {
    if (instances_.size() == most_instances)
        throw Error(LB_ERROR_LIMIT, text("the scene holds ", most_instances, " instances already, its limit"));
    instances_.push_back(std::move(instance));
    return uint32_t(instances_.size() - 1);
}

Instance& Scene::instance(uint32_t index) {
    if (index >= instances_.size())
        throw Error(LB_ERROR_INVALID_ARGUMENT,
                    text("index is ", index, "; the scene has ", instances_.size(), " instances"));
    return instances_[index];
}

std::vector<std::shared_ptr<const Light>> Scene::lights() const {
    std::vector<std::shared_ptr<const Light>> all;
    if (environment_) all.push_back(environment_);
    all.insert(all.end(), lights_.begin(), lights_.end());
    return all;
}

void Scene::add_light(std::shared_ptr<const Light> light) {
    if (std::find(lights_.begin(), lights_.end(), light) != lights_.end())
        throw Error(LB_ERROR_INVALID_ARGUMENT, "light is in the scene already");
    if (lights_.size() == most_lights)
        throw Error(LB_ERROR_LIMIT, text("the scene holds ", most_lights, " lights already, its limit"));
    lights_.push_back(std::move(light));
}

void Scene::remove_light(const std::shared_ptr<const Light>& light) {
    const auto found = std::find(lights_.begin(), lights_.end(), light);
    if (found == lights_.end()) throw Error(LB_ERROR_INVALID_ARGUMENT, "light is not in the scene");
    lights_.erase(found);
}

Scene::Slots Scene::slots() const {
    Slots slots;
    for (const Instance& instance : instances_) {
        const auto found = std::find(slots.materials.begin(), slots.materials.end(), instance.material.get());
        slots.of_instance.push_back(uint32_t(found - slots.materials.begin()));
        if (found == slots.materials.end()) slots.materials.push_back(instance.material.get());
    }
    return slots;
}

size_t Scene::light_bytes() const {
    size_t bytes = 0;
    for (const auto& light : lights()) bytes += light->device_bytes();
    return bytes;
}

size_t Scene::device_bytes() const {
    std::set<const Mesh*> meshes;
    size_t bytes = light_bytes();
    for (const Instance& instance : instances_)
        if (meshes.insert(instance.mesh.get()).second) bytes += instance.mesh->device_bytes();
    for (const Material* material : slots().materials) bytes += material->device_bytes();
    return bytes;
}

}  // namespace lightband
