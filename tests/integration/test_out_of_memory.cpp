// Memory that runs out: whichever allocation of a call fails, the call returns LB_ERROR_OUT_OF_MEMORY, leaves
// everything as it was and keeps no block, and the same call then succeeds with the same result.
//
// Without arguments: tests of a sample of the allocations of each scenario. With --list: the scenarios' names. With a
// scenario's name and a number: a line of comma-separated values for each allocation from that one on
// (bench/out_of_memory.py).
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {
// clang-format off
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
// clang-format on
}

#include "failing_memory.h"
#include "lightband/lightband.hpp"
#include "out_of_memory_scenarios.h"

namespace {

using failing_memory::Blocks;
using failing_memory::Failing;

struct Outcome {
    bool failed = false;  // whether an allocation did
    lb_result result = LB_OK;
    std::string message;
    bool same = false;  // as without a failure
    Blocks left;        // more than before
};

// What a scenario is like without a failure.
struct Course {
    failing_memory::Course allocations;
    std::vector<uint8_t> before, after;  // states
};

// What the library and those beneath it keep for ever is made here.
Course course_of(const Scenario& scenario) {
    Course course;
    for (int i = 0; i < 2; ++i) {
        scenario.prepare();
        course.before = scenario.state();
        const int64_t first = failing_memory::count();
        const lb_result result = scenario.call();
        course.allocations = failing_memory::course_since(first);
        if (result != LB_OK) fail_msg("%s: %s", scenario.name.c_str(), lb_error_message());
        course.after = scenario.state();
        scenario.release();
    }
    return course;
}

// The call's, or what the C++ wrapper throws.
lb_result result_of(const Scenario& scenario) {
    try {
        return scenario.call();
    } catch (const lightband::Exception& exception) {
        return exception.code();
    } catch (const std::bad_alloc&) {
        return LB_ERROR_OUT_OF_MEMORY;
    }
}

Outcome attempt(const Scenario& scenario, const Course& course, int64_t granted, Failing failing) {
    Outcome outcome;
    outcome.message.reserve(4096);  // before blocks are counted; lb_error_message() is no longer
    const Blocks before = failing_memory::held();
    const int64_t first = failing_memory::count();
    scenario.prepare();
    failing_memory::fail_after(granted, failing);
    outcome.result = result_of(scenario);
    outcome.failed = failing_memory::stop_failing();
    if (outcome.result != LB_OK) {
        outcome.message = lb_error_message();
        outcome.same = scenario.state() == course.before && scenario.call() == LB_OK;
    } else {
        outcome.same = true;
    }
    outcome.same = outcome.same && scenario.state() == course.after;
    scenario.release();
    const Blocks after = failing_memory::held();
    outcome.left = {after.library - before.library, after.openexr - before.openexr};
    if (outcome.left.library != 0) failing_memory::print_held(first);
    return outcome;
}

void check(const Scenario& scenario, const Course& course, int64_t granted, Failing failing) {
    const Outcome outcome = attempt(scenario, course, granted, failing);
    const lb_result expected = outcome.failed ? LB_ERROR_OUT_OF_MEMORY : LB_OK;
    const bool recovered = scenario.recovers && outcome.result == LB_OK;
    if ((outcome.result == expected || recovered) && outcome.same && outcome.left.library == 0) return;
    fail_msg("%s with %lld allocations granted, then %s failing: %s (%s); %s; %lld blocks left", scenario.name.c_str(),
             (long long)granted, failing == Failing::one ? "one" : "all", lb_result_name(outcome.result),
             outcome.message.c_str(), outcome.same ? "all is as it was" : "not all is as it was",
             (long long)outcome.left.library);
}

// Some of the first and last allocations that places in the code ask for; where calls are quick, also the last of all,
// and one more than there are, so that none fails.
void test_sample(void** state) {
    const Scenario& scenario = *static_cast<Scenario*>(*state);
    const Course course = course_of(scenario);
    const std::vector<int64_t>& numbers = course.allocations.of_places;
    assert_true(!numbers.empty());
    constexpr size_t prime = 7919;
    const size_t sampled = std::min(size_t(scenario.sampled), numbers.size());
    for (size_t i = 0; i < sampled; ++i)
        check(scenario, course, numbers[i * prime % numbers.size()], i % 2 == 0 ? Failing::one : Failing::all);
    constexpr size_t few = 3;  // of calls that take long
    if (sampled <= few) return;
    check(scenario, course, course.allocations.count - 1, Failing::one);
    check(scenario, course, course.allocations.count, Failing::one);
}

void print(const Scenario& scenario, const Course& course, int64_t granted) {
    for (const Failing failing : {Failing::one, Failing::all}) {
        std::printf("%s,%lld,%s,", scenario.name.c_str(), (long long)granted, failing == Failing::one ? "one" : "all");
        std::fflush(stdout);  // where the process ends in this call, it has said in which
        Outcome outcome = attempt(scenario, course, granted, failing);
        std::replace(outcome.message.begin(), outcome.message.end(), '"', '\'');
        const bool recovered = scenario.recovers && outcome.result == LB_OK;
        const char* const result = recovered ? "recovered" : lb_result_name(outcome.result);
        std::printf("%s,%s,%lld,%lld,\"%s\"\n", outcome.failed ? result : "no failure",
                    outcome.same ? "yes" : "no", (long long)outcome.left.library, (long long)outcome.left.openexr,
                    outcome.result == LB_ERROR_OUT_OF_MEMORY ? "" : outcome.message.c_str());
    }
}

// From allocation `first` on: all, or of a course of more than that, those of places.
int print_all(const Scenario& scenario, int64_t first) {
    constexpr int64_t most = 500;  // of calls that are quick
    const Course course = course_of(scenario);
    if (course.allocations.count > most) {
        for (const int64_t number : course.allocations.of_places)
            if (number >= first) print(scenario, course, number);
        first = std::max(first, course.allocations.count);
    }
    for (; first <= course.allocations.count; ++first) print(scenario, course, first);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    failing_memory::begin();
    std::vector<Scenario> scenarios = make_scenarios();
    if (argc == 2 && std::strcmp(argv[1], "--list") == 0) {
        for (const Scenario& scenario : scenarios) std::printf("%s\n", scenario.name.c_str());
        return 0;
    }
    if (argc == 3) {
        for (const Scenario& scenario : scenarios)
            if (scenario.name == argv[1]) return print_all(scenario, std::atoll(argv[2]));
        return 2;
    }
    failing_memory::spare_dwa_blocks();
    std::vector<CMUnitTest> tests;
    for (Scenario& scenario : scenarios)
        if (scenario.sampled > 0) tests.push_back({scenario.name.c_str(), test_sample, nullptr, nullptr, &scenario});
    return _cmocka_run_group_tests("out_of_memory", tests.data(), tests.size(), nullptr, nullptr);
}
