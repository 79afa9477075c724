// The references that methods are compared with: each pose with every member of the family, solved once and kept as
// data. The default form solves two poses again, and learns the correctives of the limb again, and compares them with
// what is kept. README.md describes the poses, members and files.
//
//   pbskin reproduce references            two poses, three minutes
//   pbskin reproduce references --full     all poses, two to three hours; what is solved is kept, so that it goes on
//                                          where it was interrupted
#include "analysis/metrics/error_norms.hpp"
#include "analysis/records/provenance.hpp"
#include "analysis/records/record_files.hpp"
#include "analysis/records/tables.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/characters/body_cache.hpp"
#include "experiments/characters/skinning_weights.hpp"
#include "experiments/deformers/correctives.hpp"
#include "experiments/run/corrective_training.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/reference_poses.hpp"
#include "experiments/studies/shared/kept_references.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/extent.hpp"
#include "pbs/system/files.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace experiments {
namespace {

// The largest distance between two files of correctives, over the body's size. Each file rounds a coordinate of a mode
// by half of 5e-6 of the size, and the limb has eight modes, whose coefficients are at most one. The tolerance allows
// as much again for solutions, which end at 1e-5 of their first step.
constexpr double same_correctives = 2 * 8 * std::numbers::sqrt3 * 5e-6;
constexpr double same_solution = 1e-5;  // of the body's size: the largest difference of two solutions of one problem

struct ReferenceCase {
    ReferencePose pose;
    DeformerSpec flesh = {};
    std::vector<EnsembleMember> members = {};
    bool is_compared = false;  // with what is kept
};

nlohmann::json to_json(const ReferenceCase& reference_case)
{
    nlohmann::json members = nlohmann::json::array();
    for (const EnsembleMember& member : reference_case.members) members.push_back(to_json(member));
    return {{"pose", reference_case.pose.name},   {"scene", to_json(reference_case.pose.scene)},
            {"frame", reference_case.pose.frame}, {"flesh", to_json(reference_case.flesh)},
            {"members", std::move(members)},      {"is_compared", reference_case.is_compared}};
}

// references.csv.
struct ReferenceRow {
    std::string pose, body;
    Stratum stratum = Stratum::movement;
    std::string member, outcome = {};
    std::optional<double> own_error_pct = {}, linear_distance_pct = {};
    double left_out_pct = 0.0;  // share of the body's volume at tips of creases
    std::optional<double> energy_j = {}, lowest_det_f = {};
    int newton_steps = 0;
    double solve_s = 0.0;
    // largest distance of a vertex from the kept solution; nothing: not compared
    std::optional<double> from_kept_m = {};
};
const analysis::Columns<ReferenceRow> reference_columns =
    MEMBER_COLUMNS(ReferenceRow, pose, body, stratum, member, outcome, own_error_pct, linear_distance_pct, left_out_pct,
                   energy_j, lowest_det_f, newton_steps, solve_s, from_kept_m);

KeptReference solved(const ReferenceCase& reference_case, const EnsembleMember& member, const pbs::Character& character,
                     const pbs::Pose& bones, const std::string& solutions)
{
    const PosedReference reference(character, flesh_of(reference_case.flesh, member), bones,
                                   reference_case.pose.scene.motion.time_step_s, ReferenceEffort::own_tets, solutions);
    KeptReference kept{.member = member, .outcome = "not_reached", .at_tips = reference.masked()};
    for (const NestedSolution& solution : reference.solutions()) kept.seconds += solution.seconds;
    const NestedSolution& finest = reference.solutions().front();
    kept.newton_steps = finest.newton_steps;
    if (!reference.is_reached() || reference.reference().element_order != 2) return kept;
    kept.outcome = "reached";
    kept.positions = finest.positions;
    kept.energy_j = finest.energy_j;
    kept.lowest_det_f = finest.lowest_det_f;
    for (const NestedSolution& solution : reference.solutions())
        if (solution.finished && solution.element_order == 1)
            kept.linear_distance_pct = reference.error_of(solution.positions).joint_pct;
    return kept;
}

ReferenceRow row_of(const ReferenceCase& reference_case, const KeptReference& reference,
                    const analysis::ErrorMetrics& metrics)
{
    ReferenceRow row{.pose = reference_case.pose.name,
                     .body = reference_case.pose.of.body,
                     .stratum = reference_case.pose.stratum,
                     .member = reference.member.name};
    row.outcome = reference.outcome;
    if (std::isfinite(reference.own_error_pct())) row.own_error_pct = reference.own_error_pct();
    row.linear_distance_pct = reference.linear_distance_pct;
    row.left_out_pct = metrics.share_pct(reference.at_tips);
    row.energy_j = reference.energy_j;
    row.lowest_det_f = reference.lowest_det_f;
    row.newton_steps = reference.newton_steps;
    row.solve_s = reference.seconds;
    return row;
}

// Returns what differs, or an empty text.
std::string compared_with_kept(const KeptReferences& solved, const pbs::Character& character,
                               std::vector<ReferenceRow>& rows)
{
    const KeptReferences kept = read_references(solved.pose, character, solved.bones);
    const pbs::Positions& rest = character.mesh.rest;
    const double size_m = pbs::diagonal_m(rest);
    std::string differing;
    for (std::size_t m = 0; m < solved.members.size(); ++m) {
        const KeptReference& now = solved.members[m];
        const KeptReference& before = *kept.find(now.member.name);
        if (now.outcome != before.outcome)
            differing += solved.pose + ", " + now.member.name + ": " + now.outcome + ", kept: " + before.outcome + ". ";
        if (!now.is_reached() || !before.is_reached()) continue;
        rows[m].from_kept_m = (now.positions - before.positions).rowwise().norm().maxCoeff();
        if (*rows[m].from_kept_m > same_solution * size_m)
            differing += fmt::format("{}, {}: a vertex lies {:.2g} m from the kept solution. ", solved.pose,
                                     now.member.name, *rows[m].from_kept_m);
    }
    return differing;
}

std::string solve_and_record(const ReferenceCase& reference_case, const std::string& folder)
{
    const pbs::Character character = pbs::make_character(reference_case.pose.scene.character);
    KeptReferences references{.pose = reference_case.pose.name,
                              .body = reference_case.pose.of.body,
                              .mesh_hash = pbs::content_hash(character.mesh),
                              .revision = analysis::collect_provenance(1).git_revision,
                              .bones = bones_in(reference_case.pose, character.skeleton)};
    const analysis::ErrorMetrics metrics(error_domain(character, {}));
    std::vector<ReferenceRow> rows;
    for (const EnsembleMember& member : reference_case.members) {
        references.members.push_back(
            solved(reference_case, member, character, references.bones, solutions_of_run(folder)));
        rows.push_back(row_of(reference_case, references.members.back(), metrics));
    }
    const std::string differing = reference_case.is_compared ? compared_with_kept(references, character, rows) : "";
    analysis::write_text_atomically(analysis::path_in(folder, reference_case.pose.name + ".ref"),
                                    packed(references, character));
    table_of(reference_columns, rows).write(analysis::path_in(folder, "references.csv"));
    return differing;
}

// Correctives of a body, learned anew.
struct LearnedCase {
    std::string body;
    Scene scene = {};
    std::vector<Scene> motions = {};  // around whose rotations poses are drawn; none: around all movements
    FemOptions flesh = {};
    bool is_compared = false;  // with what is kept
};

nlohmann::json to_json(const LearnedCase& learned_case)
{
    nlohmann::json motions = nlohmann::json::array();
    for (const Scene& scene : learned_case.motions) motions.push_back(to_json(scene));
    const pbs::CorrectiveOptions fit;
    return {{"scene", to_json(learned_case.scene)},
            {"motions", std::move(motions)},
            {"poses", {DrawnPoses().count, DrawnPoses().further_deg}},
            {"fit", {fit.rank, fit.sweeps, fit.least_strength, fit.least_stretch, fit.negligible}},
            {"is_compared", learned_case.is_compared}};
}

// correctives.csv.
struct LearnedRow {
    std::string body;
    int poses = 0, modes = 0;
    double seconds = 0.0;
    // largest distance of a vertex from its place by the kept file, over the poses of the training
    std::optional<double> from_kept_m = {};
};
const analysis::Columns<LearnedRow> learned_columns =
    MEMBER_COLUMNS(LearnedRow, body, poses, modes, seconds, from_kept_m);

double largest_distance_m(const pbs::Correctives& one, const pbs::Correctives& other,
                          const std::vector<pbs::CorrectiveSample>& samples)
{
    double largest_m = 0.0;
    for (const pbs::CorrectiveSample& sample : samples)
        largest_m = std::max(largest_m,
                             (corrective_displacements(one, sample.pose) - corrective_displacements(other, sample.pose))
                                 .rowwise()
                                 .norm()
                                 .maxCoeff());
    return largest_m;
}

std::string learn_and_record(const LearnedCase& learned_case, const std::string& folder)
{
    const pbs::Stopwatch stopwatch;
    const pbs::Character character =
        pbs::with_weights(pbs::WeightKind::diffused, pbs::make_character(learned_case.scene.character));
    std::vector<pbs::Pose> poses;
    for (const Scene& scene : learned_case.motions) {
        const pbs::Motion motion = make_motion(scene.motion, character.skeleton, scene.file);
        poses.insert(poses.end(), motion.steps.begin(), motion.steps.end());
    }
    const JointRotations known =
        poses.empty() ? rotations_of_movements(character.skeleton) : rotations_in(character.skeleton, poses);
    const std::vector<pbs::CorrectiveSample> samples =
        solved_on_linear_elements(character, learned_case.flesh, drawn_poses(character.skeleton, known));
    const pbs::Correctives learned =
        pbs::fit_correctives(character.skeleton, character.mesh.rest, character.weights, samples);
    const std::string text = text_of(learned, character);
    LearnedRow row{learned_case.body, static_cast<int>(samples.size()), static_cast<int>(learned.modes()),
                   stopwatch.seconds()};
    std::string differing;
    if (learned_case.is_compared) {
        const std::string file = file_of_correctives(learned_case.body);
        const pbs::Correctives kept = parse_correctives(pbs::read_text_file(file), file, character);
        row.from_kept_m = largest_distance_m(parse_correctives(text, "", character), kept, samples);
        if (*row.from_kept_m > same_correctives * pbs::diagonal_m(character.mesh.rest))
            differing = fmt::format("correctives of {}: a vertex lies {:.2g} m from its place by the kept file. ",
                                    learned_case.body, *row.from_kept_m);
    }
    analysis::write_text_atomically(analysis::path_in(folder, learned_case.body + ".toml"), text);
    table_of(learned_columns, std::vector<LearnedRow>{row}).write(analysis::path_in(folder, "correctives.csv"));
    return differing;
}

LearnedCase learned_case(const StudyCase& in_file, bool full)
{
    LearnedCase learned{.body = in_file.value<std::string>("body"), .is_compared = !full};
    for (std::vector<std::string> motion : in_file.value<std::vector<std::vector<std::string>>>("learned_from")) {
        const std::string scene = motion.front();
        motion.erase(motion.begin());
        learned.motions.push_back(read_scene(scene, motion));
    }
    learned.scene = learned.motions.empty() ? read_scene("human_01_01", {"character.body=" + learned.body})
                                            : learned.motions.front();
    learned.flesh = options_of<FemOptions>(flesh_of(reference_flesh(learned.scene), family().front()));
    return learned;
}

StudyPlan plan(bool full)
{
    return plan_of_cases("references", full, [&](const StudyCase& in_file, StudyPlan& plan) {
        if (in_file.has("learned_from")) {
            plan.runs.push_back(work_run(in_file.name, learned_case(in_file, full), in_file.cost_s, learn_and_record));
            return;
        }
        ReferenceCase reference_case{.pose = reference_pose(in_file), .is_compared = !full};
        if (reference_case.is_compared) require_kept_tets(reference_case.pose.of.body);
        reference_case.members = members_of(reference_case.pose.stratum);
        reference_case.flesh = reference_flesh(reference_case.pose.scene);
        plan.runs.push_back(work_run(in_file.name, reference_case, in_file.cost_s, solve_and_record));
    });
}

bool conclude(const FinishedRuns& finished)
{
    finished.write("references.csv", reference_columns, finished.rows(reference_columns, "references.csv"));
    finished.write("correctives.csv", learned_columns, finished.rows(learned_columns, "correctives.csv"));
    return true;
}

}  // namespace

Study references_study()
{
    return {"references", plan, in_short, conclude};
}

}  // namespace experiments
