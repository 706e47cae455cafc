// What every file of the border uses: the tables of objects, exceptions to result codes, checks of arguments.
#pragma once

#include <cmath>
#include <cstring>
#include <string>

#include "api/handles.h"
#include "assets/scene.h"
#include "base/forced_unwind.h"
#include "base/host_thread.h"
#include "frame/frame.h"
#include "frame/host_array.h"
#include "gl/device.h"
#include "lights/environment.h"

namespace lightband::api {

struct Context {
    gl::DevicePtr device;
    std::string cache_path;
};

HandleTable<Context>& contexts();
HandleTable<const Material>& materials();
HandleTable<const EnvironmentLight>& environments();
HandleTable<Light>& lights();
HandleTable<const Mesh>& meshes();
HandleTable<Scene>& scenes();
HandleTable<Frame>& frames();
HandleTable<const HostArray>& arrays();

lb_result fail(lb_result code, const char* message) noexcept;
lb_result translate_exception() noexcept;  // of the exception that is being handled

// Why no call is taken on this thread now (LB_ERROR_INVALID_STATE): a callback runs, or the process was forked or ends.
// NULL: calls are taken.
const char* refusal();

// Runs the body of a call; nothing leaves it but a result, or the end of a thread that a callback ends.
template <class Body>
lb_result border(Body body) {
    if (const char* reason = refusal()) return fail(LB_ERROR_INVALID_STATE, reason);
    const HostThread inside;
    try {
        body();
        return LB_OK;
    } catch (ForcedUnwind&) {
        throw;
    } catch (...) {
        return translate_exception();
    }
}

inline void require(const void* argument, const char* name) {
    if (argument == nullptr) throw Error(LB_ERROR_INVALID_ARGUMENT, text(name, " is NULL"));
}

// Objects hold OpenGL's: whoever lets go of one last, it ends on the thread of its context. The device outlives it, so
// that its thread is never left to end itself.
template <class Object, class... Arguments>
std::shared_ptr<Object> make(Arguments&&... arguments) {
    return {new Object(std::forward<Arguments>(arguments)...), [](Object* object) {
                const gl::DevicePtr device = object->device();
                device->destroy([&] { delete object; });
            }};
}

template <class Handle, class Object>
void give(HandleTable<Object>& table, std::shared_ptr<Object> object, Handle* out) {
    *out = reinterpret_cast<Handle>(table.insert(std::move(object)));
}

// A descriptor as the caller's version of it knew it: the unknown tail of a longer one must be zero. No struct has
// grown yet, so that a shorter one is an error; whoever appends a field lets those of the size before be completed with
// zeros.
template <class Struct>
Struct read_struct(const Struct* given, const char* name) {
    require(given, name);
    uint32_t size;
    std::memcpy(&size, given, sizeof size);
    if (size < sizeof(Struct))
        throw Error(LB_ERROR_INVALID_ARGUMENT, text(name, ": struct_size is ", size, "; it must be at least ",
                                                    sizeof(Struct), " (see its INIT macro)"));
    const auto* bytes = reinterpret_cast<const unsigned char*>(given);
    // A size beyond any later version is an uninitialised struct, whose tail must not be read.
    constexpr uint32_t largest = 4096;
    if (size > largest)
        throw Error(LB_ERROR_INVALID_ARGUMENT, text(name, ": struct_size is ", size, "; it must be at most ", largest));
    for (uint32_t i = sizeof(Struct); i < size; ++i)
        if (bytes[i] != 0)
            throw Error(LB_ERROR_INVALID_ARGUMENT, text(name, ": byte ", i, " is not zero; this library knows ",
                                                        sizeof(Struct), " bytes of the struct"));
    Struct result;
    std::memcpy(&result, given, sizeof result);
    return result;
}

// The same for structs that the library fills: the caller's struct_size stays.
template <class Struct>
void write_struct(Struct* out, Struct value, const char* name) {
    value.struct_size = read_struct(out, name).struct_size;
    std::memcpy(out, &value, sizeof value);
}

// Hands an array out as a buffer with its view.
void give_array(HostArray array, lb_buffer* buffer, lb_buffer_view* view);

}  // namespace lightband::api
