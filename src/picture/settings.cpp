#include "picture/settings.h"

#include <cmath>
#include <cstring>
#include <iterator>
#include <vector>

#include "base/error.h"

namespace lightband {
namespace {

constexpr double none = 0;

lb_setting_info number_setting(uint32_t type, const char* name, double low, double high, double standard,
                               const char* text) {
    return {sizeof(lb_setting_info), type, name, low, high, standard, nullptr, nullptr, text};
}
lb_setting_info integer(const char* name, double low, double high, double standard, const char* text) {
    return number_setting(LB_SETTING_INTEGER, name, low, high, standard, text);
}
lb_setting_info real(const char* name, double low, double high, double standard, const char* text) {
    return number_setting(LB_SETTING_REAL, name, low, high, standard, text);
}
// The first choice is the default.
lb_setting_info choice_of(const char* name, const char* choices, const char* standard, const char* text) {
    return {sizeof(lb_setting_info), LB_SETTING_CHOICE, name, none, none, none, standard, choices, text};
}

// The order is that of the enumerations in settings.h and elsewhere; Place names it.
enum Place {
    place_method,
    place_target_error,
    place_time_budget,
    place_samples,
    place_max_samples,
    place_bandwidth_scale,
    place_coarsest_level,
    place_pilots,
    place_transport,
    place_band_rule,
    place_variance,
    place_allocation,
    place_sampler,
    place_sequence,
    place_brdf_lookup,
    place_environment_lookup,
    place_split_suns,
    place_background,
    place_seed,
    place_accumulate,
    place_pass_times,
    place_count
};

const lb_setting_info table[] = {
    choice_of("method", "adaptive|reference", "adaptive",
              "adaptive: shade where the predicted bandwidth asks for it, interpolate elsewhere. reference: shade "
              "every pixel "
              "with random samples of the BRDF, the same number of each unless an error or a time is asked for."),
    real("target_error", 0, 1, 0,
         "Relative error of the frame that is asked for (docs/conventions.md); rounds of shading stop where the "
         "estimate is below "
         "it. 0: none. The frame's statistics say what was reached."),
    real("time_budget", 0, 1e6, 0,
         "Milliseconds that the frame may take; it becomes as good as they let. 0: no limit. With target_error: "
         "whichever comes "
         "first."),
    integer("samples", 1, 1 << 20, 64,
            "Light samples per shaded pixel: the mean of an adaptive frame, the constant number of a reference. Unused "
            "where an error "
            "or a time is asked for."),
    integer("max_samples", 1, 1 << 20, 1 << 16,
            "Most samples that one pixel may get where they are not the same number for all."),
    real("bandwidth_scale", 0, Settings::largest_bandwidth_scale, 0,
         "Factor on the predicted image bandwidth before a level is chosen; more: more pixels are shaded. 0: chosen so "
         "that "
         "interpolation errs about as much as the predicted noise; it grows with samples."),
    integer("coarsest_level", 0, 8, 5,
            "Coarsest spacing of shaded pixels is 2^coarsest_level. 0 shades every pixel, as a frame with an error or "
            "a time does where "
            "interpolation would not pay."),
    integer("pilots", 4, 1024, 16, "Directions per pixel in the prediction: n_b of eq. 5 and 9."),
    choice_of("transport", "correlated|box", "correlated",
              "Form of the reflection operator. box: as printed in figure 4. correlated: spatial and angular bandwidth "
              "of distant "
              "light are cut together (docs/decisions/0001)."),
    choice_of("band_rule", "energy|sum", "energy",
              "Which wavelet bands count. energy: figure 6, the 95th percentile of energy. sum: eq. 7, one percent of "
              "the largest "
              "coefficient (docs/decisions/0002)."),
    choice_of("variance", "moments|printed", "moments",
              "Predicted variance. moments: of importance-sampled light, from the map's local second moments. printed: "
              "the bound "
              "of eq. 9 for uniform sampling."),
    choice_of("allocation", "least_error|constant_variance", "least_error",
              "How samples are shared. least_error: in proportion to the square root of relative variance times the "
              "area a pixel "
              "is interpolated over. constant_variance: in proportion to relative variance (section 2.4)."),
    choice_of("sampler", "cut|combined|filtered|brdf", "cut",
              "Where an adaptive frame's samples come from. cut: half look up what the lobe's samples stand for in the "
              "map under a soft "
              "ceiling, half are parts of what exceeds it (docs/decisions/0009); biased, by less the more samples, and "
              "replaced where samples "
              "without bias contradict it (docs/decisions/0017). combined: half from "
              "the BRDF, half from the map, by the balance heuristic (Veach 1997); unbiased. filtered: from the BRDF, "
              "each looking up "
              "the mean of the map over the directions that it stands for (Krivanek and Colbert 2008); biased "
              "likewise. brdf: the "
              "papers'; unbiased. A reference always samples the BRDF."),
    choice_of("sequence", "lattice|random", "lattice",
              "Points of an adaptive frame: a lattice that each pixel shifts, or random numbers. A reference is always "
              "random."),
    choice_of("brdf_lookup", "nearest|linear", "nearest", "Lookup in a tabulated BRDF."),
    choice_of("environment_lookup", "linear|nearest", "linear", "Lookup in the environment's map."),
    choice_of("split_suns", "on|off", "on",
              "on: small bright sources of the environment's map, as the sun, are taken out of it and become suns of "
              "the same flux, mean "
              "direction and width: at most eight, of up to 0.02 radians around the brightest texels, that bring at "
              "least half of the "
              "light that comes from none; what is a wider disc than that stays. off: they stay texels of the map, "
              "exactly as it is "
              "interpolated; samples meet them more rarely, and beside the brightest ones the rest of the map is known "
              "less well."),
    choice_of("background", "none|environment", "none", "What pixels that see no mesh show."),
    integer("seed", 0, 4294967295.0, 0, "Frames with different seeds are independent; equal seeds give equal frames."),
    integer("accumulate", 1, 1 << 20, 1,
            "Frames rendered with successive seeds and averaged in double precision. 1 where an error or a time is "
            "asked for."),
    choice_of("pass_times", "off|on", "off",
              "on: every pass is waited for, so that lb_frame_explain knows how long each took. It costs some percent "
              "of a short frame."),
};

static_assert(std::size(table) == place_count);

int find(const std::string& name) {
    for (int i = 0; i < place_count; ++i)
        if (name == table[i].name) return i;
    std::string names;
    for (const lb_setting_info& setting : table) names += text(names.empty() ? "" : ", ", setting.name);
    throw Error(LB_ERROR_INVALID_ARGUMENT, text("there is no setting \"", name, "\"; there are ", names));
}

// choices split once; the strings that lb_frame_get_choice hands out live here.
const std::vector<std::string>& choices_of(int place) {
    static const auto& all = *new std::vector<std::vector<std::string>>([] {
        std::vector<std::vector<std::string>> lists;
        for (const lb_setting_info& setting : table) {
            std::vector<std::string>& list = lists.emplace_back();
            if (setting.choices == nullptr) continue;
            for (const std::string_view choice : split(setting.choices, '|')) list.emplace_back(choice);
        }
        return lists;
    }());
    return all[size_t(place)];
}

}  // namespace

Settings::Settings() {
    values_.fill(0);
    for (int i = 0; i < place_count; ++i) values_[size_t(i)] = table[i].default_number;
}

void Settings::set_number(const std::string& name, double value) {
    const int place = find(name);
    const lb_setting_info& setting = table[place];
    if (setting.type == LB_SETTING_CHOICE)
        throw Error(LB_ERROR_INVALID_ARGUMENT,
                    text("setting ", name, " takes one of ", setting.choices, ", not a number"));
    if (!(value >= setting.minimum && value <= setting.maximum))
        throw Error(LB_ERROR_INVALID_ARGUMENT,
                    text("setting ", name, " is ", value, "; it must be ", setting.minimum, " .. ", setting.maximum));
    if (setting.type == LB_SETTING_INTEGER && value != std::floor(value))
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("setting ", name, " is ", value, "; it must be a whole number"));
    values_[size_t(place)] = value;
}

void Settings::set_choice(const std::string& name, const std::string& value) {
    const int place = find(name);
    if (table[place].type != LB_SETTING_CHOICE)
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("setting ", name, " takes a number, not \"", value, "\""));
    const std::vector<std::string>& choices = choices_of(place);
    for (size_t i = 0; i < choices.size(); ++i)
        if (choices[i] == value) {
            values_[size_t(place)] = double(i);
            return;
        }
    throw Error(LB_ERROR_INVALID_ARGUMENT,
                text("setting ", name, " is \"", value, "\"; it must be one of ", table[place].choices));
}

double Settings::number(const std::string& name) const {
    const int place = find(name);
    if (table[place].type == LB_SETTING_CHOICE)
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("setting ", name, " is a choice, not a number"));
    return values_[size_t(place)];
}

const char* Settings::choice(const std::string& name) const {
    const int place = find(name);
    if (table[place].type != LB_SETTING_CHOICE)
        throw Error(LB_ERROR_INVALID_ARGUMENT, text("setting ", name, " is a number, not a choice"));
    return choices_of(place)[size_t(values_[size_t(place)])].c_str();
}

uint32_t Settings::count() {
    return place_count;
}
const lb_setting_info& Settings::info(uint32_t index) {
    return table[index];
}

Method Settings::method() const {
    return values_[place_method] == 0 ? Method::adaptive : Method::reference;
}
TransportForm Settings::transport() const {
    return values_[place_transport] == 0 ? TransportForm::correlated : TransportForm::box;
}
BandRule Settings::band_rule() const {
    return values_[place_band_rule] == 0 ? BandRule::energy : BandRule::sum;
}
Variance Settings::variance() const {
    return values_[place_variance] == 0 ? Variance::moments : Variance::printed;
}
Allocation Settings::allocation() const {
    return values_[place_allocation] == 0 ? Allocation::least_error : Allocation::constant_variance;
}
bool Settings::shares_follow_variance() const {
    return sampler() != Sampler::cut || allocation() == Allocation::constant_variance;
}

Sequence Settings::sequence() const {
    return values_[place_sequence] == 0 && method() == Method::adaptive ? Sequence::lattice : Sequence::random;
}
Sampler Settings::sampler() const {
    return method() == Method::adaptive ? Sampler(int(values_[place_sampler])) : Sampler::brdf;
}
Lookup Settings::brdf_lookup() const {
    return values_[place_brdf_lookup] == 0 ? Lookup::nearest : Lookup::linear;
}
Lookup Settings::environment_lookup() const {
    return values_[place_environment_lookup] == 0 ? Lookup::linear : Lookup::nearest;
}
bool Settings::split_suns() const {
    return values_[place_split_suns] == 0;
}
double Settings::target_error() const {
    return values_[place_target_error];
}
double Settings::time_budget() const {
    return values_[place_time_budget];
}
uint32_t Settings::samples() const {
    return uint32_t(values_[place_samples]);
}
uint32_t Settings::max_samples() const {
    return uint32_t(values_[place_max_samples]);
}
uint32_t Settings::pilots() const {
    return uint32_t(values_[place_pilots]);
}
uint32_t Settings::coarsest_level() const {
    return uint32_t(values_[place_coarsest_level]);
}
double Settings::bandwidth_scale() const {
    return values_[place_bandwidth_scale];
}
uint32_t Settings::seed() const {
    return uint32_t(values_[place_seed]);
}
uint32_t Settings::accumulate() const {
    return uint32_t(values_[place_accumulate]);
}
bool Settings::background() const {
    return values_[place_background] != 0;
}
bool Settings::pass_times() const {
    return values_[place_pass_times] != 0;
}

}  // namespace lightband
