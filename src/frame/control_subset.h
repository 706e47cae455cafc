// Passes that learn how much a frame's pixels err before they are shaded. Some pixels, chosen by chance, are the
// control subset. They are shaded with four times the samples that a pixel of the frame will have; with as many as it
// will have (pilot samples); and, since a biased sampler may miss the same light with any number of samples, some of
// them by a sampler without bias (docs/decisions/0010, 0017).
#pragma once

#include <vector>

#include "frame/control_set.h"
#include "frame/recheck.h"
#include "frame/run_state.h"

namespace lightband {

class ControlSubset {
public:
    explicit ControlSubset(RunState& run) : run_(run) {}

    // Chooses the pixels, and how many samples they get; false: the frame needs none.
    bool choose();
    bool needs_control() const { return effort_.samples > 0; }
    bool needs_pilot() const { return effort_.pilot > 0; }
    bool needs_recheck() const;
    // The first round plans so many samples a pixel: whether the subset has too few to tell of them; then it is to be
    // shaded again.
    bool is_outgrown_by(double planned);

    // The passes.
    Done shade_control();
    Done shade_pilot();
    Done recheck();
    Done replace_sampler();

    bool contradicted() const { return contradicted_; }  // whether the sampler is to be replaced
    void tell(Forecast* forecast) const;                 // what pilot samples say of the frame's noise

    const ControlSet& control() const { return control_; }
    double part() const { return part_; }  // of all pixels, that are compared with more samples

private:
    // A pixel that is to be rechecked: chosen by chance; and one where pilot samples and control samples differ.
    struct Rechecked {
        size_t place;
        bool by_chance, differs;
    };
    std::vector<ControlSet::Pixel> shade_alike(const std::vector<uint32_t>& pixels, const Settings& settings,
                                               uint32_t samples, uint32_t seed) const;
    std::vector<Rechecked> choose_rechecked() const;
    double harmless_difference() const;
    double pilot_error() const;

    RunState& run_;
    ControlSet::Effort effort_;
    std::vector<uint32_t> pixels_;  // y * width + x
    ControlSet control_;
    double part_ = 0;
    std::vector<ControlSet::Pixel> pilots_;  // the same pixels with pilot samples
    uint32_t pilot_samples_ = 0;             // of each; 0: there are none
    uint32_t unbiased_samples_ = 0;          // of each pixel that was rechecked
    bool contradicted_ = false;
};

}  // namespace lightband
