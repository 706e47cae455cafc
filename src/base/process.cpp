#include "base/process.h"

#include <unistd.h>

#include <atomic>

namespace lightband {
namespace {

std::atomic<pid_t> owner{0};  // 0: no context was made yet
std::atomic<bool> ends{false};

}  // namespace

void claim_process() {
    pid_t none = 0;
    owner.compare_exchange_strong(none, getpid());
}

bool process_was_forked() {
    const pid_t claimed = owner;
    return claimed != 0 && claimed != getpid();
}

void begin_process_end() { ends = true; }
bool process_ends() { return ends; }

}  // namespace lightband
