// Meshes with their materials, lights, one camera.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "assets/material.h"
#include "assets/mesh.h"
#include "lights/light.h"
#include "scene/camera.h"

namespace lightband {

struct Transform {
    glm::dmat4 matrix{1};

    // 12 floats, three rows of an affine matrix; nullptr: identity. Throws when not finite or not invertible.
    static Transform from(const float* rows);
};

struct Instance {
    std::shared_ptr<const Mesh> mesh;
    std::shared_ptr<const Material> material;
    Transform transform;
    bool double_sided = true;  // or only the front of its triangles is drawn
};

class Scene {
public:
    static constexpr size_t most_instances = 254;  // the material buffer holds number + 1 in a byte

    explicit Scene(gl::DevicePtr device) : device_(std::move(device)) {}

    const gl::DevicePtr& device() const { return device_; }
    uint32_t add(Instance instance);
    Instance& instance(uint32_t index);  // throws where there is none

    // The environment is the one light of which there is one at most: it takes the place of the former one.
    void set_environment(std::shared_ptr<const Light> environment) { environment_ = std::move(environment); }
    // Other lights, any number: each once. Throws where a light is there already, or is not there to be removed.
    static constexpr size_t most_lights = 1024;
    void add_light(std::shared_ptr<const Light> light);
    void remove_light(const std::shared_ptr<const Light>& light);
    std::vector<std::shared_ptr<const Light>> lights() const;  // the environment first

    std::optional<Camera> camera;
    const std::vector<Instance>& instances() const { return instances_; }

    // The distinct materials in order of first use: a material's place is its slot; and each instance's slot.
    struct Slots {
        std::vector<const Material*> materials;
        std::vector<uint32_t> of_instance;
    };
    Slots slots() const;
    size_t light_bytes() const;  // on the device, of its lights
    size_t device_bytes() const;

private:
    gl::DevicePtr device_;
    std::vector<Instance> instances_;
    std::shared_ptr<const Light> environment_;
    std::vector<std::shared_ptr<const Light>> lights_;  // the others
};

}  // namespace lightband
