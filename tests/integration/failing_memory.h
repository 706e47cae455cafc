// Memory that runs out on purpose: a program with failing_memory.cpp counts the allocations of the library, of the
// libraries that read and write its files, and of the program itself, into which lightband.hpp is compiled, and makes
// chosen ones fail.
//
// The program defines operator new and malloc, and every library of the process then calls these. An allocation counts
// as the library's where the code that asks for it, below the C++ runtime, lies in the library. Drivers are left alone:
// they end the process when their memory fails. Allocations of all threads are counted together, as the library may
// work on threads of its own.
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

// From now on OpenEXR gets its blocks of 8 x 8 texels of DWAA and DWAB, and they are not counted: version 3.1 does not
// look whether posix_memalign gave them, and writes to the null pointer.
void spare_dwa_blocks();

// Allocations since begin().
int64_t count();

// How many allocations have been made since allocation `first`, and which of them, counted from there, are the first or
// the last that one place in the code asks for: a call may make thousands of allocations in a few hundred places.
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

// Writes to the standard error which code has allocated the library's blocks that are held, of those whose number is at
// least `first`, a former count().
void print_held(int64_t first);

}  // namespace failing_memory
