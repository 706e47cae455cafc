// The C++ wrapper in callbacks: objects that die there, exceptions, threads that end there.
#include <pthread.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "lightband/lightband.hpp"

extern "C" {
// clang-format off
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
// clang-format on
}

namespace {

lightband::ContextOptions software() {
    lightband::ContextOptions options;
    options.device = LB_DEVICE_SOFTWARE;
    options.cache_path = "";
    return options;
}

struct Objects {
    lightband::Context context{software()};
    lightband::Scene scene = context.scene();
    lightband::Frame frame = context.frame(16, 16);

    Objects() {
        const std::vector<float> white(8 * 4 * 3, 1.0f);
        scene.set_environment(context.environment(8, 4, white.data()));
        lightband::Camera camera;
        camera.eye = {0, 0, 2};
        scene.set_camera(camera);
        scene.add(context.builtin_mesh("sphere", 16), context.lambert({0.5f, 0.5f, 0.5f}));
        frame.set("samples", 4);
        frame.set("method", "reference");
    }
};

// A handle that is still valid could be retained once more.
bool is_released(lb_mesh mesh) {
    return lb_mesh_retain(mesh) == LB_ERROR_INVALID_HANDLE;
}

void an_object_that_dies_in_a_callback_is_released_afterwards(void**) {
    Objects objects;
    auto mesh = std::make_unique<lightband::Mesh>(objects.context.builtin_mesh("plane", 8));
    const lb_mesh raw = mesh->get();
    bool released_inside = true;
    objects.frame.render(objects.scene, [&](double) {
        if (mesh) {
            mesh.reset();
            released_inside = is_released(raw);
        }
        return false;
    });
    assert_false(released_inside);
    assert_true(is_released(raw));
}

void an_exception_of_a_callback_comes_back(void**) {
    Objects objects;
    bool caught = false;
    try {
        objects.frame.render(objects.scene, [](double) -> bool { throw std::runtime_error("of the callback"); });
    } catch (const std::runtime_error& error) {
        caught = std::string(error.what()) == "of the callback";
    }
    assert_true(caught);
    objects.frame.render(objects.scene);
}

void* render_until_the_thread_ends(void* given) {
    auto& objects = *static_cast<Objects*>(given);
    objects.frame.render(objects.scene, [](double) -> bool { pthread_exit(nullptr); });
    return given;  // not reached
}

void* create_until_the_thread_ends(void* given) {
    lightband::ContextOptions options = software();
    options.log = [](const char*) { pthread_exit(nullptr); };
    const lightband::Context context(options);
    return given;  // not reached
}

void a_thread_may_end_in_a_callback(void**) {
    Objects objects;
    for (const auto work : {render_until_the_thread_ends, create_until_the_thread_ends}) {
        pthread_t thread;
        void* result = &objects;
        assert_int_equal(pthread_create(&thread, nullptr, work, &objects), 0);
        assert_int_equal(pthread_join(thread, &result), 0);
        assert_null(result);
    }
    objects.frame.render(objects.scene);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(an_object_that_dies_in_a_callback_is_released_afterwards),
        cmocka_unit_test(an_exception_of_a_callback_comes_back),
        cmocka_unit_test(a_thread_may_end_in_a_callback),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
