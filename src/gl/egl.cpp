#include "gl/egl.h"

#define EGL_NO_PLATFORM_SPECIFIC_TYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>

#include <cstdio>
#include <cstring>
#include <vector>

#include "base/error.h"

namespace lightband::gl {

struct EglApi {
    decltype(&eglGetProcAddress) GetProcAddress = nullptr;
    decltype(&eglInitialize) Initialize = nullptr;
    decltype(&eglBindAPI) BindAPI = nullptr;
    decltype(&eglQueryString) QueryString = nullptr;
    decltype(&eglCreateContext) CreateContext = nullptr;
    decltype(&eglDestroyContext) DestroyContext = nullptr;
    decltype(&eglMakeCurrent) MakeCurrent = nullptr;
    decltype(&eglReleaseThread) ReleaseThread = nullptr;
    decltype(&eglGetError) GetError = nullptr;
    PFNEGLGETPLATFORMDISPLAYEXTPROC GetPlatformDisplay = nullptr;
    PFNEGLQUERYDEVICESEXTPROC QueryDevices = nullptr;  // may be missing
};

namespace {

// The library stays loaded until the process ends: drivers do not survive being unloaded.
const EglApi& load_egl() {
    static const EglApi api = [] {
        void* library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
        if (library == nullptr) throw Error(LB_ERROR_DEVICE, text("libEGL.so.1 cannot be loaded: ", dlerror()));
        EglApi egl;
        const auto load = [&](auto& function, const char* name) {
            function = reinterpret_cast<std::decay_t<decltype(function)>>(dlsym(library, name));
            if (function == nullptr) throw Error(LB_ERROR_DEVICE, text("libEGL.so.1 has no ", name));
        };
        load(egl.GetProcAddress, "eglGetProcAddress");
        load(egl.Initialize, "eglInitialize");
        load(egl.BindAPI, "eglBindAPI");
        load(egl.QueryString, "eglQueryString");
        load(egl.CreateContext, "eglCreateContext");
        load(egl.DestroyContext, "eglDestroyContext");
        load(egl.MakeCurrent, "eglMakeCurrent");
        load(egl.ReleaseThread, "eglReleaseThread");
        load(egl.GetError, "eglGetError");
        egl.GetPlatformDisplay = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
            egl.GetProcAddress("eglGetPlatformDisplayEXT"));
        if (egl.GetPlatformDisplay == nullptr)
            throw Error(LB_ERROR_DEVICE, "libEGL.so.1 has no eglGetPlatformDisplayEXT");
        egl.QueryDevices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl.GetProcAddress("eglQueryDevicesEXT"));
        return egl;
    }();
    return api;
}

struct Candidate {
    std::string name;
    EGLDisplay display;
};

std::vector<Candidate> candidates(const EglApi& egl, std::string* attempts) {
    std::vector<Candidate> result;
    EGLDeviceEXT devices[32];
    EGLint count = 0;
    if (egl.QueryDevices != nullptr && egl.QueryDevices(32, devices, &count)) {
        for (EGLint i = 0; i < count; ++i)
            result.push_back({text("EGL device ", i),
                              egl.GetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr)});
    } else {
        *attempts += "\n  EGL device platform: devices cannot be listed";
    }
    result.push_back({"EGL surfaceless platform",
                      egl.GetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)});
    return result;
}

bool is_software(const std::string& renderer) {
    for (const char* name : {"llvmpipe", "softpipe", "swrast", "SWR"})
        if (renderer.find(name) != std::string::npos) return true;
    return false;
}

std::string describe(EGLint error) {
    char digits[2 * sizeof error];
    return "EGL error 0x" + std::string(digits, std::to_chars(digits, digits + sizeof digits, uint32_t(error), 16).ptr);
}

void* create_context(const EglApi& api, void* display) {
    if (display == EGL_NO_DISPLAY) throw Error(LB_ERROR_DEVICE, "no display");
    EGLint major = 0, minor = 0;
    if (!api.Initialize(display, &major, &minor)) throw Error(LB_ERROR_DEVICE, describe(api.GetError()));
    const char* extensions = api.QueryString(display, EGL_EXTENSIONS);
    for (const char* needed : {"EGL_KHR_surfaceless_context", "EGL_KHR_create_context"})
        if (extensions == nullptr || std::strstr(extensions, needed) == nullptr)
            throw Error(LB_ERROR_DEVICE, text("no ", needed));
    if (!api.BindAPI(EGL_OPENGL_API)) throw Error(LB_ERROR_DEVICE, "no OpenGL");
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    const EGLContext context = api.CreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (context == EGL_NO_CONTEXT)
        throw Error(LB_ERROR_DEVICE, text("no OpenGL 4.5 core context (", describe(api.GetError()), ")"));
    return context;
}

}  // namespace

// The first is done once it holds the context: what the second throws ends in the destructor.
EglContext::EglContext(const EglApi& api, void* display, void* context) : api_(api), display_(display), context_(context) {}
EglContext::EglContext(const EglApi& api, void* display) : EglContext(api, display, create_context(api, display)) {
    make_current();
    load_functions();
}

void EglContext::make_current() {
    if (!api_.MakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
        throw Error(LB_ERROR_DEVICE, text("the context cannot be made current: ", describe(api_.GetError())));
}

void EglContext::load_functions() {
    const char* missing = nullptr;
#define LIGHTBAND_GL_LOAD(type, function)                                                        \
    functions_.function = reinterpret_cast<type>(api_.GetProcAddress("gl" #function));           \
    if (functions_.function == nullptr) missing = "gl" #function;
    LIGHTBAND_GL_FUNCTIONS(LIGHTBAND_GL_LOAD)
#undef LIGHTBAND_GL_LOAD
    if (missing != nullptr) throw Error(LB_ERROR_DEVICE, text("the driver has no ", missing));
    const auto string = [&](GLenum name) {
        const GLubyte* value = functions_.GetString(name);
        return value != nullptr ? std::string(reinterpret_cast<const char*>(value)) : std::string("unknown");
    };
    name_ = string(GL_RENDERER) + ", OpenGL " + string(GL_VERSION);
    software_ = is_software(name_);
}

// A context is destroyed when it is no longer current: the thread lets go of it first, which it can even where the host has terminated
// the display. There EGL has forgotten the context's name already, and only that.
EglContext::~EglContext() {
    api_.ReleaseThread();
    api_.DestroyContext(display_, context_);
}

std::unique_ptr<EglContext> EglContext::create(uint32_t device) {
    const EglApi& egl = load_egl();
    std::string attempts;
    std::unique_ptr<EglContext> software;
    const auto choose = [&](std::unique_ptr<EglContext> context) {
        software.reset();
        context->make_current();  // another that was tried may have been since
        return context;
    };
    for (const Candidate& candidate : candidates(egl, &attempts)) {
        try {
            std::unique_ptr<EglContext> context(new EglContext(egl, candidate.display));
            if (context->software() ? device == LB_DEVICE_SOFTWARE : device != LB_DEVICE_SOFTWARE) return choose(std::move(context));
            attempts += text("\n  ", candidate.name, ": ", context->name(),
                             context->software() ? " is a software renderer" : " is hardware");
            if (device == LB_DEVICE_ANY && software == nullptr) software = std::move(context);
        } catch (const Error& error) {
            attempts += text("\n  ", candidate.name, ": ", error.what());
        }
    }
    if (software != nullptr) return choose(std::move(software));
    throw Error(LB_ERROR_DEVICE,
                text("no ", device == LB_DEVICE_HARDWARE ? "hardware " : device == LB_DEVICE_SOFTWARE ? "software " : "",
                     "OpenGL 4.5 device; tried:", attempts,
                     device == LB_DEVICE_HARDWARE ? "\nSoftware rendering is chosen by LB_DEVICE_SOFTWARE or LB_DEVICE_ANY (in Python: "
                                                    "device=\"software\" or \"any\")."
                                                  : ""));
}

}  // namespace lightband::gl
