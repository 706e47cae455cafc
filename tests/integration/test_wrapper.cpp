// The C++ wrapper in callbacks: objects that die there, exceptions, threads that end there.
#include <pthread.h>

#include <cstdio>
#include <cstring>
#include <locale>
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

// As std::locale("de_DE.UTF-8") has it, which need not be installed.
struct GermanNumbers : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

// What the library writes and reads while that locale is the host's: plan, message, and a picture that is saved and
// loaded again.
std::vector<std::string> texts() {
    Objects objects;
    lightband::Frame frame = objects.context.frame(128, 64);
    frame.set("samples", 4);
    frame.render(objects.scene);
    std::vector<std::string> result{frame.plan(objects.scene)};
    const std::string explained = frame.explain();
    result.push_back(explained.substr(0, explained.find("total")));  // what follows are milliseconds
    try {
        frame.set("samples", 1234567.5);
    } catch (const lightband::Exception& error) {
        result.emplace_back(error.what());
    }
    frame.save("locale.exr");
    const lightband::Buffer map = objects.context.load_environment("locale.exr").map("radiance");
    const float* radiance = map.data<float>();
    result.emplace_back();
    for (size_t i = 0; i < size_t(3) * 128 * 64; ++i) result.back() += std::to_string(radiance[i]) + " ";
    std::remove("locale.exr");
    return result;
}

void no_text_depends_on_the_locale_of_the_host(void**) {
    const std::vector<std::string> classic = texts();
    assert_int_equal(classic.size(), 4);
    assert_non_null(std::strstr(classic[1].c_str(), " 8192 pixels"));
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new GermanNumbers));
    const std::vector<std::string> german = texts();
    std::locale::global(before);
    for (size_t i = 0; i < classic.size(); ++i) assert_true(german[i] == classic[i]);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(an_object_that_dies_in_a_callback_is_released_afterwards),
        cmocka_unit_test(an_exception_of_a_callback_comes_back),
        cmocka_unit_test(a_thread_may_end_in_a_callback),
        cmocka_unit_test(no_text_depends_on_the_locale_of_the_host),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
