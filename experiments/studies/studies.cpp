#include "experiments/studies/study.hpp"

namespace experiments {
namespace {

constexpr Sets quick_and_full = {Extent::quick, Extent::full};
// Whole, these would take longer than --full may: ask for them by name.
constexpr Sets in_short = {Extent::quick, Extent::quick};
constexpr Sets full_in_short = {Extent::none, Extent::quick};
constexpr Sets when_named = {Extent::none, Extent::none};

}  // namespace

const std::vector<Study>& studies()
{
    static const std::vector<Study> all = {
        {"volume", plan_volume_study, quick_and_full, conclude_volume_study},
        {"audit", plan_audit_study, quick_and_full, conclude_audit_study},
        {"momentum", plan_momentum_study},
        {"convergence", plan_convergence_study, quick_and_full, conclude_convergence_study},
        {"stability", plan_stability_study, quick_and_full, conclude_stability_study},
        {"artefacts", plan_artefacts_study, quick_and_full, conclude_artefacts_study},
        {"jiggle", plan_jiggle_study, quick_and_full, conclude_jiggle_study},
        {"stiffness", plan_stiffness_study, quick_and_full, conclude_stiffness_study},
        {"setup", plan_setup_study, quick_and_full, conclude_setup_study},
        {"ambiguity", plan_ambiguity_study, quick_and_full, conclude_ambiguity_study},
        {"frames", plan_frames_study},
        {"timing", plan_timing_study, quick_and_full, conclude_timing_study, true},
        {"verification", plan_verification_study, full_in_short, conclude_verification_study},
        {"fit", plan_fit_study, full_in_short, conclude_fit_study},
        {"work_precision", plan_work_precision_study, in_short, conclude_work_precision_study, true},
        {"error_split", plan_error_split_study, full_in_short, conclude_error_split_study},
        {"bench", plan_bench_study, full_in_short, conclude_bench_study, true},
        {"features", plan_features_study, full_in_short, conclude_features_study, true},
        {"scale", plan_scale_study, when_named, conclude_scale_study, true},
    };
    return all;
}

}  // namespace experiments
