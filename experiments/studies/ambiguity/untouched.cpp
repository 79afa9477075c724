#include "experiments/studies/ambiguity/untouched.hpp"

#include "experiments/studies/ambiguity/read_deformer.hpp"

namespace experiments {
namespace {

// But for what `take_over` takes from the baseline.
template <typename TakeOver>
bool same_but_for(Reading reading, const Reading& baseline, const TakeOver& take_over)
{
    take_over(reading);
    reading.place = baseline.place;
    reading.name = baseline.name;
    reading.baseline = baseline.baseline;
    return to_json(reading) == to_json(baseline);
}

std::string of_projections(const Reading& reading, const Reading& baseline)
{
    if (ReadDeformer(reading).has_memory()) return "each projection is taken by itself, from the LBS shape";
    const bool of_bones = same_but_for(reading, baseline, [&](Reading& r) {
        r.bind_point = baseline.bind_point;
        r.options.bind_on_bone = baseline.options.bind_on_bone;
        r.options.k_bind = baseline.options.k_bind;
    });
    if (of_bones) return "bind is to a bone, which takes momentum: no part of the figure";
    const bool of_order = same_but_for(reading, baseline, [&](Reading& r) { r.options.class_order = baseline.options.class_order; });
    return of_order ? "each class is taken by itself" : "";
}

std::string of_jolts(const Reading& reading, const Reading& baseline)
{
    if (same_but_for(reading, baseline, [&](Reading& r) { r.options.gravity_m_s2 = baseline.options.gravity_m_s2; }))
        return "jolted flesh has no weight";
    const bool of_bones = same_but_for(reading, baseline, [&](Reading& r) {
        r.bind_point = baseline.bind_point;
        r.blended_bones = baseline.blended_bones;
    });
    return of_bones ? "a jolt moves all bones alike" : "";
}

std::string of_frames(const Reading& reading, const Reading& baseline)
{
    const bool of_factors = same_but_for(reading, baseline, [&](Reading& r) {
        r.options.k_stretch = baseline.options.k_stretch;
        r.options.k_volume = baseline.options.k_volume;
        r.options.k_bind = baseline.options.k_bind;
        r.options.stiffness_form = baseline.options.stiffness_form;
        r.options.gravity_m_s2 = baseline.options.gravity_m_s2;
        if (r.options.jiggle && r.options.jiggle->k_bind.value_or(1.0) > 0.0) r.options.jiggle = baseline.options.jiggle;
    });
    return of_factors ? "another factor is no more work" : "";
}

}  // namespace

std::string untouched_because(const std::string& claim, const Reading& reading, const Reading& baseline)
{
    if (same_but_for(reading, baseline, [](Reading&) {})) return "the scene is so by itself";
    const bool is_posed = claim == "C03" || claim == "C12" || claim == "C04" || claim == "C05";
    if (is_posed && reading.options.jiggle) return "measured where nothing jiggles";
    if (is_posed && reading.substeps > 1) return "nothing remembers the last step";
    if ((claim == "C03" || claim == "C12") && ReadDeformer(reading).has_memory()) return "the start is what is compared";
    if (claim == "C01" && reading.blended_bones == baseline.blended_bones) return "LBS alone is measured";
    if (claim == "C07") return of_projections(reading, baseline);
    if (claim == "C09") return of_jolts(reading, baseline);
    if (claim == "C10") return of_frames(reading, baseline);
    return "";
}

}  // namespace experiments
