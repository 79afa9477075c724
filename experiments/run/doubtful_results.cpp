#include "experiments/run/doubtful_results.hpp"

#include "experiments/characters/separated_parts.hpp"
#include "pbs/geometry/extent.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>

namespace experiments {

using nlohmann::literals::operator""_json_pointer;

namespace {

constexpr double many_inverted_pct = 1.0;    // of the tets, in the first frame
constexpr double far_from_artist_pct = 2.0;  // of the model's size

// A root on the ground, from which a rig hangs, is such a bone.
std::vector<std::string> bones_without_flesh(const nlohmann::json& deformer_record)
{
    std::vector<std::string> names;
    const nlohmann::json::json_pointer bones("/attachment/bones");
    if (!deformer_record.contains(bones)) return names;
    for (const nlohmann::json& grip : deformer_record.at(bones))
        if (grip.value("tets_gripped", 1) == 0) names.push_back(grip.at("bone").get<std::string>());
    return names;
}

// The bone whose weights are largest over the corners of the inverted tets.
const std::string& bone_of_inverted_tets(const pbs::Character& character, const Eigen::VectorXd& volume_ratios)
{
    std::vector<double> share(character.skeleton.bones.size());
    for (Eigen::Index tet = 0; tet < volume_ratios.size(); ++tet) {
        if (volume_ratios(tet) > 0.0) continue;
        for (const int v : character.mesh.tets.row(tet))
            for (int e = character.weights.first[v]; e < character.weights.first[v + 1]; ++e)
                share[character.weights.bone[e]] += character.weights.weight[e];
    }
    return character.skeleton.bones[std::ranges::max_element(share) - share.begin()].name;
}

// Blending that inverts many tets in the first frame, before anything has moved far, points to a rest pose that is not
// the model's.
pbs::RemarkList remarks_on_inverted_start(const Scene& scene, const pbs::Character& character,
                                          const std::vector<Runner>& runners)
{
    std::vector<std::string> counts;
    int least = std::numeric_limits<int>::max();  // weights of another rule may be the cause under one method alone
    for (const Runner& runner : runners) {
        if (!runner.traits.blends_linearly) continue;
        least = std::min(least, runner.most_inverted);
        if (runner.most_inverted > 0)
            counts.push_back(fmt::format("{} has {}", runner.spec.label, runner.most_inverted));
    }
    if (counts.empty()) return {};
    const Eigen::Index tets = character.mesh.tets.rows();
    const std::string text =
        fmt::format("{}: {} inverted tets in the first frame, of {}", scene.file, fmt::join(counts, " and "), tets);
    if (least > many_inverted_pct / 100.0 * static_cast<double>(tets))
        return {{pbs::Gravity::results_wrong,
                 text + ": its pose is far from the bind pose, or the weights do not fit the joints"}};
    return {{pbs::Gravity::information, text}};
}

}  // namespace

pbs::RemarkList remarks_on_set_up(const Scene& scene, const pbs::Character& character,
                                  const std::vector<Runner>& runners)
{
    pbs::RemarkList remarks;
    std::vector<std::string> with_soft_slivers;
    int slivers = 0;
    for (const Runner& runner : runners) {
        const nlohmann::json record = runner.deformer->record();
        if (const auto without = bones_without_flesh(record); !without.empty())
            remarks.push_back({pbs::Gravity::part_left_out,
                               fmt::format("{}: {} leaves out {} of {} bones, whose middle lies outside the flesh: {}",
                                           scene.file, runner.spec.label, without.size(),
                                           character.skeleton.bones.size(), pbs::name_list(without))});
        if (const int loose = record.is_object() ? record.value("/attachment/loose_parts"_json_pointer, 0) : 0;
            loose > 0)
            remarks.push_back(
                {pbs::Gravity::part_left_out, fmt::format("{}: no bone holds {} separate part{} of the flesh, {:.2g} % "
                                                          "of its volume: in {}, linear blend skinning "
                                                          "moves {}",
                                                          scene.file, loose, loose == 1 ? "" : "s",
                                                          record.at("/attachment/loose_pct"_json_pointer).get<double>(),
                                                          runner.spec.label, loose == 1 ? "it" : "them")});
        if (!record.contains("weakened_slivers")) continue;
        slivers = record.at("weakened_slivers").get<int>();
        with_soft_slivers.push_back(runner.spec.label);
    }
    if (!with_soft_slivers.empty())
        remarks.push_back(
            {pbs::Gravity::part_left_out,
             fmt::format(
                 "{}: {} of {} tets are slivers, whose volume is below 1e-5 of their longest edge cubed: {} could not "
                 "turn them, and take them as soft as regular tets; remesh the body, or leave these tets out",
                 scene.file, slivers, character.mesh.tets.rows(), fmt::join(with_soft_slivers, ", "))});
    return remarks;
}

pbs::RemarkList remarks_on_first_frame(const Scene& scene, const pbs::Character& character, const CaseMotion& motion,
                                       const std::vector<Runner>& runners, const FrameMeasurer& measurer)
{
    if (!scene.character.body.empty()) return {};
    pbs::RemarkList remarks;
    // A warning names a clip whose directions are far from the body's as the cause.
    if (!motion.is_far_from_clip()) remarks = remarks_on_inverted_start(scene, character, runners);
    for (const Runner& runner : runners) {
        if (const nlohmann::json record = runner.deformer->record();
            record.is_object() && record.contains("follows_from_rest"))
            remarks.push_back(
                {pbs::Gravity::information,
                 fmt::format(
                     "{}: the first frame turns a joint by more than 90 degrees from the bind pose, or a blend of its "
                     "pose leaves tets inside out: {} goes to each frame in steps from the bind pose",
                     scene.file, runner.spec.label)});
        if (runner.traits.iterations && !runner.traits.solves_equations && runner.most_inverted > 0)
            remarks.push_back(
                {pbs::Gravity::information,
                 fmt::format("{}: {} begins with {} inverted tets, most of them at {}: what is caught in the first "
                             "frame may stay so",
                             scene.file, runner.spec.label, runner.most_inverted,
                             bone_of_inverted_tets(character, measurer.volume_ratios(runner.deformer->positions())))});
    }
    return remarks;
}

CarriedSkin carried_skin(const pbs::Character& character, const RunFolder::FollowedSkin& followed)
{
    const pbs::Positions& rest = character.artist->model->body.surface;
    const double size_m = pbs::diagonal_m(rest);
    const pbs::Carrier carrier = pbs::carrier_of(character, followed.vertex);
    const auto bone = [&](int b) -> const pbs::Bone& { return character.skeleton.bones[static_cast<std::size_t>(b)]; };
    return {.largest_pct = 100.0 * followed.largest_m / size_m,
            .frame = followed.frame,
            .bone = bone(carrier.bone).name,
            .bone_of_flesh = bone(carrier.of_flesh).name,
            .gap_m = carrier.gap_m,
            .gap_pct = 100.0 * carrier.gap_m / size_m,
            .at_a_joint = carrier.bone == carrier.of_flesh || bone(carrier.bone).parent == carrier.of_flesh ||
                          bone(carrier.of_flesh).parent == carrier.bone};
}

void to_json(nlohmann::json& json, const CarriedSkin& skin)
{
    json = {{"largest_pct", skin.largest_pct},
            {"frame", skin.frame},
            {"bone", skin.bone},
            {"bone_of_flesh", skin.bone_of_flesh},
            {"gap_mm", 1e3 * skin.gap_m}};
}

pbs::RemarkList remarks_on(const CarriedSkin& skin, const std::string& scene_file)
{
    if (skin.largest_pct <= far_from_artist_pct) return {};
    const std::string cause =
        skin.at_a_joint
            ? fmt::format(
                  "the tets at {} are too coarse for its weights; --vertices (character.vertices in a scene) asks for "
                  "more",
                  skin.bone)
            : fmt::format(
                  "there the flesh of {} carries the surface of {}, with a gap of {:.2g} % of that size at rest",
                  skin.bone_of_flesh, skin.bone, skin.gap_pct);
    return {{pbs::Gravity::results_wrong, fmt::format("{}: the surface that LBS carries with the tets is up to {:.1f} "
                                                      "% of the model's size away from the artist's, in "
                                                      "frame {}: {}",
                                                      scene_file, skin.largest_pct, skin.frame, cause)}};
}

}  // namespace experiments
