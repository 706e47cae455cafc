/* Materials, maps and meshes from arguments and files that make no sense, or barely. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

enum { TABLE_VALUES = 90 * 90 * 180 * 3 }; /* of a MERL table */

static const float grey[3] = {0.5f, 0.5f, 0.5f};
static const float up[3] = {0, 0, 1};

/* ---- Results and context ---- */

static void results_have_names(void** state) {
    (void)state;
    assert_string_equal(lb_result_name(LB_OK), "LB_OK");
    assert_string_equal(lb_result_name(LB_ERROR_INTERNAL), "LB_ERROR_INTERNAL");
    assert_string_equal(lb_result_name(LB_ERROR_INTERNAL + 1), "unknown");
    assert_string_equal(lb_result_name(INT32_MIN), "unknown");
}

static void message_stays_until_the_next_failure(void** state) {
    (void)state;
    float rgb[3];
    assert_refused(lb_brdf_albedo(world.brdf, -1.0f, rgb), LB_ERROR_INVALID_ARGUMENT, "theta_o");
    assert_ok(lb_brdf_albedo(world.brdf, 0.5f, rgb));
    assert_non_null(strstr(lb_error_message(), "theta_o"));
}

static void context_needs_a_known_device(void** state) {
    (void)state;
    lb_context context = NULL;
    lb_context_desc desc = LB_CONTEXT_DESC_INIT;
    desc.device = LB_DEVICE_ANY + 1;
    assert_refused(lb_context_create(&desc, &context), LB_ERROR_INVALID_ARGUMENT, "device", "3");
    desc.device = LB_DEVICE_SOFTWARE;
    assert_refused(lb_context_create(&desc, NULL), LB_ERROR_INVALID_ARGUMENT, "context");
    assert_null(context);
}

/* Hardware is never replaced by software: it is there, or every attempt is told. */
static void hardware_is_hardware_or_an_error(void** state) {
    (void)state;
    lb_context context = NULL;
    uint32_t software = 1;
    const lb_result result = lb_context_create(NULL, &context);
    if (result == LB_OK) {
        assert_ok(lb_context_is_software(context, &software));
        assert_int_equal(software, 0);
        assert_ok(lb_context_release(context));
    } else {
        assert_refused(result, LB_ERROR_DEVICE, "device", "surfaceless");
    }
}

static void context_tells_its_device(void** state) {
    (void)state;
    const char* name = NULL;
    uint32_t software = 0;
    assert_ok(lb_context_device_name(world.context, &name));
    assert_true(strlen(name) > 0);
    assert_ok(lb_context_is_software(world.context, &software));
    assert_int_equal(software, 1);
    assert_refused(lb_context_device_name(world.context, NULL), LB_ERROR_INVALID_ARGUMENT, "name");
    assert_refused(lb_context_is_software(world.context, NULL), LB_ERROR_INVALID_ARGUMENT, "software");
}

static void cache_that_cannot_be_written_costs_time_alone(void** state) {
    (void)state;
    lb_context context = NULL;
    lb_brdf brdf = NULL;
    lb_context_desc desc = LB_CONTEXT_DESC_INIT;
    desc.device = LB_DEVICE_SOFTWARE;
    desc.cache_path = "/dev/null/no folder";
    assert_ok(lb_context_create(&desc, &context));
    assert_ok(lb_brdf_builtin(context, lb_brdf_builtin_name(0), &brdf));
    assert_ok(lb_brdf_release(brdf));
    assert_ok(lb_context_release(context));
}

/* ---- Reflectance ---- */

static void brdf_file_must_be_one(void** state) {
    (void)state;
    lb_brdf brdf = NULL;
    lb_context context = world.context;
    assert_refused(lb_brdf_load(context, NULL, &brdf), LB_ERROR_INVALID_ARGUMENT, "path");
    assert_refused(lb_brdf_load(context, "x.binary", NULL), LB_ERROR_INVALID_ARGUMENT, "brdf");
    assert_refused(lb_brdf_load(context, "", &brdf), LB_ERROR_FILE, "");
    assert_refused(lb_brdf_load(context, "missing %s%n.binary", &brdf), LB_ERROR_FILE, "missing %s%n.binary");
    assert_refused(lb_brdf_load(context, "/", &brdf), LB_ERROR_FILE, "/");
    assert_refused(lb_brdf_load(context, LIGHTBAND_TEST_MAP, &brdf), LB_ERROR_FORMAT, LIGHTBAND_TEST_MAP);
    assert_null(brdf);
}

static void builtin_brdf_must_be_known(void** state) {
    (void)state;
    lb_brdf brdf = NULL;
    assert_refused(lb_brdf_builtin(world.context, NULL, &brdf), LB_ERROR_INVALID_ARGUMENT, "name");
    assert_refused(lb_brdf_builtin(world.context, lb_brdf_builtin_name(0), NULL), LB_ERROR_INVALID_ARGUMENT, "brdf");
    assert_refused(lb_brdf_builtin(world.context, "", &brdf), LB_ERROR_INVALID_ARGUMENT, "name");
    assert_refused(lb_brdf_builtin(world.context, "unobtainium", &brdf), LB_ERROR_INVALID_ARGUMENT, "unobtainium");
    assert_true(lb_brdf_builtin_count() > 0);
    for (uint32_t i = 0; i < lb_brdf_builtin_count(); ++i) {
        assert_non_null(strstr(lb_error_message(), lb_brdf_builtin_name(i)));
    }
    assert_null(lb_brdf_builtin_name(lb_brdf_builtin_count()));
    assert_null(lb_brdf_builtin_name(UINT32_MAX));
    assert_null(brdf);
}

static void brdf_table_must_have_the_layout(void** state) {
    (void)state;
    lb_brdf brdf = NULL;
    lb_context context = world.context;
    float* values = calloc(TABLE_VALUES, sizeof(float));
    assert_non_null(values);
    assert_refused(lb_brdf_create_table(context, NULL, TABLE_VALUES, &brdf), LB_ERROR_INVALID_ARGUMENT, "values");
    assert_refused(lb_brdf_create_table(context, values, TABLE_VALUES, NULL), LB_ERROR_INVALID_ARGUMENT, "brdf");
    const size_t wrong_counts[] = {0, 1, TABLE_VALUES - 1, TABLE_VALUES + 1, TABLE_VALUES / 3, SIZE_MAX};
    for (size_t i = 0; i < sizeof(wrong_counts) / sizeof(wrong_counts[0]); ++i) {
        assert_refused(lb_brdf_create_table(context, values, wrong_counts[i], &brdf), LB_ERROR_INVALID_ARGUMENT,
                       "count", "4374000");
    }
    const float not_finite[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; ++i) {
        values[TABLE_VALUES - 1] = not_finite[i];
        assert_refused(lb_brdf_create_table(context, values, TABLE_VALUES, &brdf), LB_ERROR_INVALID_ARGUMENT, "values");
    }
    assert_null(brdf);
    free(values);
}

static void lambert_albedo_has_a_range(void** state) {
    (void)state;
    lb_brdf brdf = NULL;
    assert_refused(lb_brdf_create_lambert(world.context, NULL, &brdf), LB_ERROR_INVALID_ARGUMENT, "albedo");
    assert_refused(lb_brdf_create_lambert(world.context, grey, NULL), LB_ERROR_INVALID_ARGUMENT, "brdf");
    const float wrong[] = {-0.1f, nextafterf(1.0f, 2.0f), INFINITY, -INFINITY, NAN};
    for (int i = 0; i < 5; ++i) {
        const float albedo[3] = {0.5f, 0.5f, wrong[i]};
        assert_refused(lb_brdf_create_lambert(world.context, albedo, &brdf), LB_ERROR_INVALID_ARGUMENT, "albedo");
    }
    assert_null(brdf);
}

static void ggx_parameters_have_ranges(void** state) {
    (void)state;
    lb_brdf brdf = NULL;
    assert_refused(lb_brdf_create_ggx(world.context, 0.5f, NULL, &brdf), LB_ERROR_INVALID_ARGUMENT, "f0");
    assert_refused(lb_brdf_create_ggx(world.context, 0.5f, grey, NULL), LB_ERROR_INVALID_ARGUMENT, "brdf");
    const float wrong_alpha[] = {0.0f, -0.5f, 9e-5f, nextafterf(1.0f, 2.0f), INFINITY, NAN};
    for (int i = 0; i < 6; ++i) {
        assert_refused(lb_brdf_create_ggx(world.context, wrong_alpha[i], grey, &brdf), LB_ERROR_INVALID_ARGUMENT,
                       "alpha");
    }
    const float wrong_f0[] = {-0.1f, 1.1f, INFINITY, NAN};
    for (int i = 0; i < 4; ++i) {
        const float f0[3] = {wrong_f0[i], 0.5f, 0.5f};
        assert_refused(lb_brdf_create_ggx(world.context, 0.5f, f0, &brdf), LB_ERROR_INVALID_ARGUMENT, "f0");
    }
    assert_null(brdf);
    for (int i = 0; i < 2; ++i) { /* the range's ends belong to it */
        assert_ok(lb_brdf_create_ggx(world.context, i == 0 ? 1e-4f : 1.0f, grey, &brdf));
        assert_ok(lb_brdf_release(brdf));
    }
}

static void evaluation_needs_directions(void** state) {
    (void)state;
    float rgb[3] = {7, 7, 7};
    const float nowhere[3] = {0, 0, 0}, strange[3] = {0, NAN, 1}, below[3] = {0, 0, -1};
    assert_refused(lb_brdf_evaluate(world.brdf, NULL, up, rgb), LB_ERROR_INVALID_ARGUMENT, "wi");
    assert_refused(lb_brdf_evaluate(world.brdf, up, NULL, rgb), LB_ERROR_INVALID_ARGUMENT, "wo");
    assert_refused(lb_brdf_evaluate(world.brdf, up, up, NULL), LB_ERROR_INVALID_ARGUMENT, "rgb");
    assert_refused(lb_brdf_evaluate(world.brdf, nowhere, up, rgb), LB_ERROR_INVALID_ARGUMENT, "wi");
    assert_refused(lb_brdf_evaluate(world.brdf, up, strange, rgb), LB_ERROR_INVALID_ARGUMENT, "wo");
    assert_true(rgb[0] == 7 && rgb[1] == 7 && rgb[2] == 7);
    assert_ok(lb_brdf_evaluate(world.brdf, below, up, rgb));
    assert_true(rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0);
}

static void albedo_needs_an_angle_above_the_horizon(void** state) {
    (void)state;
    float rgb[3];
    const float wrong[] = {-1e-3f, 1.5707964f /* the float above pi/2 */, 3.0f, INFINITY, NAN};
    for (int i = 0; i < 5; ++i) {
        assert_refused(lb_brdf_albedo(world.brdf, wrong[i], rgb), LB_ERROR_INVALID_ARGUMENT, "theta_o");
    }
    assert_refused(lb_brdf_albedo(world.brdf, 0.0f, NULL), LB_ERROR_INVALID_ARGUMENT, "rgb");
}

/* ---- Environment ---- */

static void environment_file_must_be_one(void** state) {
    (void)state;
    lb_environment map = NULL;
    lb_context context = world.context;
    assert_refused(lb_environment_load(context, NULL, &map), LB_ERROR_INVALID_ARGUMENT, "path");
    assert_refused(lb_environment_load(context, LIGHTBAND_TEST_MAP, NULL), LB_ERROR_INVALID_ARGUMENT, "environment");
    assert_refused(lb_environment_load(context, "missing.exr", &map), LB_ERROR_FILE, "missing.exr");
    assert_refused(lb_environment_load(context, "missing.hdr", &map), LB_ERROR_FILE, "missing.hdr");
    assert_refused(lb_environment_load(context, LIGHTBAND_TEST_TEXT, &map), LB_ERROR_FORMAT, LIGHTBAND_TEST_TEXT);
    assert_null(map);
}

static void environment_size_has_limits(void** state) {
    (void)state;
    lb_environment map = NULL;
    lb_context context = world.context;
    assert_refused(lb_environment_create(context, 1, 1, NULL, &map), LB_ERROR_INVALID_ARGUMENT, "rgb");
    assert_refused(lb_environment_create(context, 1, 1, grey, NULL), LB_ERROR_INVALID_ARGUMENT, "environment");
    assert_refused(lb_environment_create(context, 0, 1, grey, &map), LB_ERROR_INVALID_ARGUMENT, "width");
    assert_refused(lb_environment_create(context, 1, 0, grey, &map), LB_ERROR_INVALID_ARGUMENT, "height");
    /* Refused before the three floats are read as so many texels. */
    assert_refused(lb_environment_create(context, 16385, 1, grey, &map), LB_ERROR_INVALID_ARGUMENT, "width", "16384");
    assert_refused(lb_environment_create(context, 1, 8193, grey, &map), LB_ERROR_INVALID_ARGUMENT, "height", "8192");
    assert_refused(lb_environment_create(context, UINT32_MAX, UINT32_MAX, grey, &map), LB_ERROR_INVALID_ARGUMENT,
                   "16384");
    assert_null(map);
}

static void environment_texels_are_finite_and_not_negative(void** state) {
    (void)state;
    enum { WIDTH = 64, HEIGHT = 32, COLUMN = 37, ROW = 11 };
    lb_environment map = NULL;
    float* rgb = calloc((size_t)WIDTH * HEIGHT * 3, sizeof(float));
    assert_non_null(rgb);
    const float wrong[] = {-1e-6f, -INFINITY, INFINITY, NAN};
    for (int i = 0; i < 4; ++i) {
        rgb[(ROW * WIDTH + COLUMN) * 3 + 1] = wrong[i];
        assert_refused(lb_environment_create(world.context, WIDTH, HEIGHT, rgb, &map), LB_ERROR_INVALID_ARGUMENT, "37",
                       "11");
    }
    assert_null(map);
    free(rgb);
}

/* Maps that are odd but sound: the picture has no NaN. */
static void odd_environments_render(void** state) {
    (void)state;
    const struct {
        uint32_t width, height;
        float radiance, peak; /* everywhere, and in one texel */
    } maps[] = {
        {1, 1, 1.0f, 1.0f}, {3, 5, 1.0f, 2.0f},     {1, 7, 1.0f, 2.0f},        {7, 1, 1.0f, 2.0f},
        {4, 2, 0.0f, 0.0f}, {16, 8, 0.0f, 1e6f},    {16, 8, FLT_MIN, FLT_MIN}, {16, 8, 1e-40f, 1e-40f},
        {2, 2, 0.0f, 1.0f}, {64, 32, 1e-6f, 65504},
    };
    struct world mine;
    make_objects(&mine);
    for (size_t i = 0; i < sizeof(maps) / sizeof(maps[0]); ++i) {
        const size_t count = (size_t)maps[i].width * maps[i].height * 3;
        float* rgb = malloc(count * sizeof(float));
        assert_non_null(rgb);
        for (size_t value = 0; value < count; ++value) {
            rgb[value] = value / 3 == count / 6 ? maps[i].peak : maps[i].radiance;
        }
        lb_environment map = NULL;
        assert_ok(lb_environment_create(mine.context, maps[i].width, maps[i].height, rgb, &map));
        assert_ok(lb_scene_set_environment(mine.scene, map));
        assert_ok(lb_frame_render(mine.frame, mine.scene, NULL, NULL));
        assert_finite_field(mine.frame, "color");
        assert_finite_field(mine.frame, "bandwidth_image");
        assert_finite_field(mine.frame, "variance_predicted");
        assert_ok(lb_environment_release(map));
        free(rgb);
    }
    release_objects(&mine);
}

/* ---- Mesh ---- */

static float positions[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
static const float normals[12] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
static const float texcoords[8] = {0, 0, 1, 0, 0, 1, 1, 1};
static const uint32_t quad[6] = {0, 1, 2, 2, 1, 3};

static lb_mesh_desc quad_desc(void) {
    const lb_mesh_desc desc = {sizeof(lb_mesh_desc), 4, positions, normals, texcoords, quad, 2};
    return desc;
}

static void mesh_needs_vertices_and_triangles(void** state) {
    (void)state;
    lb_mesh mesh = NULL;
    lb_mesh_desc desc = quad_desc();
    assert_refused(lb_mesh_create(world.context, &desc, NULL), LB_ERROR_INVALID_ARGUMENT, "mesh");
    desc.positions = NULL;
    assert_refused(lb_mesh_create(world.context, &desc, &mesh), LB_ERROR_INVALID_ARGUMENT, "positions");
    desc = quad_desc();
    desc.indices = NULL;
    assert_refused(lb_mesh_create(world.context, &desc, &mesh), LB_ERROR_INVALID_ARGUMENT, "indices");
    desc = quad_desc();
    desc.vertex_count = 0;
    assert_refused(lb_mesh_create(world.context, &desc, &mesh), LB_ERROR_INVALID_ARGUMENT, "vertex_count");
    desc = quad_desc();
    desc.triangle_count = 0;
    assert_refused(lb_mesh_create(world.context, &desc, &mesh), LB_ERROR_INVALID_ARGUMENT, "triangle_count");
    desc = quad_desc();
    desc.normals = NULL; /* both are optional */
    desc.texcoords = NULL;
    assert_ok(lb_mesh_create(world.context, &desc, &mesh));
    assert_ok(lb_mesh_release(mesh));
}

static void mesh_index_must_name_a_vertex(void** state) {
    (void)state;
    lb_mesh mesh = NULL;
    lb_mesh_desc desc = quad_desc();
    uint32_t indices[6] = {0, 1, 2, 2, 1, 4};
    desc.indices = indices;
    assert_refused(lb_mesh_create(world.context, &desc, &mesh), LB_ERROR_INVALID_ARGUMENT, "indices[5]", "4");
    indices[5] = UINT32_MAX;
    assert_refused(lb_mesh_create(world.context, &desc, &mesh), LB_ERROR_INVALID_ARGUMENT, "indices[5]", "4294967295");
    assert_null(mesh);
}

static void mesh_vertices_must_be_finite(void** state) {
    (void)state;
    lb_mesh mesh = NULL;
    const float wrong[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; ++i) {
        lb_mesh_desc desc = quad_desc();
        float bad[12] = {0};
        bad[10] = wrong[i]; /* y of vertex 3 */
        desc.positions = bad;
        assert_refused(lb_mesh_create(world.context, &desc, &mesh), LB_ERROR_INVALID_ARGUMENT, "positions", "3");
        desc = quad_desc();
        desc.normals = bad;
        assert_refused(lb_mesh_create(world.context, &desc, &mesh), LB_ERROR_INVALID_ARGUMENT, "normals");
        desc = quad_desc();
        desc.texcoords = bad + 4;
        assert_refused(lb_mesh_create(world.context, &desc, &mesh), LB_ERROR_INVALID_ARGUMENT, "texcoords", "3");
    }
    const float no_normal[12] = {0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
    lb_mesh_desc desc = quad_desc();
    desc.normals = no_normal;
    assert_refused(lb_mesh_create(world.context, &desc, &mesh), LB_ERROR_INVALID_ARGUMENT, "normals", "2");
    assert_null(mesh);
}

static void triangles_without_area_are_dropped(void** state) {
    (void)state;
    lb_mesh mesh = NULL;
    lb_mesh_desc desc = quad_desc();
    const uint32_t one_is_a_line[6] = {0, 1, 2, 3, 3, 1}, both_are_points[6] = {0, 0, 0, 3, 3, 3};
    desc.indices = one_is_a_line;
    assert_ok(lb_mesh_create(world.context, &desc, &mesh));
    lb_mesh_stats stats = LB_MESH_STATS_INIT;
    assert_ok(lb_mesh_info(mesh, &stats));
    assert_int_equal(stats.triangles, 1);
    assert_int_equal(stats.dropped_triangles, 1);
    assert_ok(lb_mesh_release(mesh));

    mesh = NULL;
    desc.indices = both_are_points;
    assert_refused(lb_mesh_create(world.context, &desc, &mesh), LB_ERROR_INVALID_ARGUMENT, "triangle");
    assert_null(mesh);
}

static void builtin_mesh_must_be_known(void** state) {
    (void)state;
    lb_mesh mesh = NULL;
    assert_refused(lb_mesh_builtin(world.context, NULL, 0, &mesh), LB_ERROR_INVALID_ARGUMENT, "name");
    assert_refused(lb_mesh_builtin(world.context, "sphere", 0, NULL), LB_ERROR_INVALID_ARGUMENT, "mesh");
    assert_refused(lb_mesh_builtin(world.context, "teapot", 0, &mesh), LB_ERROR_INVALID_ARGUMENT, "teapot", "sphere",
                   "plane", "torus", "knot", "blob");
    const uint32_t wrong[] = {1, 7, 2049, UINT32_MAX};
    for (int i = 0; i < 4; ++i) {
        assert_refused(lb_mesh_builtin(world.context, "sphere", wrong[i], &mesh), LB_ERROR_INVALID_ARGUMENT,
                       "resolution", "8", "2048");
    }
    assert_null(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(results_have_names, world_renders_as_before),
        cmocka_unit_test_teardown(message_stays_until_the_next_failure, world_renders_as_before),
        cmocka_unit_test_teardown(context_needs_a_known_device, world_renders_as_before),
        cmocka_unit_test_teardown(hardware_is_hardware_or_an_error, world_renders_as_before),
        cmocka_unit_test_teardown(context_tells_its_device, world_renders_as_before),
        cmocka_unit_test_teardown(cache_that_cannot_be_written_costs_time_alone, world_renders_as_before),
        cmocka_unit_test_teardown(brdf_file_must_be_one, world_renders_as_before),
        cmocka_unit_test_teardown(builtin_brdf_must_be_known, world_renders_as_before),
        cmocka_unit_test_teardown(brdf_table_must_have_the_layout, world_renders_as_before),
        cmocka_unit_test_teardown(lambert_albedo_has_a_range, world_renders_as_before),
        cmocka_unit_test_teardown(ggx_parameters_have_ranges, world_renders_as_before),
        cmocka_unit_test_teardown(evaluation_needs_directions, world_renders_as_before),
        cmocka_unit_test_teardown(albedo_needs_an_angle_above_the_horizon, world_renders_as_before),
        cmocka_unit_test_teardown(environment_file_must_be_one, world_renders_as_before),
        cmocka_unit_test_teardown(environment_size_has_limits, world_renders_as_before),
        cmocka_unit_test_teardown(environment_texels_are_finite_and_not_negative, world_renders_as_before),
        cmocka_unit_test_teardown(odd_environments_render, world_renders_as_before),
        cmocka_unit_test_teardown(mesh_needs_vertices_and_triangles, world_renders_as_before),
        cmocka_unit_test_teardown(mesh_index_must_name_a_vertex, world_renders_as_before),
        cmocka_unit_test_teardown(mesh_vertices_must_be_finite, world_renders_as_before),
        cmocka_unit_test_teardown(triangles_without_area_are_dropped, world_renders_as_before),
        cmocka_unit_test_teardown(builtin_mesh_must_be_known, world_renders_as_before),
    };
    return cmocka_run_group_tests_name("misuse of materials, maps and meshes", tests, make_world, release_world);
}
