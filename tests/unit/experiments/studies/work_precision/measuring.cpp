// Errors against kept references. Reference: references that are made here, at known distances from the shapes of LBS,
// and each deformer driven by hand. Tolerance: references are kept in multiples of kept_quantum_m, and LBS blends in
// single precision.
#include "experiments/studies/work_precision/measuring.hpp"

#include "experiments/characters/body_cache.hpp"
#include "experiments/deformers/external/external_deformers.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/studies/shared/kept_references.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/system/files.hpp"
#include "tests/support/environment_variable.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <numeric>

namespace measuring_tests {
namespace {

using namespace experiments;

const std::vector<std::string> small_limb = {"character.vertices=300", "motion.angle_deg=60", "motion.frames=31"};

// The limb twisted by 60 degrees, which is one of the poses of other starts, and bent by 60 degrees. Its reference for
// member m is the shape of LBS, moved along x by m + 1 centimetres. In the bent pose rigid capsules were not reached.
class MeasuredLimb : public testing::Test {
protected:
    MeasuredLimb()
    {
        of.body = "limb";
        of.poses = {{"limb_twist_60", {.body = "limb"}, Stratum::movement, read_scene("limb_twist", small_limb), 30},
                    {"limb_bend_60", {.body = "limb"}, Stratum::fold, read_scene("limb_bend", small_limb), 30}};
        for (const ReferencePose& pose : of.poses) keep(pose);
    }

    void keep(const ReferencePose& pose)
    {
        KeptReferences kept{.pose = pose.name,
                            .body = "limb",
                            .mesh_hash = pbs::content_hash(limb().mesh),
                            .revision = "",
                            .bones = {}};
        kept.bones = bones_in(pose, limb().skeleton);
        for (const EnsembleMember& member : family()) {
            KeptReference& of_member = kept.members.emplace_back(KeptReference{.member = member, .outcome = "reached"});
            of_member.positions = blended(limb(), kept.bones);
            of_member.positions.col(0).array() += 0.01 * static_cast<double>(kept.members.size());
            of_member.at_tips.assign(limb().mesh.rest.rows(), false);
            if (pose.stratum == Stratum::fold && member.name == "rigid_capsules") of_member.outcome = "not_reached";
        }
        // A vertex at the tip of a crease lies anywhere.
        const auto at_the_joint = std::ranges::find(limb().blended, true) - limb().blended.begin();
        kept.members[1].at_tips[at_the_joint] = true;
        kept.members[1].positions.row(at_the_joint).array() += 0.5;
        references.file(pose.name + ".ref", packed(kept, limb()));
    }

    static const pbs::Character& limb()
    {
        static const pbs::Character character = pbs::make_character(read_scene("limb_twist", small_limb).character);
        return character;
    }

    std::vector<PointRow> rows_of(const Measurements& measurements, const std::string& method,
                                  const std::string& pose) const
    {
        std::vector<PointRow> rows;
        std::ranges::copy_if(measurements.points, std::back_inserter(rows),
                             [&](const PointRow& row) { return row.method == method && row.pose == pose; });
        return rows;
    }

    test_support::ScratchFolder references;
    test_support::EnvironmentVariable in_use{"PBSKIN_REFERENCES", references.path()};
    ComparisonCase of;
};

// 100 |t| over the mean distance of the blended vertices from their bones, weighted by lumped volumes; without a vertex
// the mean is that of the others.
double error_of_translation_pct(const pbs::Character& character, double translation_m, int without = -1)
{
    const Eigen::VectorXd mass = pbs::lumped_volumes(character.mesh.rest, character.mesh.tets);
    double sum = 0.0, weighted = 0.0;
    for (int v = 0; v < mass.size(); ++v)
        if (character.blended[v] && v != without) sum += mass(v), weighted += mass(v) * character.binding.distance(v);
    return 100.0 * translation_m * sum / weighted;
}

constexpr double kept_error_m = 1e-5;  // half a quantum along three axes, and single precision of coordinates of 1 m

TEST_F(MeasuredLimb, HasTheDistanceFromEachReferenceThatWasReached)
{
    of.settings = {{0.1, "lbs", ""}, {1.0, "lbs", ""}};
    const Measurements measurements = measure(of);
    EXPECT_EQ(measurements.breakdown, "");
    ASSERT_EQ(measurements.points.size(), 2u) << "a setting that is chosen for two times is measured once";
    const auto tip = std::ranges::find(limb().blended, true) - limb().blended.begin();
    const double tolerance_pct = error_of_translation_pct(limb(), kept_error_m);
    const Eigen::RowVector3d extents = limb().mesh.rest.colwise().maxCoeff() - limb().mesh.rest.colwise().minCoeff();
    for (const PointRow& row : measurements.points) {
        SCOPED_TRACE(row.pose);
        const bool is_bent = row.pose == "limb_bend_60";
        EXPECT_EQ(row.stratum, is_bent ? Stratum::fold : Stratum::movement);
        EXPECT_EQ(row.flesh, GivenFlesh::none);
        EXPECT_EQ(row.outcome, "finished");
        EXPECT_EQ(row.clock, FrameClock::processor);
        EXPECT_GT(row.ms.value(), 0.0);
        EXPECT_GT(row.times_pbs.value(), 0.0);
        EXPECT_LT(row.times_pbs.value(), 1.0) << "LBS is quicker than 24 iterations of PBS";
        std::vector<double> moved_m;
        for (std::size_t m = 0; m < members_of_family; ++m) {
            const double translation_m = 0.01 * static_cast<double>(m + 1);
            ASSERT_EQ(row.errors[m].has_value(), !(is_bent && m == 6)) << m;
            if (!row.errors[m]) continue;
            EXPECT_NEAR(*row.errors[m],
                        error_of_translation_pct(limb(), translation_m, m == 1 ? static_cast<int>(tip) : -1),
                        tolerance_pct)
                << m;
            moved_m.push_back(translation_m);
        }
        const double median_m = is_bent ? 0.04 : 0.045;  // of 1 to 8 cm, without 7 cm where the limb is bent
        EXPECT_NEAR(row.skin_mm.value(), 1e3 * median_m * 1.7 / extents.maxCoeff(), 1e3 * kept_error_m);
    }
}

// The error of a deformer that is driven by hand.
double error_by_hand(const ReferencePose& pose, const Setting& setting, std::size_t flesh, std::size_t member,
                     const pbs::Character& character)
{
    const auto deformer = make_deformer(spec_of(setting, pose.scene, character, family()[flesh]));
    deformer->reset(character);
    deformer->advance(bones_in(pose, character.skeleton), pose.scene.motion.time_step_s);
    const KeptReference reference =
        read_references(pose.name, character, bones_in(pose, character.skeleton)).members[member];
    return analysis::ErrorMetrics(error_domain(character, {}))
        .measure(deformer->positions(), reference.positions, reference.at_tips)
        .joint_pct;
}

TEST_F(MeasuredLimb, GivesMethodsTheFleshOfTheReferenceOrOfTheFirstMember)
{
    of.poses.resize(1);
    of.settings = {{1.0, "quasi_newton", "quasi_newton.iterations=1"}};
    of.rounds = 1;
    const Measurements measurements = measure(of);
    const std::vector<PointRow> rows = rows_of(measurements, "quasi_newton", "limb_twist_60");
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].flesh, GivenFlesh::own);
    EXPECT_EQ(rows[1].flesh, GivenFlesh::standard);
    const Setting setting{&*std::ranges::find(methods(), "quasi_newton", &ComparedMethod::name),
                          {"quasi_newton.iterations=1"}};
    for (const std::size_t m : {0, 4, 6, 7}) {
        EXPECT_DOUBLE_EQ(rows[0].errors[m].value(), error_by_hand(of.poses[0], setting, m, m, limb())) << m;
        EXPECT_DOUBLE_EQ(rows[1].errors[m].value(), error_by_hand(of.poses[0], setting, 0, m, limb())) << m;
        EXPECT_EQ(rows[0].errors[m] == rows[1].errors[m], m == 0) << m;
    }
    // Other starts are measured against the first member alone.
    for (const char* name : {"quasi_newton_from_lbs", "quasi_newton_of_wrong_material", "initial_guess_alone"}) {
        const std::vector<PointRow> started = rows_of(measurements, name, "limb_twist_60");
        ASSERT_EQ(started.size(), 1u) << name;
        EXPECT_EQ(started[0].flesh, GivenFlesh::start);
        EXPECT_EQ(started[0].setting, "quasi_newton.iterations=1") << "of the method that is varied";
        EXPECT_FALSE(started[0].ms);
        for (std::size_t m = 1; m < members_of_family; ++m) EXPECT_FALSE(started[0].errors[m]) << name;
        Setting changed = setting;
        const OtherStart& start = *std::ranges::find(other_starts(), name, &OtherStart::name);
        changed.keys.insert(changed.keys.end(), start.overrides.begin(), start.overrides.end());
        EXPECT_DOUBLE_EQ(started[0].errors[0].value(), error_by_hand(of.poses[0], changed, 0, 0, limb())) << name;
        EXPECT_NE(started[0].errors[0], rows[1].errors[0]) << name;
    }
    EXPECT_EQ(rows_of(measurements, "vbd_from_lbs", "limb_twist_60").size(), 0u) << "without a setting of its method";
}

TEST_F(MeasuredLimb, NeedsTheReferencesOfItsTets)
{
    of.settings = {{1.0, "lbs", ""}};
    std::filesystem::remove(references / "limb_bend_60.ref");
    expect_input_error([&] { measure(of); }, references / "limb_bend_60.ref: does not exist",
                       "`pbskin reproduce references --full`");
}

// A deformer of the user's own: a program that writes the shapes of LBS, which the test computes, and times of 1, 2, 4
// ... ms for its successive poses.
class OwnDeformer : public MeasuredLimb {
protected:
    // The poses that a program gets: of each pose the pose itself and three turns, which begin at the frame before.
    std::vector<pbs::Pose> turns() const
    {
        std::vector<pbs::Pose> poses;
        for (const ReferencePose& pose : of.poses)
            for (const int frame : {30, 29, 30, 29}) {
                ReferencePose of_frame = pose;
                of_frame.frame = frame;
                poses.push_back(bones_in(of_frame, limb().skeleton));
            }
        return poses;
    }

    void write_answers(bool bad, bool with_seconds) const
    {
        std::string positions, seconds;
        double time_s = 0.001;
        for (const pbs::Pose& pose : turns()) {
            pbs::Positions shape = blended(limb(), pose);
            if (bad) shape(3, 1) = std::nan("");
            positions.append(reinterpret_cast<const char*>(shape.data()),
                             static_cast<std::size_t>(shape.size()) * sizeof(double));
            seconds.append(reinterpret_cast<const char*>(&time_s), sizeof(double));
            time_s *= 2.0;
        }
        references.file("positions", positions);
        if (with_seconds) references.file("seconds.f64", seconds);
    }

    // `script` has the scratch folder as $0 and the exchange folder as $1.
    Measurements measured(const std::string& script, bool has_memory = false)
    {
        DeformerSpec spec = default_spec("external");
        spec.name = spec.label = "mine";
        spec.options = ExternalOptions{.command = {"/bin/sh", "-c", script, references.path().string()},
                                       .has_memory = has_memory,
                                       .scene = "mine.toml",
                                       .name = "mine"};
        of.external = {ComparedMethod{.name = "mine", .external = spec}};
        return measure(of);
    }
};

const std::string copies_answers =
    "echo run >> $0/calls; cp $0/positions $1/positions.f64; cp $0/seconds.f64 $1 2> /dev/null || true";

// The medians of 2, 4 and 8, and of 32, 64 and 128 ms.
TEST_F(OwnDeformer, IsCalledOnceForAllItsPosesAndHasTheTimesThatItStates)
{
    write_answers(false, true);
    const Measurements measurements = measured(copies_answers);
    EXPECT_EQ(std::filesystem::file_size(references / "calls"), 4u) << "one line";
    const PointRow twisted = rows_of(measurements, "mine", "limb_twist_60").at(0),
                   bent = rows_of(measurements, "mine", "limb_bend_60").at(0);
    EXPECT_DOUBLE_EQ(twisted.ms.value(), 4.0);
    EXPECT_DOUBLE_EQ(bent.ms.value(), 64.0);
    EXPECT_EQ(twisted.clock, FrameClock::own);
    EXPECT_EQ(twisted.flesh, GivenFlesh::none);
    EXPECT_EQ(twisted.setting, "");
    EXPECT_NEAR(bent.times_pbs.value() / twisted.times_pbs.value(), 16.0, 1e-12) << "of the same PBS";
    const double tolerance_pct = error_of_translation_pct(limb(), kept_error_m);
    for (const PointRow& row : {twisted, bent})
        EXPECT_NEAR(row.errors[2].value(), error_of_translation_pct(limb(), 0.03), tolerance_pct);
}

TEST_F(OwnDeformer, WithoutTimesHasTheWallTimeOverItsPoses)
{
    write_answers(false, false);
    const PointRow row = rows_of(measured("sleep 0.1; " + copies_answers), "mine", "limb_bend_60").at(0);
    EXPECT_EQ(row.clock, FrameClock::wall);
    EXPECT_GE(row.ms.value(), 12.5);  // 0.1 s over eight poses
    EXPECT_LT(row.ms.value(), 100.0);
}

TEST_F(OwnDeformer, ThatIsNotFiniteBreaksDown)
{
    write_answers(true, true);
    const Measurements measurements = measured(copies_answers);
    EXPECT_EQ(measurements.breakdown, "mine is not finite. ");
    const PointRow row = rows_of(measurements, "mine", "limb_bend_60").at(0);
    EXPECT_EQ(row.outcome, "not_finite");
    EXPECT_TRUE(std::ranges::none_of(row.errors, [](const std::optional<double>& error) { return error.has_value(); }));
    EXPECT_FALSE(row.skin_mm);
}

TEST_F(OwnDeformer, ThatFailsEndsTheRun)
{
    expect_input_error([&] { measured("exit 3"); }, "mine.toml: mine.command = /bin/sh",
                       "ended with status 3: expected status 0");
}

// The 24 frames before the pose.
TEST_F(OwnDeformer, WithMemoryGetsTheEarlierFramesFirst)
{
    of.poses.resize(1);
    EXPECT_THROW(measured("cp $1/poses.f64 $0/poses; exit 3", true), pbs::InputError);
    std::vector<int> frames(24);
    std::iota(frames.begin(), frames.end(), 6);
    frames.insert(frames.end(), {30, 29, 30, 29});
    std::vector<double> expected;
    for (const int frame : frames) {
        ReferencePose of_frame = of.poses[0];
        of_frame.frame = frame;
        const std::vector<double> rows = transform_rows(bones_in(of_frame, limb().skeleton));
        expected.insert(expected.end(), rows.begin(), rows.end());
    }
    const std::string bytes = pbs::read_text_file(references / "poses");
    ASSERT_EQ(bytes.size(), expected.size() * sizeof(double));
    EXPECT_EQ(std::memcmp(bytes.data(), expected.data(), bytes.size()), 0);
}

// Half a second of the human's clip. The reference is the converged shape, so that an iteration that begins near it
// ends nearer to it.
TEST(MeasuredMotion, BeginsEachFrameAtTheOneBefore)
{
    const test_support::ScratchFolder references;
    std::filesystem::create_symlink(std::filesystem::path(pbs::references_folder()) / "tets", references / "tets");
    const test_support::EnvironmentVariable in_use("PBSKIN_REFERENCES", references.path());
    ComparisonCase of{.body = "human", .what = Measured::played, .clip = "01_01"};
    of.poses = {
        {"human_played", {.body = "human", .motion = "01_01"}, Stratum::played, read_scene("human_01_01", {}), 50}};
    of.settings = {{1.0, "lbs", ""}, {1.0, "quasi_newton", "quasi_newton.iterations=4"}};
    const pbs::Character human = pbs::make_character(of.poses[0].scene.character);
    const pbs::Pose bones = bones_in(of.poses[0], human.skeleton);
    KeptReferences kept{.pose = "human_played",
                        .body = "human",
                        .mesh_hash = pbs::content_hash(human.mesh),
                        .revision = "",
                        .bones = bones};
    for (const EnsembleMember& member : members_of(Stratum::played)) {
        const Setting converged{&*std::ranges::find(methods(), "quasi_newton", &ComparedMethod::name),
                                {"quasi_newton.iterations=100"}};
        const auto deformer = make_deformer(spec_of(converged, of.poses[0].scene, human, member));
        deformer->reset(human);
        deformer->advance(bones, 0.01);
        kept.members.push_back({.member = member, .outcome = "reached", .positions = deformer->positions()});
        kept.members.back().at_tips.assign(human.mesh.rest.rows(), false);
    }
    references.file("human_played.ref", packed(kept, human));
    const Measurements measurements = measure(of);
    EXPECT_TRUE(measurements.points.empty());
    ASSERT_EQ(measurements.played.rows(), 8) << "two methods, two members, and two starts";
    const auto row = [&](const std::string& method, FrameGuess start, const std::string& member) {
        return measurements.played.find({{"method", method}, {"start", start}, {"member", member}}).value();
    };
    for (const char* member : {"smooth", "rigid_capsules"}) {
        SCOPED_TRACE(member);
        constexpr const char* error = "error_joint_pct";
        const auto cold = row("lbs", FrameGuess::cold, member), played = row("lbs", FrameGuess::frame_before, member);
        EXPECT_EQ(cold.number(error), played.number(error)) << "LBS has no initial guess";
        EXPECT_EQ(cold.text("pose"), "human_played");
        EXPECT_GT(played.number("ms"), 0.0);
        const auto newton_cold = row("quasi_newton", FrameGuess::cold, member),
                   newton = row("quasi_newton", FrameGuess::frame_before, member);
        EXPECT_LT(newton_cold.number(error), cold.number(error));
        EXPECT_LT(newton.number(error), 0.5 * newton_cold.number(error));
        EXPECT_LT(newton.number("skin_mm"), newton_cold.number("skin_mm"));
    }
}

}  // namespace
}  // namespace measuring_tests
