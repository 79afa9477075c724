// --resume repeats a run when anything changed that its work depends on. Reference: the members of the cases, each changed in turn.
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/external/external_deformers.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/studies/artefacts/artefact_values.hpp"
#include "experiments/studies/convergence/convergence_case.hpp"
#include "experiments/studies/ensemble/ensemble.hpp"
#include "experiments/studies/fit/fit.hpp"
#include "experiments/studies/jiggle/jiggle_records.hpp"
#include "experiments/studies/setup/body_setup.hpp"
#include "experiments/studies/stability/stability_cells.hpp"
#include "experiments/studies/stiffness/stiffness_ratios.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/studies/timing/bench.hpp"
#include "experiments/studies/timing/timing.hpp"
#include "experiments/studies/work_precision/measuring.hpp"
#include "pbs/author/author_solver.hpp"
#include "pbs/skinning/delta_mush.hpp"
#include "pbs/skinning/direct_delta_mush.hpp"
#include "pbs/solver/options.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/struct_members.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

template <typename Case>
std::string no_work(const Case&, const std::string&)
{
    return "";
}

// The number of changes.
template <typename Case>
int expect_each_change_repeats(const Case& of)
{
    const test_support::ScratchFolder scratch;
    const std::string folder = scratch / "run";
    const StudyRun run = work_run("run", of, 1.0, no_work<Case>);
    carry_out(run, folder);
    EXPECT_TRUE(is_finished(run, folder));
    int changes = 0;
    test_support::for_each_change(of, [&](const Case& changed, const std::string& what) {
        EXPECT_FALSE(is_finished(work_run("run", changed, 1.0, no_work<Case>), folder)) << what;
        ++changes;
    });
    return changes;
}

Scene limb()
{
    return read_scene("limb_bend", {});
}

TEST(RecordedSettings, OfThePosesOfStudies)
{
    EqualQualityCase quality;
    quality.of = {.body = "limb", .motion = "twist", .angle_deg = 150.0};
    quality.scene = limb(), quality.frame = 1, quality.random = {1};
    EXPECT_GE(expect_each_change_repeats(quality), 10);
    EnsembleCase ensemble;
    ensemble.of = {.body = "limb", .motion = "bend", .angle_deg = 60.0}, ensemble.scene = limb(), ensemble.frame = 1;
    ensemble.flesh = default_spec("fem"), ensemble.pbs = default_spec("pbs"), ensemble.other_flesh = {default_spec("fem")};
    ensemble.k_stretch = {0.2}, ensemble.iterations = {24};
    EXPECT_GE(expect_each_change_repeats(ensemble), 12);
    ConvergenceCase convergence;
    convergence.scene = limb(), convergence.frames = {{18, "bend_90"}}, convergence.k_stretch = {0.2};
    convergence.settings = {{}}, convergence.other_vertices = {600}, convergence.reference = default_spec("fem");
    EXPECT_GE(expect_each_change_repeats(convergence), 15);
}

// Its settings are those of a table of three columns, and its methods those of cases.toml and a file of the user's.
TEST(RecordedSettings, OfAComparison)
{
    const ReferencePose pose{"limb_bend_60", {.body = "limb", .motion = "bend", .angle_deg = 60.0}, Stratum::movement, limb(), 12};
    const ComparisonCase of{
        .name = "limb", .body = "limb", .clip = "01_01", .poses = {pose}, .settings = {{1.0, "pbs", "pbs.iterations=4"}}};
    static_assert(member_count<ComparisonCase>() == 8);
    const test_support::ScratchFolder scratch;
    const std::string folder = scratch / "run";
    carry_out(work_run("run", of, 1.0, no_work<ComparisonCase>), folder);
    const auto is_repeated = [&](const auto& change) {
        ComparisonCase changed = of;
        change(changed);
        return !is_finished(work_run("run", changed, 1.0, no_work<ComparisonCase>), folder);
    };
    EXPECT_FALSE(is_repeated([](ComparisonCase&) {}));
    int changes = 0;
    test_support::for_each_change(pose, [&](const ReferencePose& changed, const std::string& what) {
        EXPECT_TRUE(is_repeated([&](ComparisonCase& other) { other.poses[0] = changed; })) << what;
        ++changes;
    });
    EXPECT_GE(changes, 10);
    using Change = void (*)(ComparisonCase&);
    for (const Change change : std::vector<Change>{
             [](ComparisonCase& other) { other.name += "_2"; }, [](ComparisonCase& other) { other.body = "human"; },
             [](ComparisonCase& other) { other.what = Measured::training; }, [](ComparisonCase& other) { other.clip = "01_03"; },
             [](ComparisonCase& other) { other.poses.push_back(other.poses[0]); }, [](ComparisonCase& other) { other.rounds = 5; },
             [](ComparisonCase& other) { other.settings[0].budget_ms = 2.0; },
             [](ComparisonCase& other) { other.settings[0].method = "xpbd"; },
             [](ComparisonCase& other) { other.settings[0].setting = "pbs.iterations=8"; },
             [](ComparisonCase& other) { other.settings.clear(); },
             [](ComparisonCase& other) { other.external = {ComparedMethod{.external = default_spec("external")}}; }})
        EXPECT_TRUE(is_repeated(change)) << ++changes;
    EXPECT_FALSE(is_repeated([](ComparisonCase& other) { other.settings[0].training_ms = 0.5; })) << "a report of the choice";
}

// Programs and libraries are recorded by their content.
TEST(RecordedSettings, OfADeformerOfTheUsersOwn)
{
    DeformerSpec spec = default_spec("external");
    spec.options = ExternalOptions{.command = {"python3", "mine.py"}, .file_hashes = {"", "1f"}};
    const nlohmann::json recorded = to_json(spec);
    EXPECT_EQ(to_json(ComparisonCase{.external = {ComparedMethod{.external = spec}}}).at("external"), nlohmann::json::array({recorded}));
    const auto with = [&](void (*change)(ExternalOptions & options)) {
        DeformerSpec other = spec;
        change(options_of<ExternalOptions>(other));
        return to_json(other);
    };
    EXPECT_EQ(with([](ExternalOptions& options) { options.scene = "moved.toml"; }), recorded);
    EXPECT_NE(with([](ExternalOptions& options) { options.command.push_back("4"); }), recorded);
    EXPECT_NE(with([](ExternalOptions& options) { options.command = {}, options.library = "libmine.so"; }), recorded);
    EXPECT_NE(with([](ExternalOptions& options) { options.has_memory = true; }), recorded);
    EXPECT_NE(with([](ExternalOptions& options) { options.file_hashes[1] = "2e"; }), recorded);
    DeformerSpec renamed = spec;
    renamed.name = "yours";
    EXPECT_NE(to_json(renamed), recorded);
}

TEST(RecordedSettings, OfTheOtherStudies)
{
    const ArtefactCase artefacts{.scene = limb(), .poses = {{18, "bend_90_deg"}}, .joint = "upper|forearm", .vertices = {1200}};
    EXPECT_GE(expect_each_change_repeats(artefacts), 10);
    EXPECT_GE(expect_each_change_repeats(JoltCase{.scene = "limb_bend", .settings = {{"pbs.iterations=6"}}}), 12);
    EXPECT_GE(expect_each_change_repeats(StopCase{limb(), "forearm"}), 5);
    StabilityCell cell;
    cell.spec = default_spec("pbs");
    EXPECT_GE(expect_each_change_repeats(cell), 28);
    EXPECT_GE(expect_each_change_repeats(StiffnessSweep{.body = "limb"}), 5);
    const StiffnessSetting stiffness;
    test_support::for_each_change(stiffness, [&](const StiffnessSetting& changed, const std::string& what) {
        EXPECT_NE(to_json(changed), to_json(stiffness)) << what;
    });
    EXPECT_GE(expect_each_change_repeats(SagCase{}), 7);
    EXPECT_GE(expect_each_change_repeats(BodySetup{"ring", 0, {"pbs.k_volume=0.5"}, "pbs_author"}), 5);
    EXPECT_GE(expect_each_change_repeats(BenchOptions{.mesh = "bar.msh", .sizes = {1000}}), 7);
    TimedCase timed{.name = "man_1654", .scene = limb(), .model = "Man"};
    EXPECT_GE(expect_each_change_repeats(timed), 6);
    const nlohmann::json recorded = to_json(timed);
    timed.scene.character.refinements = 2;
    EXPECT_NE(to_json(timed), recorded) << "a mesh is that of its refinements";
    const FeaturesCase features{.name = "limb", .scene = "limb_bend", .cut = {"motion.frames=11"}, .features = {{"sleep"}}};
    EXPECT_GE(expect_each_change_repeats(features), 8);
}

template <typename Options>
void expect_each_option_is_recorded(const std::string& kind, const Options& options, int except_member = -1)
{
    DeformerSpec spec = default_spec(kind);
    spec.options = options;
    const nlohmann::json recorded = to_json(spec);
    test_support::for_each_change(options, [&](const Options& changed, const std::string& what) {
        if (what == "member " + std::to_string(except_member + 1)) return;
        spec.options = changed;
        EXPECT_NE(to_json(spec), recorded) << kind << ", " << what;
    });
}

TEST(RecordedSettings, OfDeformers)
{
    expect_each_option_is_recorded("fem", FemOptions{.model = reference_fem::Model::neo_hookean});  // linear models have no contact
    expect_each_option_is_recorded("lbs", BlendOptions{});
    expect_each_option_is_recorded("delta_mush", pbs::DeltaMushOptions{});
    expect_each_option_is_recorded("pbs_author", pbs::AuthorOptions{});
    expect_each_option_is_recorded("direct_delta_mush", pbs::DirectDeltaMushOptions{});
    const int threads = 6, threads_of_xpbd = 11;  // the member on which results do not depend
    expect_each_option_is_recorded("pbs", pbs::PbsOptions{}, threads);
    expect_each_option_is_recorded("xpbd", pbs::XpbdOptions{}, threads_of_xpbd);
}

}  // namespace
