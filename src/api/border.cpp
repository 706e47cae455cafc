#include "api/border.h"

#include <new>

#include "base/process.h"

namespace lightband::api {
namespace {

// The last failure's text on this thread. A fixed array: recording that memory ran out takes no memory.
thread_local char last_message[4096] = "";

}  // namespace

// The tables are never destroyed: handles may be released by destructors that run at exit.
HandleTable<Context>& contexts() {
    static auto& table = *new HandleTable<Context>("context", 1);
    return table;
}
HandleTable<const Material>& materials() {
    static auto& table = *new HandleTable<const Material>("brdf", 2);
    return table;
}
HandleTable<const EnvironmentLight>& environments() {
    static auto& table = *new HandleTable<const EnvironmentLight>("environment", 3);
    return table;
}
HandleTable<Light>& lights() {
    static auto& table = *new HandleTable<Light>("light", 8);
    return table;
}
HandleTable<const Mesh>& meshes() {
    static auto& table = *new HandleTable<const Mesh>("mesh", 4);
    return table;
}
HandleTable<Scene>& scenes() {
    static auto& table = *new HandleTable<Scene>("scene", 5);
    return table;
}
HandleTable<Frame>& frames() {
    static auto& table = *new HandleTable<Frame>("frame", 6);
    return table;
}
HandleTable<const HostArray>& arrays() {
    static auto& table = *new HandleTable<const HostArray>("buffer", 7);
    return table;
}

// A message that is too long loses its middle: it begins with the name of a file or an argument, which alone may be as
// long as the caller likes, and ends in the reason.
lb_result fail(lb_result code, const char* message) noexcept {
    constexpr char gap[] = " ... ";
    constexpr size_t gap_length = sizeof gap - 1, longest = sizeof last_message - 1, part = (longest - gap_length) / 2;
    const size_t length = std::strlen(message);
    if (length <= longest) {
        std::memcpy(last_message, message, length + 1);
        return code;
    }
    // Neither cut lies within a character of UTF-8, whose later bytes begin with the bits 10.
    const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; };
    size_t head = part, tail = length - part;
    while (head > 0 && continues(message[head])) --head;
    while (tail < length && continues(message[tail])) ++tail;
    std::memcpy(last_message, message, head);
    std::memcpy(last_message + head, gap, gap_length);
    std::memcpy(last_message + head + gap_length, message + tail, length - tail + 1);
    return code;
}

const char* refusal() {
    if (HostThread::in_callback())
        return "a progress or log callback must not call the library: do the work after the call that it interrupts "
               "has returned";
    if (process_was_forked())
        return "this process was forked from one that had made a context, and contexts do not outlive a fork: make "
               "them after fork, or "
               "start processes anew (exec; in Python: multiprocessing's start methods \"spawn\" and \"forkserver\")";
    if (process_ends()) return "the process ends: exit was called, and the driver's own exit handlers run";
    return nullptr;
}

lb_result translate_exception() noexcept {
    try {
        throw;
    } catch (const Error& error) {
        return fail(error.code(), error.what());
    } catch (const std::bad_alloc&) {
        return fail(LB_ERROR_OUT_OF_MEMORY, "out of memory");
    } catch (const std::exception& error) {
        return fail(LB_ERROR_INTERNAL, error.what());
    } catch (...) {
        return fail(LB_ERROR_INTERNAL, "unknown exception");
    }
}

void give_array(HostArray array, lb_buffer* buffer, lb_buffer_view* view) {
    require(buffer, "buffer");
    lb_buffer_view described = read_struct(view, "view");
    const auto shared = std::make_shared<const HostArray>(std::move(array));
    described.type = shared->type;
    described.data = shared->elements.get();
    described.dimensions = uint32_t(shared->shape.size());
    int64_t stride = HostArray::element_size(shared->type);
    for (size_t i = 4; i-- > 0;) {
        const bool used = i < shared->shape.size();
        described.shape[i] = used ? shared->shape[i] : 0;
        described.strides[i] = used ? stride : 0;
        if (used) stride *= int64_t(shared->shape[i]);
    }
    described.unit = shared->unit;
    give(arrays(), shared, buffer);
    write_struct(view, described, "view");
}

}  // namespace lightband::api

extern "C" {

uint32_t lb_version(void) {
    return 10000 * LB_VERSION_MAJOR + 100 * LB_VERSION_MINOR + LB_VERSION_PATCH;
}

const char* lb_result_name(lb_result result) {
    switch (result) {
        case LB_OK:
            return "LB_OK";
        case LB_ERROR_INVALID_ARGUMENT:
            return "LB_ERROR_INVALID_ARGUMENT";
        case LB_ERROR_INVALID_HANDLE:
            return "LB_ERROR_INVALID_HANDLE";
        case LB_ERROR_INVALID_STATE:
            return "LB_ERROR_INVALID_STATE";
        case LB_ERROR_FILE:
            return "LB_ERROR_FILE";
        case LB_ERROR_FORMAT:
            return "LB_ERROR_FORMAT";
        case LB_ERROR_OUT_OF_MEMORY:
            return "LB_ERROR_OUT_OF_MEMORY";
        case LB_ERROR_DEVICE:
            return "LB_ERROR_DEVICE";
        case LB_ERROR_LIMIT:
            return "LB_ERROR_LIMIT";
        case LB_ERROR_CANCELLED:
            return "LB_ERROR_CANCELLED";
        case LB_ERROR_INTERNAL:
            return "LB_ERROR_INTERNAL";
        default:
            return "unknown";
    }
}

const char* lb_error_message(void) {
    return lightband::api::last_message;
}

}  // extern "C"
