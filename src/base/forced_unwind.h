// What unwinds the stack of a thread that pthread_exit or pthread_cancel ends.
#pragma once

#include <cxxabi.h>

#include <exception>

namespace lightband {

// A handler that catches this must rethrow it: the C library aborts a process in which it was swallowed. Every catch (...) that a
// callback of the host may lead to is therefore preceded by one that lets it pass.
#if defined(__GLIBCXX__)
using ForcedUnwind = abi::__forced_unwind;
#else
class ForcedUnwind {};
#endif

}  // namespace lightband
