// Handles: what crosses the border instead of pointers. A handle names a place in a table and the generation of what lies
// there, so that one that was released is recognised for ever.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "base/error.h"

namespace lightband::api {

// One table for each kind of object; all calls are safe from any thread.
template <class Object>
class HandleTable {
public:
    explicit HandleTable(const char* kind, uint32_t tag) : kind_(kind), tag_(tag) {}

    uintptr_t insert(std::shared_ptr<Object> object) {
        const std::lock_guard<std::mutex> lock(mutex_);
        size_t place = 0;
        while (place < entries_.size() && entries_[place].object != nullptr) ++place;
        if (place == entries_.size()) entries_.emplace_back();
        Entry& entry = entries_[place];
        entry.object = std::move(object);
        entry.references = 1;
        return handle(place, entry.generation);
    }

    std::shared_ptr<Object> get(const void* value, const char* argument) {
        const std::lock_guard<std::mutex> lock(mutex_);
        return find(value, argument).object;
    }

    void retain(const void* value) {
        const std::lock_guard<std::mutex> lock(mutex_);
        ++find(value, kind_).references;
    }

    // The object, where this was its last reference: the caller lets go of it outside the table's lock.
    std::shared_ptr<Object> release(const void* value) {
        const std::lock_guard<std::mutex> lock(mutex_);
        Entry& entry = find(value, kind_);
        if (--entry.references > 0) return nullptr;
        ++entry.generation;
        return std::move(entry.object);
    }

private:
    struct Entry {
        std::shared_ptr<Object> object;
        uint32_t references = 0;
        uint32_t generation = 1;
    };

    // 24 bits of place, 4 of kind, the rest generation.
    static constexpr unsigned place_bits = 24, tag_bits = 4;
    uintptr_t handle(size_t place, uint32_t generation) const {
        return uintptr_t(generation) << (place_bits + tag_bits) | uintptr_t(tag_) << place_bits | place;
    }

    Entry& find(const void* value, const char* argument) {
        if (value == nullptr) throw Error(LB_ERROR_INVALID_HANDLE, text(argument, " is NULL"));
        const auto bits = reinterpret_cast<uintptr_t>(value);
        const size_t place = bits & ((uintptr_t(1) << place_bits) - 1);
        if ((bits >> place_bits & 15) != tag_) throw Error(LB_ERROR_INVALID_HANDLE, text(argument, " is not a handle of a ", kind_));
        if (place >= entries_.size() || entries_[place].object == nullptr || handle(place, entries_[place].generation) != bits)
            throw Error(LB_ERROR_INVALID_HANDLE, text(argument, " was released, or never was a handle of a ", kind_));
        return entries_[place];
    }

    const char* const kind_;
    const uint32_t tag_;
    std::mutex mutex_;
    std::vector<Entry> entries_;
};

}  // namespace lightband::api
