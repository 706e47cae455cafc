// What becomes of the library when its process forks or ends.
#pragma once

namespace lightband {

// The process makes its first context: from now on its forks cannot use the library, since threads are not inherited, neither the
// contexts' nor those of the OpenGL driver.
void claim_process();

// Whether this process is a fork of one that had made a context. Takes no lock: any may have been held by a thread that the child
// does not have.
bool process_was_forked();

// The process ends: the exit handlers of the OpenGL driver, which take apart what contexts use, come next. No call is taken from now on.
void begin_process_end();
bool process_ends();

}  // namespace lightband
