// All settings in a training pose. Reference: the methods' table, and deformers that are driven by hand.
#include "experiments/characters/body_cache.hpp"
#include "experiments/characters/skinning_weights.hpp"
#include "experiments/deformers/correctives.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/studies/shared/kept_references.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/work_precision/measuring.hpp"
#include "tests/support/environment_variable.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

namespace {

using namespace experiments;

// Its reference for member m is the shape of LBS, moved along x by m + 1 centimetres.
TEST(Training, TriesAllSettingsWithTheFleshOfTheTrainingMembers)
{
    const test_support::ScratchFolder references;
    const test_support::EnvironmentVariable in_use("PBSKIN_REFERENCES", references.path());
    ComparisonCase of{.body = "limb", .what = Measured::training, .rounds = 1};
    of.poses = {{"limb_twist_30",
                 {.body = "limb"},
                 Stratum::training,
                 read_scene("limb_twist", {"character.vertices=300"}),
                 6}};
    const ReferencePose& pose = of.poses.front();
    const pbs::Character limb = pbs::make_character(pose.scene.character);
    const pbs::Pose bones = bones_in(pose, limb.skeleton);
    KeptReferences kept{
        .pose = pose.name, .body = "limb", .mesh_hash = pbs::content_hash(limb.mesh), .revision = "", .bones = bones};
    for (const EnsembleMember& member : family()) {
        kept.members.push_back({.member = member, .outcome = "reached", .positions = blended(limb, bones)});
        kept.members.back().positions.col(0).array() += 0.01 * static_cast<double>(kept.members.size());
        kept.members.back().at_tips.assign(limb.mesh.rest.rows(), false);
    }
    references.file("limb_twist_30.ref", packed(kept, limb));
    kept = read_references(pose.name, limb, bones);
    // correctives that move nothing
    const pbs::Character diffused = pbs::with_weights(pbs::WeightKind::diffused, limb);
    std::filesystem::create_directory(references / "correctives");
    references.file("correctives/limb.toml",
                    text_of(pbs::fit_correctives(limb.skeleton, limb.mesh.rest, diffused.weights, {}), diffused));
    const Measurements measurements = measure(of);

    // smooth, nu_0.49 and rigid_capsules
    const auto is_training_member = [](std::size_t m) { return m == 0 || m == 5 || m == 6; };
    std::map<std::string, std::map<std::string, const PointRow*>> tried;  // by method and setting
    for (const PointRow& row : measurements.points) {
        EXPECT_TRUE(tried[row.method].emplace(row.setting, &row).second) << row.setting;
        EXPECT_GT(row.ms.value(), 0.0) << row.setting;
        for (std::size_t m = 0; m < members_of_family; ++m)
            EXPECT_EQ(row.errors[m].has_value(), row.outcome == "finished" && is_training_member(m))
                << row.setting << ", " << m;
    }
    // A ladder begins with the fewest iterations, and ends where a frame takes too long.
    for (const ComparedMethod& method : methods())
        for (const KeyValues& of_grid : method.grid) {
            const auto is_tried = [&](const Setting& setting) { return tried[method.name].contains(setting.text()); };
            const std::vector<Setting> ladder = tried_settings(method, of_grid);
            EXPECT_TRUE(is_tried(ladder.front())) << ladder.front().text();
            EXPECT_TRUE(std::ranges::is_partitioned(ladder, is_tried)) << ladder.front().text();
        }
    const analysis::ErrorMetrics metrics(error_domain(limb, {}));
    for (const auto& [name, keys] : {std::pair<std::string, KeyValues>{"quasi_newton", {"quasi_newton.iterations=4"}},
                                     {"pbs", {"pbs.iterations=8", "pbs.k_bind=0.1"}}}) {
        const Setting setting{&*std::ranges::find(methods(), name, &ComparedMethod::name), keys};
        const PointRow& row = *tried.at(name).at(setting.text());
        EXPECT_EQ(row.flesh, name == "pbs" ? GivenFlesh::none : GivenFlesh::own);
        EXPECT_EQ(row.stratum, Stratum::training);
        for (const std::size_t m : {0, 5, 6}) {
            const auto deformer = make_deformer(spec_of(setting, pose.scene, limb, family()[m]));
            deformer->reset(limb);
            deformer->advance(bones, pose.scene.motion.time_step_s);
            EXPECT_DOUBLE_EQ(row.errors[m].value(),
                             metrics.measure(deformer->positions(), kept.members[m].positions).joint_pct)
                << name;
        }
    }
}

}  // namespace
