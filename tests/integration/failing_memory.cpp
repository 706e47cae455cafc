#include "failing_memory.h"

#include <dlfcn.h>
#include <link.h>
#include <sched.h>
#include <unwind.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <new>
#include <set>

// The allocator of the C library beneath the names that this file takes over (glibc exports it for this).
extern "C" {
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
void __libc_free(void*);
}

namespace failing_memory {
namespace {

// ---- Whose code asks --------------------------------------------------------------------------------------------

enum class Owner : uint8_t { other, runtime, library, openexr };

struct Module {
    const char* name;  // of its file
    Owner owner;
    uintptr_t first = 0, end = 0;  // addresses
};
Module modules[] = {
    {"", Owner::library},  // the program itself, to which the loader gives no name: lightband.hpp is compiled into it
    {"liblightband.so", Owner::library},
    {"libpng16.so", Owner::library},
    {"libmeshoptimizer.so", Owner::library},
    {"libOpenEXR", Owner::openexr},
    {"libImath", Owner::openexr},
    {"libIex", Owner::openexr},
    {"libIlmThread", Owner::openexr},
    {"libz.so", Owner::openexr},
    {"libstdc++.so", Owner::runtime},
};
std::atomic<bool> begun{false};
std::atomic<bool> dwa_blocks_spared{false};

int find_module(dl_phdr_info* info, size_t, void*) {
    const char* slash = std::strrchr(info->dlpi_name, '/');
    const char* file = slash != nullptr ? slash + 1 : info->dlpi_name;
    for (Module& module : modules) {
        const bool is_program = *module.name == 0;
        if (is_program ? *file != 0 : std::strncmp(file, module.name, std::strlen(module.name)) != 0) continue;
        for (int i = 0; i < info->dlpi_phnum; ++i) {
            const ElfW(Phdr)& segment = info->dlpi_phdr[i];
            if (segment.p_type != PT_LOAD || !(segment.p_flags & PF_X)) continue;
            module.first = info->dlpi_addr + segment.p_vaddr;
            module.end = module.first + segment.p_memsz;
        }
    }
    return 0;
}

Owner owner_of(uintptr_t address) {
    for (const Module& module : modules)
        if (address >= module.first && address < module.end) return module.owner;
    return Owner::other;
}

struct Caller {
    Owner owner = Owner::other;
    uintptr_t address = 0;
};

thread_local bool unwinding = false;

// The first frame beneath the C++ runtime and this file.
_Unwind_Reason_Code visit_frame(_Unwind_Context* context, void* out) {
    Caller& caller = *static_cast<Caller*>(out);
    const uintptr_t address = _Unwind_GetIP(context);
    const Owner owner = owner_of(address);
    if (owner == Owner::runtime) {
        caller.owner = Owner::runtime;  // from here on the next frame that is not the runtime's is meant
        return _URC_NO_REASON;
    }
    if (caller.owner != Owner::runtime) return _URC_NO_REASON;  // this file's own frames
    caller = {owner, address};
    return _URC_NORMAL_STOP;
}

Caller caller_of(void* return_address) {
    if (!begun || unwinding) return {};
    Caller caller{owner_of(uintptr_t(return_address)), uintptr_t(return_address)};
    if (caller.owner != Owner::runtime) return caller;
    unwinding = true;
    caller = {};
    _Unwind_Backtrace(visit_frame, &caller);
    unwinding = false;
    if (caller.owner == Owner::runtime) caller.owner = Owner::other;
    return caller;
}

// ---- What is held -----------------------------------------------------------------------------------------------

struct Block {
    void* address;  // nullptr: free
    int64_t number;
    size_t bytes;
    Caller caller;
};
constexpr size_t most_blocks = 1u << 18;  // a power of two, many times what a small picture needs
Block blocks[most_blocks];
std::atomic_flag blocks_locked = ATOMIC_FLAG_INIT;
std::atomic<int64_t> allocations{0}, held_by_library{0}, held_by_openexr{0};
constexpr int64_t never = INT64_MAX;
std::atomic<int64_t> first_failing{never}, end_of_failing{never};  // numbers of allocations

// Who asked, by the allocation's number, in a ring.
constexpr size_t remembered_callers = 1u << 21;
std::atomic<uintptr_t> callers[remembered_callers];

struct Lock {
    Lock() {
        while (blocks_locked.test_and_set(std::memory_order_acquire)) sched_yield();
    }
    ~Lock() { blocks_locked.clear(std::memory_order_release); }
};

constexpr size_t last_place = most_blocks - 1;

// Fibonacci hashing (Knuth 1973, section 6.4) of what tells addresses apart: blocks are aligned to 16 bytes.
size_t place_of(const void* address) { return (uintptr_t(address) >> 4) * 0x9e3779b97f4a7c15u >> 40 & last_place; }

std::atomic<int64_t>& counter(Owner owner) { return owner == Owner::library ? held_by_library : held_by_openexr; }

bool is_counted(const Caller& caller) { return caller.owner == Owner::library || caller.owner == Owner::openexr; }

void remember(void* address, size_t bytes, const Caller& caller, int64_t number) {
    const Lock lock;
    size_t place = place_of(address);
    for (size_t tried = 0; blocks[place].address != nullptr; place = (place + 1) & last_place)
        if (++tried == most_blocks) std::abort();
    blocks[place] = {address, number, bytes, caller};
    ++counter(caller.owner);
}

// Open addressing without tombstones: what follows in the same run of places moves up.
void forget(void* address) {
    if (address == nullptr || !begun) return;
    const Lock lock;
    size_t place = place_of(address);
    while (blocks[place].address != address) {
        if (blocks[place].address == nullptr) return;  // not the library's
        place = (place + 1) & last_place;
    }
    --counter(blocks[place].caller.owner);
    for (size_t next = (place + 1) & last_place; blocks[next].address != nullptr; next = (next + 1) & last_place) {
        const size_t home = place_of(blocks[next].address);
        if (((next - home) & last_place) < ((next - place) & last_place)) continue;
        blocks[place] = blocks[next];
        place = next;
    }
    blocks[place].address = nullptr;
}

// Allocates by `get` on behalf of the caller, unless this is the allocation that is to fail.
template <typename Get>
void* allocate(size_t bytes, void* return_address, Get get) {
    const Caller caller = caller_of(return_address);
    if (!is_counted(caller)) return get();
    const int64_t number = allocations++;
    callers[size_t(number) % remembered_callers] = caller.address;
    if (number >= first_failing && number < end_of_failing) return nullptr;
    void* const address = get();
    if (address != nullptr) remember(address, bytes, caller, number);
    return address;
}

void* allocate_aligned(size_t alignment, size_t bytes, void* return_address) {
    const auto get = [&] { return __libc_memalign(alignment, bytes); };
    constexpr size_t largest_dwa_block = 64 * sizeof(float);
    const bool is_dwa_block = bytes <= largest_dwa_block && owner_of(uintptr_t(return_address)) == Owner::openexr;
    if (is_dwa_block && dwa_blocks_spared) return get();
    return allocate(bytes, return_address, get);
}

}  // namespace

void begin() {
    dl_iterate_phdr(find_module, nullptr);
    begun = true;
}

void spare_dwa_blocks() { dwa_blocks_spared = true; }

void fail_after(int64_t granted, Failing failing) {
    end_of_failing = failing == Failing::one ? allocations + granted + 1 : never;
    first_failing = allocations + granted;
}
bool stop_failing() { return allocations > first_failing.exchange(never); }
int64_t count() { return allocations; }

Course course_since(int64_t first) {
    Course course{allocations - first, {}};
    if (course.count > int64_t(remembered_callers)) std::abort();
    std::map<uintptr_t, std::pair<int64_t, int64_t>> places;  // first and last
    for (int64_t number = 0; number < course.count; ++number) {
        const uintptr_t caller = callers[size_t(first + number) % remembered_callers];
        places.emplace(caller, std::pair(number, number)).first->second.second = number;
    }
    std::set<int64_t> numbers;
    for (const auto& [place, ends] : places) numbers.insert({ends.first, ends.second});
    course.of_places.assign(numbers.begin(), numbers.end());
    return course;
}

Blocks held() { return {held_by_library, held_by_openexr}; }

void print_held(int64_t first) {
    const Lock lock;
    for (const Block& block : blocks) {
        if (block.address == nullptr || block.caller.owner != Owner::library || block.number < first) continue;
        Dl_info info = {};
        dladdr(reinterpret_cast<void*>(block.caller.address), &info);
        std::fprintf(stderr, "  %zu bytes asked for by %s+%#zx\n", block.bytes, info.dli_fname,
                     block.caller.address - uintptr_t(info.dli_fbase));
    }
}

}  // namespace failing_memory

// ---- The allocators of the program ------------------------------------------------------------------------------

using failing_memory::allocate;
#define CALLER __builtin_return_address(0)

extern "C" {

__attribute__((visibility("default"), noinline)) void* malloc(size_t bytes) {
    return allocate(bytes, CALLER, [&] { return __libc_malloc(bytes); });
}
__attribute__((visibility("default"), noinline)) void* calloc(size_t count, size_t bytes) {
    return allocate(count * bytes, CALLER, [&] { return __libc_calloc(count, bytes); });
}
__attribute__((visibility("default"), noinline)) void* memalign(size_t alignment, size_t bytes) {
    return allocate(bytes, CALLER, [&] { return __libc_memalign(alignment, bytes); });
}
__attribute__((visibility("default"), noinline)) void* aligned_alloc(size_t alignment, size_t bytes) {
    return allocate(bytes, CALLER, [&] { return __libc_memalign(alignment, bytes); });
}
__attribute__((visibility("default"), noinline)) int posix_memalign(void** out, size_t alignment, size_t bytes) {
    void* const address = failing_memory::allocate_aligned(alignment, bytes, CALLER);
    if (address == nullptr) return ENOMEM;
    *out = address;
    return 0;
}
__attribute__((visibility("default"), noinline)) void free(void* address) {
    failing_memory::forget(address);
    __libc_free(address);
}
// Where it fails, the former block stays, and is still the library's.
__attribute__((visibility("default"), noinline)) void* realloc(void* former, size_t bytes) {
    return allocate(bytes, CALLER, [&] {
        failing_memory::forget(former);
        return __libc_realloc(former, bytes);
    });
}

}  // extern "C"

namespace {

void* allocate_or_throw(size_t bytes, size_t alignment, void* caller) {
    void* const address = allocate(bytes, caller, [&] {
        return alignment == 0 ? __libc_malloc(bytes != 0 ? bytes : 1) : __libc_memalign(alignment, bytes);
    });
    if (address == nullptr) throw std::bad_alloc();
    return address;
}

}  // namespace

// The forms for arrays, the nothrow forms and the sized forms call these.
__attribute__((noinline)) void* operator new(size_t bytes) { return allocate_or_throw(bytes, 0, CALLER); }
__attribute__((noinline)) void* operator new(size_t bytes, std::align_val_t alignment) {
    return allocate_or_throw(bytes, size_t(alignment), CALLER);
}
void operator delete(void* address) noexcept { free(address); }
void operator delete(void* address, size_t) noexcept { free(address); }
void operator delete(void* address, std::align_val_t) noexcept { free(address); }
