// The settings of a frame: one table with name, type, range, default and meaning; typed values for the passes.
#pragma once

#include <array>
#include <string>

#include "bandwidth/transport.h"
#include "bandwidth/wavelet.h"
#include "lightband/lightband.h"
#include "picture/budget.h"
#include "scene/brdf.h"

namespace lightband {

enum class Method { adaptive, reference };
enum class Variance { moments, printed };
enum class Sequence { lattice, random };
enum class Sampler { cut, combined, filtered, brdf };

class Settings {
public:
    Settings();  // the defaults

    // Throw LB_ERROR_INVALID_ARGUMENT and change nothing.
    void set_number(const std::string& name, double value);
    void set_choice(const std::string& name, const std::string& value);
    double number(const std::string& name) const;
    const char* choice(const std::string& name) const;

    static uint32_t count();
    static const lb_setting_info& info(uint32_t index);

    Method method() const;
    TransportForm transport() const;
    BandRule band_rule() const;
    Variance variance() const;
    Allocation allocation() const;
    Sequence sequence() const;
    Sampler sampler() const;
    bool shares_follow_variance()
        const;  // or all pixels of one spacing have alike, as errs least under a cut (docs/decisions/0009)
    Lookup brdf_lookup() const;
    Lookup environment_lookup() const;
    bool split_suns() const;
    double target_error() const;  // 0: none
    double time_budget() const;   // milliseconds; 0: none
    uint32_t samples() const;
    uint32_t max_samples() const;
    uint32_t pilots() const;
    uint32_t coarsest_level() const;
    static constexpr double largest_bandwidth_scale = 1024;
    double bandwidth_scale() const;  // 0: to be balanced against the noise
    uint32_t seed() const;
    uint32_t accumulate() const;
    bool background() const;
    bool pass_times() const;

private:
    std::array<double, 32> values_;  // a number, or a choice's place among its choices
};

}  // namespace lightband
