// Memory that runs out on purpose: a program with failing_memory.cpp counts the allocations of the library, of the libraries that read
// and write its files, and of the program itself, which lightband.hpp is part of, and makes a chosen one fail.
//
// The program's own operator new and malloc take the place of everybody's. An allocation is the library's where the code that asks for
// it, beneath the C++ runtime, is the library's: drivers end the process when their memory fails, and are left alone. All threads are
// counted together, as the library may work on threads of its own.
#pragma once

#include <cstdint>
#include <vector>

namespace failing_memory {

// Finds out where the code of the library lies. Once, before everything else.
void begin();

// What fails after so many allocations have been granted: the next one alone, or all.
enum class Failing { one, all };
void fail_after(int64_t granted, Failing failing);
// Nothing fails any more. Whether an allocation has failed since fail_after.
bool stop_failing();

// Allocations since begin().
int64_t count();

// How many allocations have been made since allocation `first`, and which of them, counted from there, are the first and the last of
// those that one place in the code asks for: calls make hundreds of thousands of allocations in a few hundred places.
struct Course {
    int64_t count;
    std::vector<int64_t> of_places;  // ascending
};
Course course_since(int64_t first);

// Blocks that are held. OpenEXR 3.1 loses memory when an allocation of its own fails; that is told apart.
struct Blocks {
    int64_t library = 0, openexr = 0;
};
Blocks held();

// Writes to the standard error where each block of the library was allocated that is held, if its number is at least `first`
// (count() before what is looked at).
void print_held(int64_t first);

}  // namespace failing_memory
