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
        {"volume",
         "volume change of LBS, DQS, PBS (1 to 384 iterations, jiggling, as printed) and the FEM by pose, on the limb and on every "
         "installed body; which bones and joints it comes from",
         "C01, C02", "some 1.5 minutes (--quick: 5 frames a second of the clips), 3.5 (--full: 25)", plan_volume_study, quick_and_full,
         conclude_volume_study},
        {"audit", "the paper against itself: mesh sizes, Table 1, the equations of the volume constraint", "C13, C14, C15", "some seconds",
         plan_audit_study, quick_and_full, conclude_audit_study},
        {"momentum", "what one projection of each class does to linear and angular momentum, by order, precision and masses", "C07",
         "some seconds", plan_momentum_study},
        {"convergence",
         "residuals, volume and the error to the reference over 1 to 1,000 iterations from LBS, the previous frame, the rest pose and the "
         "rigid bind, in three orders and two precisions; on the limb, a ladder of its sizes (in one precision, beside no reference, and "
         "above 8,000 vertices in one order) and every installed body; rates, iterations and time to tolerance, and towards what",
         "C03, C12", "some 30 seconds (--quick), 4 minutes (--full: to 100,000 vertices)", plan_convergence_study, quick_and_full,
         conclude_convergence_study},
        {"stability",
         "outcome of some hundreds of disturbed bodies: stiffness, time step, iterations, angle, masses, thin tets, gravity, teleports and "
         "broken starts to their extremes; PBS without and with jiggle, XPBD, the reference in equilibrium and in time, by the same bounds",
         "C08", "some 1 minute (--quick), 7 (--full)", plan_stability_study, quick_and_full, conclude_stability_study},
        {"artefacts",
         "cross-sections of twisted and bent limbs (candy wrapper, bulge), smoothness with the weights of Eq. 2 and rigid ones, and "
         "triangles that intersect, for every deformer on the limb and on real bodies",
         "C04, C05, C06", "some 1 minute (--quick), 3 (--full: all bodies, finer meshes)", plan_artefacts_study, quick_and_full,
         conclude_artefacts_study},
        {"jiggle",
         "the flesh's answer to a jolt: frequency, damping and amplitude against k_stretch, time step, iterations and masses, finite "
         "elements in time beside it; how far it lags in a walk; what the paper's jiggling zone is on each body",
         "C09", "some 10 seconds (--quick), 20 (--full: more settings)", plan_jiggle_study, quick_and_full, conclude_jiggle_study},
        {"stiffness",
         "force over displacement of flesh under gravity, on a bar, the limb and every installed body, against iterations, time step and "
         "vertices: PBS, PBS with Mueller's exponent, XPBD; ratios for one doubling, and exponents",
         "C11", "some 1 minute (--quick), 5 (--full: to 20,000 vertices, more stiffnesses and orders)", plan_stiffness_study,
         quick_and_full, conclude_stiffness_study},
        {"setup",
         "one scene's text over every installed body, a body with a handle and a ladder of sizes: which keys had to be changed, frames "
         "without inverted tets, seconds to set up",
         "C17", "some 20 seconds (--quick), 1 minute (--full)", plan_setup_study, quick_and_full, conclude_setup_study},
        {"ambiguity",
         "where the paper can be read in two ways, and what it leaves unstated: how much each reading changes the figures that claims are "
         "judged by, of the limb and the human, and whether they would be judged otherwise",
         "none: how far C01-C05, C07, C09, C10 and C12 hang on a reading",
         "some 30 seconds (--quick: without the human's step), 1 minute (--full: the whole clip, more iterations)", plan_ambiguity_study,
         quick_and_full, conclude_ambiguity_study},
        {"frames",
         "the frames that figures and the report's viewer show: the twisted and the bent limb, the human jumping and walking, by LBS, DQS, "
         "PBS and stable neo-Hookean finite elements, every frame on disk",
         "none", "some 30 seconds (--quick: the bend to 110 degrees; --full: to 150)", plan_frames_study},
        {"timing",
         "milliseconds of a frame on one core, of LBS, bind, stretch, volume and the whole, on meshes made to Table 1's counts, beside its "
         "figures; plain in f64 and f32, ordered in f32, by turns; and the size at which 30 frames a second end",
         "C10, C16", "some 1 minute (--quick), 2 (--full: to 100,000 vertices); keep the machine quiet", plan_timing_study, quick_and_full,
         conclude_timing_study, true},
        {"verification",
         "the FEM reference against theory, published benchmarks and other programs: patch tests, manufactured solutions, beams, sphere, "
         "plates, locking, time stepping, CalculiX; each row with reference, source, difference, order and bound",
         "none: how far the reference itself may be trusted", "some 1.5 minutes (--quick), 4 (--full)", plan_verification_study,
         full_in_short, conclude_verification_study},
        {"fit",
         "the elastic body that PBS is: Young's modulus by sag and by first frequency against k_stretch, iterations, time step and mesh; "
         "Poisson's ratio from twist and bend",
         "C11, in figures; no verdict", "some 2 minutes (--quick), 20 (--full)", plan_fit_study, full_in_short, conclude_fit_study},
        {"work_precision",
         "error against run time: LBS, DQS, delta mush, PBS, XPBD and the FEM at many settings and on several meshes, beside the stable "
         "neo-Hookean reference and its own error bar; Pareto fronts, who is nearest from which time on, and whether the physics is needed",
         "none: read ratios, not times", "some 3 minutes (--quick), 48 (--full: more poses, bodies and meshes)", plan_work_precision_study,
         in_short, conclude_work_precision_study, true},
        {"error_split",
         "the error of PBS against the reference, split into solver, model and discretisation; the share of the attachment and of the "
         "bones' thickness",
         "none: what C03 and C12 converge towards", "some 5 minutes (--quick: to 90 degrees), 35 (--full: with the refined reference)",
         plan_error_split_study, full_in_short, conclude_error_split_study},
        {"bench",
         "how long a step takes: every order, precision and number of threads beside plain loops in the same run and beside the machine's "
         "limits; LBS, DQS and the reference; how the cost grows with the mesh",
         "none: read ratios, not times", "some 2 minutes (--quick), 4 (--full: to a million tets); keep the machine quiet",
         plan_bench_study, full_in_short, conclude_bench_study, true},
        {"features",
         "what each switch of a scene costs: time a frame and a step, time to start, peak memory with and without it, on the limb and the "
         "human, and how far the answer moves",
         "none: read ratios, not times", "some 2 minutes (--quick), 9 (--full: more rounds); run it with -j 1 on a quiet machine",
         plan_features_study, full_in_short, conclude_features_study, true},
        {"scale",
         "the human from 2,000 tets to 100,000 (--full: 1,000,000), end to end: seconds of mesh, set-up, step, ruler and frames, peak "
         "memory, and the exponents they grow with",
         "none", "some 1 minute (--quick), 8 (--full)", plan_scale_study, when_named, conclude_scale_study, true},
    };
    return all;
}

}  // namespace experiments
