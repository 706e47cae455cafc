// The plan of a frame: what follows from its settings, before anything runs.
#include <set>

#include "frame/plan.h"
#include "numeric_testing.h"

namespace lightband {
namespace {

using namespace testing;

constexpr PlanInput input{100, 60, 3, 2, 1};

// Every combination of the settings that a plan depends on.
template <class Visit>
void each_frame(Visit visit) {
    for (const char* method : {"adaptive", "reference"})
        for (const char* sampler : {"cut", "combined", "filtered", "brdf"})
            for (const char* allocation : {"least_error", "constant_variance"})
                for (const double coarsest : {0.0, 5.0})
                    for (const double target : {0.0, 0.02})
                        for (const double time : {0.0, 100.0})
                            for (const char* background : {"none", "environment"}) {
                                Settings settings;
                                settings.set_choice("method", method);
                                settings.set_choice("sampler", sampler);
                                settings.set_choice("allocation", allocation);
                                settings.set_choice("background", background);
                                settings.set_number("coarsest_level", coarsest);
                                settings.set_number("target_error", target);
                                settings.set_number("time_budget", time);
                                visit(settings);
                            }
}

void what_is_read_is_written_and_what_is_written_is_read(void**) {
    each_frame([](const Settings& settings) {
        const Plan plan(settings, input);
        std::set<std::string> names, written, ever_read;
        for (const PlannedPass& pass : plan.passes()) {
            if (!names.insert(pass.name).second) fail_msg("%s is planned twice", pass.name.c_str());
            written.insert(pass.writes.begin(), pass.writes.end());
            for (const std::string& buffer : pass.reads) ever_read.insert(buffer);
        }
        // Rounds repeat, and the control subset is shaded into buffers that the first round writes again: so a buffer
        // may be read earlier in the list than it is written.
        for (const std::string& buffer : ever_read)
            if (written.count(buffer) == 0) fail_msg("nobody writes %s", buffer.c_str());
        for (const std::string& buffer : written)
            if (ever_read.count(buffer) == 0 && buffer != "depth") fail_msg("nobody reads %s", buffer.c_str());
    });
}

void plans_account_for_every_buffer_once(void**) {
    each_frame([](const Settings& settings) {
        const Plan plan(settings, input);
        std::set<std::string> written;
        uint64_t planned = 0, expected = 0;
        for (const PlannedPass& pass : plan.passes()) {
            planned += pass.bytes;
            written.insert(pass.writes.begin(), pass.writes.end());
        }
        for (const FrameBuffer& buffer : frame_buffers)
            if (written.erase(buffer.name) != 0) expected += bytes_of(buffer, input, settings.coarsest_level());
        if (!written.empty()) fail_msg("%s is no buffer of a frame", written.begin()->c_str());
        assert_true(planned == expected);
    });
}

// Rows of the pyramid of 60 rows: 60, 30, 15, 8, 4, 2.
void bytes_are_those_of_the_formats(void**) {
    for (const FrameBuffer& buffer : frame_buffers) {
        const uint64_t rows = buffer.pyramid ? 60 + 30 + 15 + 8 + 4 + 2 : 60;
        assert_true(bytes_of(buffer, input, 5) == rows * 100 * buffer.bytes);
    }
}

void what_a_frame_does_not_need_is_not_planned(void**) {
    each_frame([](const Settings& settings) {
        const Plan plan(settings, input);
        const bool adaptive = settings.method() == Method::adaptive,
                   interpolates = adaptive && settings.coarsest_level() > 0;
        const Sampler sampler = settings.sampler();
        for (const char* name : {"gbuffer", "covered", "classify", "list", "shade", "estimate"})
            assert_non_null(plan.find(name));
        for (const char* name : {"environment", "bandwidth"}) assert_true((plan.find(name) != nullptr) == adaptive);
        for (const char* name : {"pyramids", "upsample", "combine"})
            assert_true((plan.find(name) != nullptr) == interpolates);
        assert_true((plan.find("background") != nullptr) == settings.background());
        assert_true((plan.find("control") != nullptr) ==
                    (adaptive && (sampler == Sampler::cut || sampler == Sampler::filtered)));
        for (const char* name : {"recheck", "replace"})
            assert_true((plan.find(name) != nullptr) == (adaptive && sampler == Sampler::cut));
        if (plan.find("pilot") != nullptr)
            assert_true(adaptive && (settings.target_error() > 0 || sampler == Sampler::cut));
        bool variances = false;
        for (const PlannedPass& pass : plan.passes())
            for (const std::string& buffer : pass.writes) variances = variances || buffer == "variances";
        assert_true(variances == (interpolates && settings.shares_follow_variance()));
    });
}

void plans_say_what_chooses_their_programs(void**) {
    Settings settings;
    settings.set_choice("sampler", "brdf");
    settings.set_choice("sequence", "random");
    const std::string variant = Plan(settings, input).find("shade")->variant;
    assert_string_equal(variant.c_str(), "sampler=brdf sequence=random brdf_lookup=nearest environment_lookup=linear");
}

}  // namespace
}  // namespace lightband

int main() {
    using namespace lightband;
    const CMUnitTest tests[] = {
        cmocka_unit_test(what_is_read_is_written_and_what_is_written_is_read),
        cmocka_unit_test(plans_account_for_every_buffer_once),
        cmocka_unit_test(bytes_are_those_of_the_formats),
        cmocka_unit_test(what_a_frame_does_not_need_is_not_planned),
        cmocka_unit_test(plans_say_what_chooses_their_programs),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
