/*
 * lightband: shading of measured materials by bandwidth prediction.
 *
 * The C interface (C99). A program reads top to bottom:
 *
 *     lb_context      one OpenGL device, owned by the library
 *     lb_brdf         a reflectance: measured (MERL), built in, or analytic
 *     lb_environment  distant light: a latitude-longitude map
 *     lb_light        another light: a sun
 *     lb_mesh         triangles
 *     lb_scene        meshes with their materials, one environment, other lights, one camera
 *     lb_frame        a picture's size and settings; renders scenes, holds the fields
 *     lb_buffer       one field of a frame (or of a material, or of a map) as an array in memory
 *
 * Results    Every call returns lb_result. Output arguments are written on LB_OK alone. The text of the
 *            last failure on the calling thread is lb_error_message(). No call exits, aborts, prints or
 *            throws. A call that fails leaves everything as it was, where memory ran out too
 *            (LB_ERROR_OUT_OF_MEMORY): the same call succeeds once there is enough of it.
 * Handles    Opaque and reference counted. A create call returns one reference; *_release drops it;
 *            releasing NULL does nothing. Objects keep what they need alive: a mesh keeps its context,
 *            a scene its meshes. A handle that was released is recognised (LB_ERROR_INVALID_HANDLE).
 * Structs    Begin with `struct_size`, set by the *_INIT macro beside each. Zero in a field means the default. A larger
 *            struct of a later version is accepted where its unknown tail is zero (up to 4096 bytes).
 * Threads    Every call may come from any thread. Calls on objects of one context wait for each other;
 *            objects of different contexts are independent. Each context has a thread of its own, named
 *            "lightband", where its OpenGL context stays current: calls hand their work over and wait. The
 *            caller's OpenGL context, made by whatever window system, is neither needed nor touched. The
 *            library's threads block all signals. Whatever floating-point environment the caller has (traps,
 *            rounding, denormals flushed to zero), the library computes with the default one; a callback has
 *            the caller's. pthread_cancel takes effect after the call, or in a callback.
 * Callbacks  Run on the calling thread. Every call from a callback, a release and a retain included, fails with
 *            LB_ERROR_INVALID_STATE; functions that return no lb_result work. A callback may end its thread
 *            (pthread_exit): the call is then given up, and the context remains usable. It must not leave the
 *            call by longjmp.
 * Processes  Contexts do not outlive a fork: in a child of a process that had made one, every call fails at once
 *            with LB_ERROR_INVALID_STATE, and releases do nothing. Make contexts after fork, or start processes
 *            anew by exec. A process may end by exit while threads are inside the library: their calls fail with
 *            LB_ERROR_INVALID_STATE, as do all calls after the exit handlers of the OpenGL driver began to run,
 *            and releases do nothing. Exit handlers registered after the first context was made run before that.
 * Units      Metres, radians, cycles. Angular bandwidth in cycles per radian, spatial in cycles per metre,
 *            image bandwidth in cycles per pixel. Radiance is linear with Rec. 709 primaries; luminance
 *            weights 0.2126, 0.7152, 0.0722. World space is right-handed.
 * Arrays     Rows run top-down; the first element is the top left pixel.
 *
 * Equation numbers are those of Bagher et al., "Interactive Rendering of Acquired Materials on Dynamic
 * Geometry Using Frequency Analysis", IEEE TVCG 19(5), 2013, unless another source is named.
 */
#ifndef LIGHTBAND_LIGHTBAND_H
#define LIGHTBAND_LIGHTBAND_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(_WIN32)
#define LB_API
#else
#define LB_API __attribute__((visibility("default")))
#endif

#define LB_VERSION_MAJOR 0
#define LB_VERSION_MINOR 1
#define LB_VERSION_PATCH 0

/* Version of the library that runs: 10000 * major + 100 * minor + patch. */
LB_API uint32_t lb_version(void);

/* ---- Results ------------------------------------------------------------------------------------ */

typedef int32_t lb_result;

#define LB_OK 0
#define LB_ERROR_INVALID_ARGUMENT 1 /* an argument is NULL, not finite, out of range or of an unknown name */
#define LB_ERROR_INVALID_HANDLE 2   /* the handle is NULL, was released, or names an object of another kind */
#define LB_ERROR_INVALID_STATE 3    /* the call came too early (no camera, no frame rendered), from a callback,
                                       in a fork or at the end of the process */
#define LB_ERROR_FILE 4             /* a file cannot be opened, read, written or renamed */
#define LB_ERROR_FORMAT 5           /* a file is not what it says: truncated, corrupt, out of limits */
#define LB_ERROR_OUT_OF_MEMORY 6    /* host memory; a driver may end the process where its own runs out, as Mesa does */
#define LB_ERROR_DEVICE 7           /* no device, or OpenGL failed; the message lists every attempt */
#define LB_ERROR_LIMIT 8            /* a size is beyond what the device (its memory, too) or the library can hold */
#define LB_ERROR_CANCELLED 9        /* the progress callback asked to stop */
#define LB_ERROR_INTERNAL 10        /* a defect of the library: please report the message */

/* Name of a result, "LB_ERROR_FORMAT"; "unknown" for any other number. Never NULL; static storage. */
LB_API const char* lb_result_name(lb_result result);

/* Text of the last failure on the calling thread, "" before the first. It names file or argument, field,
 * value and limit. A success does not clear it. Valid until the thread's next failure. Never NULL. */
LB_API const char* lb_error_message(void);

/* ---- Handles ------------------------------------------------------------------------------------ */

typedef struct lb_context_handle* lb_context;
typedef struct lb_brdf_handle* lb_brdf;
typedef struct lb_environment_handle* lb_environment;
typedef struct lb_light_handle* lb_light;
typedef struct lb_mesh_handle* lb_mesh;
typedef struct lb_scene_handle* lb_scene;
typedef struct lb_frame_handle* lb_frame;
typedef struct lb_buffer_handle* lb_buffer;

LB_API lb_result lb_context_retain(lb_context context);
LB_API lb_result lb_context_release(lb_context context);
LB_API lb_result lb_brdf_retain(lb_brdf brdf);
LB_API lb_result lb_brdf_release(lb_brdf brdf);
LB_API lb_result lb_environment_retain(lb_environment environment);
LB_API lb_result lb_environment_release(lb_environment environment);
LB_API lb_result lb_light_retain(lb_light light);
LB_API lb_result lb_light_release(lb_light light);
LB_API lb_result lb_mesh_retain(lb_mesh mesh);
LB_API lb_result lb_mesh_release(lb_mesh mesh);
LB_API lb_result lb_scene_retain(lb_scene scene);
LB_API lb_result lb_scene_release(lb_scene scene);
LB_API lb_result lb_frame_retain(lb_frame frame);
LB_API lb_result lb_frame_release(lb_frame frame);
LB_API lb_result lb_buffer_retain(lb_buffer buffer);
LB_API lb_result lb_buffer_release(lb_buffer buffer);

/* ---- Context ------------------------------------------------------------------------------------ */

/* Which OpenGL device. Software rendering is a stated choice, never a silent fallback. */
#define LB_DEVICE_HARDWARE 0 /* a GPU; LB_ERROR_DEVICE where there is none */
#define LB_DEVICE_SOFTWARE 1 /* the CPU (Mesa llvmpipe) */
#define LB_DEVICE_ANY 2      /* a GPU, else the CPU; lb_context_device_name says which it became */

typedef void (*lb_log_callback)(void* user, const char* message);

typedef struct lb_context_desc {
    uint32_t struct_size;
    uint32_t device;        /* LB_DEVICE_* */
    lb_log_callback log;    /* driver and library messages; NULL: silence. Called on the calling thread */
    void* log_user;         /* handed to log */
    const char* cache_path; /* folder for the tables of built-in materials (35 MB each), made if missing.
                               NULL: $XDG_CACHE_HOME/lightband, else $HOME/.cache/lightband.
                               "": no cache. A folder that cannot be written costs time, never a failure */
} lb_context_desc;

#define LB_CONTEXT_DESC_INIT { sizeof(lb_context_desc), LB_DEVICE_HARDWARE, NULL, NULL, NULL }

/* Makes an OpenGL 4.5 core context of the library's own, without a window: EGL device platform first, then
 * Mesa's surfaceless platform. desc NULL: all defaults. EGL displays are shared by the whole process: the library
 * never terminates one, and a caller that does leaves living contexts usable.
 * LB_ERROR_DEVICE: no attempt succeeded; the message lists each with its reason.
 * LB_ERROR_OUT_OF_MEMORY: the context's thread cannot be started. */
LB_API lb_result lb_context_create(const lb_context_desc* desc, lb_context* context);

/* Renderer and version as the driver names them. Valid while the context lives. */
LB_API lb_result lb_context_device_name(lb_context context, const char** name);

/* Whether the device is a software renderer: 1 or 0. */
LB_API lb_result lb_context_is_software(lb_context context, uint32_t* software);

/* ---- Reflectance -------------------------------------------------------------------------------- */

/* A BRDF of a MERL .binary file (Matusik et al. 2003): three int32 (90, 90, 180), then 3 x 90 x 90 x 180
 * float64, channel-major, cells (theta_half [quadratic], theta_diff, phi_diff), scaled by (1, 1.15, 1.66)/1500
 * to 1/steradian. Negative cells were not measured. Those that directions above the horizon can reach are filled from
 * the measured cells of the same theta_half and phi_diff: between two of them linearly; beyond the last, towards
 * grazing, with its value (docs/conventions.md). The log callback hears how many were filled, and how many had nothing
 * to be filled from: these reflect nothing.
 * LB_ERROR_FILE, LB_ERROR_FORMAT (header, size, a cell that is not finite or above 1e9 per steradian, more than a hundred
 * times the light reflected). */
LB_API lb_result lb_brdf_load(lb_context context, const char* path, lb_brdf* brdf);

/* The same, but no cell is filled: those that were not measured reflect nothing. */
LB_API lb_result lb_brdf_load_as_measured(lb_context context, const char* path, lb_brdf* brdf);

/* A material that the library computes itself as a table in the MERL layout, from physical models and
 * published optical constants (docs/materials.md). Computed at first use (up to a second) and cached.
 * LB_ERROR_INVALID_ARGUMENT: unknown name; the message lists the names. */
LB_API lb_result lb_brdf_builtin(lb_context context, const char* name, lb_brdf* brdf);

/* Names of the built-in materials: index 0 .. count - 1. Static storage; NULL beyond the last. */
LB_API uint32_t lb_brdf_builtin_count(void);
LB_API const char* lb_brdf_builtin_name(uint32_t index);

/* A BRDF from a table in memory: float32 values in 1/steradian, shape [90][90][180][3], cells and order as in a
 * MERL file but colours interleaved, at most 1e9, nor more than a hundred times the light reflected. The table is
 * copied. Negative cells were not measured and reflect nothing; unlike a file's, they are not filled. */
LB_API lb_result lb_brdf_create_table(lb_context context, const float* values, size_t count, lb_brdf* brdf);

/* Lambert: albedo / pi. Each albedo channel in [0, 1]. */
LB_API lb_result lb_brdf_create_lambert(lb_context context, const float albedo[3], lb_brdf* brdf);

/* GGX microfacets (Walter et al. 2007) with height-correlated Smith shadowing and Schlick's Fresnel term.
 * alpha in [1e-4, 1] (roughness squared); f0, the reflectance at normal incidence, each channel in [0, 1]. */
LB_API lb_result lb_brdf_create_ggx(lb_context context, float alpha, const float f0[3], lb_brdf* brdf);

/* Value of the BRDF, RGB in 1/steradian, for two directions in the local frame (+Z is the normal; need not be
 * normalised). Zero where either lies below the horizon. Nearest cell of a table. Double precision inside. */
LB_API lb_result lb_brdf_evaluate(lb_brdf brdf, const float wi[3], const float wo[3], float rgb[3]);

/* Directional albedo, RGB: the part of the light from direction wo that is reflected, by quadrature of the cosine-
 * weighted BRDF over the hemisphere on the CPU in double precision. theta_o in [0, pi/2) radians. */
LB_API lb_result lb_brdf_albedo(lb_brdf brdf, float theta_o, float rgb[3]);

/* ---- Environment -------------------------------------------------------------------------------- */

/* Distant light from a latitude-longitude map: OpenEXR (.exr, every pixel type and compression that OpenEXR
 * reads) or Radiance (.hdr). +Y is up, the image's centre looks along +Z, its left edge along -Z (OpenEXR's
 * convention); texels are sampled at their centres. 1x1 up to 16384x8192, in a file of at most 1 GiB.
 * Headers are followed. OpenEXR: the map is what the display window shows, black where there are no data; a cube map (envmap) is
 * resampled; chromaticities (and adoptedNeutral) are converted to Rec. 709 with Bradford's adaptation; of several parts the first with
 * colour is read, deep parts never. Radiance: EXPOSURE, COLORCORR, PRIMARIES, all eight orientations, RGBE and XYZE (at 179 lm/W).
 * path may name a layer or part of an .exr: "map.exr#Combined" reads the channels Combined.R, Combined.G, Combined.B, or the part
 * Combined. A file that has the whole name comes first.
 * What a reader changes in the values, the log callback hears, with its count: negative values that a lossy compression (B44, B44A,
 * DWAA, DWAB) or chroma at half resolution may have made of light, and negative components of colours outside the gamut of Rec. 709,
 * become 0.
 * Reading takes little more memory than the file and three floats a texel. (For each chunk of a DWAA or DWAB file,
 * OpenEXR before 3.3 asks for buffers of 128 and 256 bytes and ends the process where it does not get one. Running out
 * of memory anywhere else is LB_ERROR_OUT_OF_MEMORY.)
 * LB_ERROR_FILE (also where path is no regular file: a folder, device, pipe or socket is not waited for), LB_ERROR_FORMAT (corrupt; no
 * colour or no such layer; chromaticities that span no colours; a texel that is negative, not finite or above 1e15: the message says
 * where), LB_ERROR_OUT_OF_MEMORY. */
LB_API lb_result lb_environment_load(lb_context context, const char* path, lb_environment* environment);

/* The same from memory: width * height * 3 float32, rows top-down, tightly packed, RGB interleaved. Copied. */
LB_API lb_result lb_environment_create(lb_context context, uint32_t width, uint32_t height, const float* rgb,
                                       lb_environment* environment);

/* ---- Suns --------------------------------------------------------------------------------------- */

/* A disc of uniform radiance, infinitely far away. A surface that faces it receives its irradiance, which is
 * the radiance of the disc times pi sin^2(angular_radius). */
typedef struct lb_sun_desc {
    uint32_t struct_size;
    float direction[3];   /* towards the sun, in world space; of any length but zero */
    float angular_radius; /* radians, 1e-4 .. pi / 2; zero: 0.004652, that of the sun seen from the earth */
    float irradiance[3];  /* RGB, in units of radiance times steradian (W/m^2 where radiance is in W/(m^2 sr));
                             not negative; the disc's radiance is at most 1e15 */
} lb_sun_desc;

#define LB_SUN_DESC_INIT { sizeof(lb_sun_desc), {0, 0, 0}, 0, {0, 0, 0} }

/* LB_ERROR_INVALID_ARGUMENT: a field is not finite or out of range; the message names it, its value and the limit. */
LB_API lb_result lb_sun_create(lb_context context, const lb_sun_desc* desc, lb_light* light);

/* Moves and changes a sun; scenes that it is in show it when they are rendered next. Nothing is allocated.
 * LB_ERROR_INVALID_HANDLE: light is not a sun. On any failure it stays as it was. */
LB_API lb_result lb_sun_set(lb_light light, const lb_sun_desc* desc);

/* ---- Mesh --------------------------------------------------------------------------------------- */

typedef struct lb_mesh_desc {
    uint32_t struct_size;
    uint32_t vertex_count;
    const float* positions; /* vertex_count * 3, metres */
    const float* normals;   /* vertex_count * 3, any length but zero; NULL: computed, area-weighted */
    const float* texcoords; /* vertex_count * 2, finite; NULL: none. No reflectance asks for them yet */
    const uint32_t* indices; /* triangle_count * 3, each below vertex_count */
    uint32_t triangle_count;
} lb_mesh_desc;

#define LB_MESH_DESC_INIT { sizeof(lb_mesh_desc), 0, NULL, NULL, NULL, NULL, 0 }

/* Triangles, copied. Both sides of a triangle are shaded, unless lb_scene_set_double_sided leaves out the back. Triangles of zero area
 * are dropped (counted by lb_mesh_info); a mesh of nothing else is an error.
 * LB_ERROR_INVALID_ARGUMENT: no vertices or triangles, an index out of range, a vertex that is not finite. */
LB_API lb_result lb_mesh_create(lb_context context, const lb_mesh_desc* desc, lb_mesh* mesh);

/* A computed shape about one metre across, centred at the origin: "sphere" (radius 0.5), "plane" (1 x 1, facing
 * +Z), "torus" (a ring around the Y axis: radius 0.34, of its tube 0.14), "knot" (a trefoil tube), "blob" (a
 * smooth bumpy sphere).
 * resolution: segments around, 8 to 2048; 0: 256. */
LB_API lb_result lb_mesh_builtin(lb_context context, const char* name, uint32_t resolution, lb_mesh* mesh);

typedef struct lb_mesh_stats {
    uint32_t struct_size;
    uint32_t vertices;
    uint32_t triangles;          /* those kept */
    uint32_t dropped_triangles;  /* those of zero area */
    float bounds_min[3];         /* metres */
    float bounds_max[3];
} lb_mesh_stats;

#define LB_MESH_STATS_INIT { sizeof(lb_mesh_stats), 0, 0, 0, {0, 0, 0}, {0, 0, 0} }

LB_API lb_result lb_mesh_info(lb_mesh mesh, lb_mesh_stats* stats);

/* ---- Scene -------------------------------------------------------------------------------------- */

typedef struct lb_camera_desc {
    uint32_t struct_size;
    float eye[3];    /* metres */
    float target[3]; /* a point in the middle of the picture; not the eye */
    float up[3];     /* not along the view direction; zero: +Y */
    float fov_y;     /* vertical field of view, radians, above 0 and below pi - 0.001; zero: 0.7 */
    float near_plane; /* metres, at least 1e-30; zero: 1e-3 of the distance from eye to target */
    float far_plane;  /* metres, > near, at most 1e30; zero: 1e3 times that distance */
} lb_camera_desc;

#define LB_CAMERA_DESC_INIT { sizeof(lb_camera_desc), {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 0, 0, 0 }

/* An empty scene. It needs a camera before it can be rendered; it may have no mesh and no light, where it is black. Environment, camera and
 * transforms may change between renders of one frame, as in an animation; instances stay, with their mesh and material. */
LB_API lb_result lb_scene_create(lb_context context, lb_scene* scene);
LB_API lb_result lb_scene_set_environment(lb_scene scene, lb_environment environment);
/* Other lights, at most 1024, each once. The light from all of them and from the environment adds up.
 * LB_ERROR_INVALID_ARGUMENT: the light is in the scene already, belongs to another context, or (of remove) is not
 * in the scene. */
LB_API lb_result lb_scene_add_light(lb_scene scene, lb_light light);
LB_API lb_result lb_scene_remove_light(lb_scene scene, lb_light light);

LB_API lb_result lb_scene_set_camera(lb_scene scene, const lb_camera_desc* camera);

/* Adds a mesh with its material. transform: 12 floats, three rows of an affine 3x4 matrix (object to world),
 * NULL: identity; it must be finite and invertible. index (may be NULL) receives the instance's number, counted
 * from 0; the buffer "material" holds it plus one. At most 254 instances. */
LB_API lb_result lb_scene_add(lb_scene scene, lb_mesh mesh, lb_brdf brdf, const float* transform, uint32_t* index);

/* Replaces an instance's transform; NULL: identity. */
LB_API lb_result lb_scene_set_transform(lb_scene scene, uint32_t index, const float* transform);

/* double_sided: not 0 (an instance's state when it is added): both sides of its triangles are drawn. 0: only the front, from which their
 * vertices run counter-clockwise in the mesh's own space; a mirroring transform does not change which side that is. Of a closed surface
 * that is wound outwards, seen from outside and not cut by the near plane nobody sees the back: the picture stays as it is, but for
 * pixels whose centre lies on an edge of the silhouette, and is drawn sooner.
 * LB_ERROR_INVALID_ARGUMENT: the scene has no instance of that index. */
LB_API lb_result lb_scene_set_double_sided(lb_scene scene, uint32_t index, int32_t double_sided);

/* ---- Frame -------------------------------------------------------------------------------------- */

/* A picture of width x height pixels, each 1 .. 8192, with the default settings. A frame is asked for one of three things:
 *   "target_error"  a relative error (docs/conventions.md). It is shaded in rounds until its own estimate is below; a frame that
 *                   cannot get there (max_samples, 8 rounds; with the sampler "combined" also the directions that one frame
 *                   draws of the map, which leave about 0.2 %) says what it reached in lb_frame_stats.error
 *   "time_budget"   milliseconds. It becomes as good as they let; how fast the device is, the frame learns from its own
 *                   renders, so that the first (which also builds programs) may miss. No frame is quicker than its geometry, its
 *                   prediction and some samples of a few pixels: lb_frame_stats.milliseconds says what it took. With
 *                   target_error: whichever comes first, as far as is known before the first round
 *   "samples"       a number of light samples per shaded pixel
 * With a time budget two renders differ; otherwise equal seeds give equal frames. */
LB_API lb_result lb_frame_create(lb_context context, uint32_t width, uint32_t height, lb_frame* frame);

/* Settings by name. The table of names, types, ranges, defaults and meanings: lb_setting_at.
 * LB_ERROR_INVALID_ARGUMENT: unknown name, wrong type, out of range, unknown choice; nothing is changed then. */
LB_API lb_result lb_frame_set_number(lb_frame frame, const char* name, double value);
LB_API lb_result lb_frame_set_choice(lb_frame frame, const char* name, const char* value);
LB_API lb_result lb_frame_get_number(lb_frame frame, const char* name, double* value);
LB_API lb_result lb_frame_get_choice(lb_frame frame, const char* name, const char** value);

#define LB_SETTING_INTEGER 0 /* lb_frame_set_number; a value with a fraction is an error */
#define LB_SETTING_REAL 1    /* lb_frame_set_number */
#define LB_SETTING_CHOICE 2  /* lb_frame_set_choice */

typedef struct lb_setting_info {
    uint32_t struct_size;
    uint32_t type;              /* LB_SETTING_* */
    const char* name;
    double minimum, maximum;    /* numbers */
    double default_number;
    const char* default_choice; /* choices */
    const char* choices;        /* "one|other" */
    const char* documentation;
} lb_setting_info;

#define LB_SETTING_INFO_INIT { sizeof(lb_setting_info), 0, NULL, 0, 0, 0, NULL, NULL, NULL }

LB_API uint32_t lb_setting_count(void);
LB_API lb_result lb_setting_at(uint32_t index, lb_setting_info* info);

/* Called between parts of a frame with the fraction of the call's time that has passed: from 0 to 1, never falling; an estimate
 * where the number of rounds is not known beforehand. Non-zero: stop; the render call returns
 * LB_ERROR_CANCELLED and the frame holds what it held before. */
typedef int32_t (*lb_progress_callback)(void* user, double fraction);

/* Renders. On any failure the frame keeps its former result.
 * LB_ERROR_INVALID_STATE: the scene has no camera, or "accumulate" is above 1 where an error or a time is asked
 * for, or a callback called; LB_ERROR_INVALID_ARGUMENT: the scene is of another context; LB_ERROR_CANCELLED; LB_ERROR_LIMIT. */
LB_API lb_result lb_frame_render(lb_frame frame, lb_scene scene, lb_progress_callback progress, void* user);

typedef struct lb_frame_stats {
    uint32_t struct_size;
    uint32_t width, height;
    uint32_t frames;             /* frames averaged: the setting "accumulate" */
    uint64_t covered_pixels;     /* pixels that see a mesh */
    uint64_t shaded_pixels;      /* those whose integral was computed; the others were interpolated */
    uint64_t samples;            /* light samples that the picture is made of, counted by the shaders themselves, all frames;
                                    those of pixels that were sampled again, of pilot and control samples are not among them */
    uint64_t saturated_pixels;   /* covered pixels whose predicted bandwidth reached 0.5 cycles per pixel */
    uint64_t bent_normals;       /* covered pixels whose shading normal faced away and was turned to the eye */
    uint64_t device_bytes;       /* device memory held by the scene and this frame */
    double milliseconds;         /* whole render call */
    double bandwidth_milliseconds; /* of it: the prediction of bandwidth and variance (0 in a frame of method "reference") */
    double shading_milliseconds;   /* of it: the shading integral */
    double error;                  /* relative error of the frame, as the frame itself estimates it (docs/conventions.md):
                                      root of the squares of the three parts: noise,
                                      interpolation and bias. The field "error" holds it pixel by pixel */
    double noise_error;            /* part of it that more samples would reduce */
    double interpolation_error;    /* part of it that finer levels would reduce */
    uint64_t capped_pixels;        /* pixels whose samples reached the setting "max_samples"; their error may be larger than the others' */
    uint32_t rounds;               /* of shading: 1 where neither an error nor a time was asked for */
    uint32_t control_pixels;       /* pixels that were also shaded with more samples, to know how far the others err; 0 where
                                      the setting "sampler" has no bias or a "time_budget" leaves no time for them */
    double bias_error;             /* part of error that control samples see beyond the other two: the bias of a sampler, which is
                                      the same at every seed, and errors that replicates and validation pixels do not show;
                                      more samples reduce it */
    uint32_t sampler_replaced;     /* 1: the sampler "cut" did not agree with samples without bias, as under tables with black
                                      parts; the picture was shaded by "combined" or "brdf" instead. lb_frame_explain says by which. Else 0 */
} lb_frame_stats;

#define LB_FRAME_STATS_INIT \
    { sizeof(lb_frame_stats), 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0, 0, 0, 0.0, 0 }

/* LB_ERROR_INVALID_STATE before the first successful render. */
LB_API lb_result lb_frame_info(lb_frame frame, lb_frame_stats* stats);

/* The plan of a frame, as text: what lb_frame_render would do for this scene, one line for each pass with the device memory that
 * it fills, its reason, the settings that choose its programs, and the buffers that it reads and writes. A pass that the frame does
 * not need is not in it. Nothing runs and nothing is allocated on the device. Passes "control", "pilot", "recheck", "replace",
 * "pyramids", "upsample" and "combine" may turn out not to pay while the frame runs; lb_frame_explain tells which passes ran.
 * Writes at most size bytes including the final 0 and stores the size needed in *needed (may be NULL). text may be NULL when size
 * is 0. Errors: those of lb_frame_render that do not depend on the device. */
LB_API lb_result lb_frame_plan(lb_frame frame, lb_scene scene, char* text, size_t size, size_t* needed);

/* What the last frame did, as text: one line for each pass that ran, with bytes, invocations, reason and what was found out; where
 * the setting "pass_times" is "on", with its milliseconds as well. Text, size and needed are those of lb_frame_plan. */
LB_API lb_result lb_frame_explain(lb_frame frame, char* text, size_t size, size_t* needed);

/* ---- Buffers ------------------------------------------------------------------------------------ */

#define LB_TYPE_FLOAT32 0
#define LB_TYPE_UINT32 1
#define LB_TYPE_UINT8 2

typedef struct lb_buffer_view {
    uint32_t struct_size;
    uint32_t type;        /* LB_TYPE_* */
    const void* data;     /* first element; valid until the buffer is released */
    uint32_t dimensions;  /* 2 .. 4 */
    uint64_t shape[4];    /* elements along each dimension, rows first */
    int64_t strides[4];   /* bytes from one element to the next along each dimension */
    const char* unit;     /* "radiance", "1/pixel", ...; "" of a pure number; cycles are not written. Static storage */
} lb_buffer_view;

#define LB_BUFFER_VIEW_INIT { sizeof(lb_buffer_view), 0, NULL, 0, {0, 0, 0, 0}, {0, 0, 0, 0}, NULL }

/* One field of the last frame, read back once into memory that the buffer owns: it stays as it is when the frame
 * renders again or is released. Names: lb_frame_buffer_name. Pixels that see no mesh hold 0 unless said otherwise.
 *
 *   color               float32 [H][W][4]  radiance RGB and coverage (0 or 1)
 *   depth               float32 [H][W]     metres from the eye's plane; infinity where nothing is seen
 *   position            float32 [H][W][3]  metres, world
 *   normal              float32 [H][W][3]  unit, world, towards the eye
 *   curvature           float32 [H][W]     1/metre: largest principal curvature in magnitude
 *   material            uint8   [H][W]     0: nothing seen; else instance number + 1
 *   bandwidth_spatial   float32 [H][W]     cycles/metre, at the surface (first component of eq. 5)
 *   bandwidth_angular   float32 [H][W]     cycles/radian, at the eye (second component of eq. 5)
 *   bandwidth_image     float32 [H][W]     cycles/pixel, at most 0.5 (eq. 6)
 *   level               uint8   [H][W]     log2 of the spacing at which the pixel may be shaded (eq. 11, Nyquist)
 *   shaded              uint8   [H][W]     1: the integral was computed here, and what is shown may be a mean of it and of what is
 *                                          interpolated here, each weighted by its error; 0: interpolated or nothing seen
 *   sample_count        uint32  [H][W]     light samples drawn here, by one of the frames that are accumulated
 *   error               float32 [H][W]     error of the luminance L that is expected here, over L + 0.01 of the frame's mean L;
 *                                          its root mean square over the covered pixels is lb_frame_stats.error
 *   variance_predicted  float32 [H][W]     radiance^2: predicted variance of one light sample's luminance, by the setting
 *                                          "variance" (eq. 9 where that is "printed")
 *   variance_measured   float32 [H][W]     radiance^2: the same, from the samples drawn here; 0 where fewer than two
 *   level_pyramid       uint8   [R][W]     the levels' min pyramid: level 0 in rows 0 .. H-1, level 1 (of half
 *                                          size, rounded up) below it, and so on; 255 where nothing is seen
 *   variance_pyramid    float32 [R][W]     the relative variances' max pyramid, laid out the same way
 *
 * A frame of method "reference" has no curvature, bandwidth, level, predicted or pyramid field:
 * LB_ERROR_INVALID_STATE. Levels and pyramids of one that did not interpolate are those of bandwidth_scale 1. */
LB_API lb_result lb_frame_map(lb_frame frame, const char* name, lb_buffer* buffer, lb_buffer_view* view);
LB_API uint32_t lb_frame_buffer_count(void);
LB_API const char* lb_frame_buffer_name(uint32_t index);

/* Fields of a map:
 *   radiance   float32 [H][W][3]  as loaded
 *   bandwidth  float32 [S][S]     cycles/radian on the octahedral square (docs/conventions.md); it ends at what its texels, or the
 *                                 map's, can show. S: a power of two, at most 512 */
LB_API lb_result lb_environment_map(lb_environment environment, const char* name, lb_buffer* buffer,
                                    lb_buffer_view* view);

/* Fields of a material:
 *   table      float32 [90][90][180][3]  1/steradian (tabulated materials alone; else LB_ERROR_INVALID_STATE)
 *   bandwidth  float32 [32][64][64]      cycles/radian of the lobe, 1e9 where unbounded: views in steps of
 *                                        cos(theta_o), then the square of incident directions (docs/conventions.md) */
LB_API lb_result lb_brdf_map(lb_brdf brdf, const char* name, lb_buffer* buffer, lb_buffer_view* view);

/* How highlights are shown in eight bits. */
#define LB_TONE_NONE 0   /* radiance above 1 is shown as 1 */
#define LB_TONE_FILMIC 1 /* a curve of film that reaches 1 at no finite radiance and leaves mid-grey, 0.18, where it is: Hable 2010,
                            "Uncharted 2: HDR Lighting", with its white at infinity */

/* The alpha of a PNG. */
#define LB_ALPHA_COVERAGE 0 /* the coverage, as in the field "color", not multiplied into the colour: a cut-out. Pixels of the background
                               have alpha 0, and the colour that they show, if any */
#define LB_ALPHA_OPAQUE 1   /* 1 */

typedef struct lb_save_desc {
    uint32_t struct_size;
    uint32_t tone_curve; /* LB_TONE_*; of a PNG */
    const char* names;   /* comma-separated fields, but not the pyramids; NULL: color alone, as a PNG always */
    float exposure;      /* of a PNG: radiance is multiplied by 2^exposure, before the tone curve; finite */
    uint32_t alpha;      /* LB_ALPHA_*; of a PNG */
} lb_save_desc;

#define LB_SAVE_DESC_INIT { sizeof(lb_save_desc), LB_TONE_NONE, NULL, 0, LB_ALPHA_COVERAGE }

/* Writes a frame's fields. desc NULL: all defaults. path ends in one of two ways:
 *   ".exr"  float channels, radiance as it is: "R", "G", "B", "A" of color, "Z" of depth, "<field>.<X, Y, Z>" of other fields of three
 *           components, "<field>.Y" of the rest. The header holds the chromaticities of Rec. 709, pixel aspect ratio 1, the settings
 *           of the render as "lightband.<setting>" and its statistics as "lightband.stats.<field of lb_frame_stats>"
 *   ".png"  color alone, as sRGB
 * Written to a temporary file beside path, then renamed: on any failure, what path was before it still is. A file that is replaced
 * keeps its mode; of a symbolic link, the file that it leads to is replaced.
 * LB_ERROR_FILE: cannot be written, or path is not a regular file; LB_ERROR_OUT_OF_MEMORY; LB_ERROR_INVALID_ARGUMENT. */
LB_API lb_result lb_frame_save(lb_frame frame, const char* path, const lb_save_desc* desc);

#ifdef __cplusplus
}
#endif

#endif
