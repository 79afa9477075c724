#include "experiments/references/export/reference_export.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/records/tables.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/characters/bone_capsules.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/references/export/plain_vtu.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "generated/exported_texts.hpp"
#include "pbs/flesh/bone_springs.hpp"
#include "pbs/geometry/extent.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <sstream>

namespace experiments {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// Lines of TOML: JSON's numbers, strings and lists are TOML's.
std::string toml_lines(const ordered_json& values)
{
    std::string lines;
    for (const auto& [key, value] : values.items()) lines += fmt::format("{} = {}\n", key, value.dump());
    return lines;
}

ordered_json numbers_of(const pbs::Vec3& point)
{
    return {point.x(), point.y(), point.z()};
}

std::string skeleton_text(const pbs::Skeleton& skeleton)
{
    std::string text;
    for (const pbs::Bone& bone : skeleton.bones)
        text += "[[joint]]\n" + toml_lines({{"name", bone.name},
                                            {"parent", bone.parent < 0 ? "" : skeleton.bones[bone.parent].name},
                                            {"head_m", numbers_of(bone.head)},
                                            {"tail_m", numbers_of(bone.tail)}});
    return text;
}

analysis::CsvTable weights_table(const pbs::Character& character)
{
    analysis::CsvTable table({"vertex", "joint", "weight"});
    const pbs::Weights& weights = character.weights;
    for (int v = 0; v < weights.vertices(); ++v)
        for (int e = weights.first[v]; e < weights.first[v + 1]; ++e)
            table.add_row({v, character.skeleton.bones[weights.bone[e]].name, weights.weight[e]});
    return table;
}

analysis::CsvTable capsules_table(const pbs::Character& character)
{
    analysis::CsvTable table(
        {"bone", "start_x_m", "start_y_m", "start_z_m", "end_x_m", "end_y_m", "end_z_m", "limb_radius_m"});
    int bone = 0;
    for (const auto& [a, b, limb_radius_m, from] : pbs::bone_capsules(character, 1.0))
        table.add_row({bone++, a.x(), a.y(), a.z(), b.x(), b.y(), b.z(), limb_radius_m});
    return table;
}

// K = sum_s k_s beta_s beta_s^T of the springs in each tet, by bone [m]. BoneHold has sum_s k_s beta_s (X_s, 1)^T, and
// (X_s, 1) is the tet's corners (X_i, 1) weighted by beta_s, so that its moments are K times the matrix whose rows are
// these corners.
analysis::CsvTable springs_table(const pbs::Character& character, const pbs::BoneSprings& springs)
{
    analysis::CsvTable table(
        {"tet", "bone", "k00_m", "k01_m", "k02_m", "k03_m", "k11_m", "k12_m", "k13_m", "k22_m", "k23_m", "k33_m"});
    const pbs::BoneHold hold(character.mesh, springs, static_cast<int>(character.skeleton.bones.size()));
    for (const auto& [tet, bone, moments] : hold.tet_moments()) {
        Eigen::Matrix4d corners = Eigen::Matrix4d::Ones();
        for (int i = 0; i < 4; ++i) corners.block<1, 3>(i, 0) = character.mesh.rest.row(character.mesh.tets(tet, i));
        const Eigen::Matrix4d k = moments * corners.inverse();
        std::vector<analysis::CsvTable::Cell> row = {tet, bone};
        for (int i = 0; i < 4; ++i)
            for (int j = i; j < 4; ++j) row.emplace_back((k(i, j) + k(j, i)) / 2.0);
        table.add_row(row);
    }
    return table;
}

// Members that are held by the same springs share their file, which has the name of the first of them.
std::string springs_file(const std::string& body, const EnsembleMember& member)
{
    const auto has_same_springs = [&](const EnsembleMember& other) {
        return other.attachment == member.attachment && other.spring_factor == member.spring_factor &&
               other.core_radius == member.core_radius;
    };
    const std::vector<EnsembleMember> members = family();
    const auto first = std::ranges::find_if(members, has_same_springs);
    return fmt::format("{}.springs_{}.csv", body, first == members.end() ? member.name : first->name);
}

// The fields that errors are measured with.
PlainFields error_fields(const pbs::Character& character)
{
    return {.of_points = {{"bone_distance_m", character.binding.distance},
                          {"lumped_volume_m3", pbs::lumped_volumes(character.mesh.rest, character.mesh.tets)}},
            .labels_of_points = {{"blended", {character.blended.begin(), character.blended.end()}}}};
}

// To a nanometre, which is what references are written to: they are kept to kept_quantum_m. Rest positions of bodies
// are written whole.
Eigen::MatrixXd rounded(const Eigen::MatrixXd& lengths_m)
{
    return (1e9 * lengths_m).array().round() / 1e9;
}

// The entry of a family's member in pose.toml.
ordered_json member_facts(const std::string& body, const pbs::Character& character, const FemOptions& flesh,
                          const KeptReference& reference)
{
    const double young_pa = flesh.young_pa, nu = flesh.poisson;
    double mean_radius_m = 0.0;
    for (const pbs::BoneCapsule& limb : pbs::bone_capsules(character, 1.0))
        mean_radius_m += limb.radius_m / static_cast<double>(character.skeleton.bones.size());
    ordered_json facts = {{"name", reference.member.name}, {"outcome", reference.outcome}};
    if (reference.is_reached()) facts["file"] = reference.member.name + ".vtu";
    facts.update({{"springs", "../bodies/" + springs_file(body, reference.member)},
                  {"attachment", name_of(flesh.attachment)},
                  {"spring_factor", flesh.used_spring_factor()},
                  {"core_radius", flesh.used_core_radius()},
                  {"young_pa", young_pa},
                  {"poisson", nu},
                  {"lambda_pa", young_pa * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))},
                  {"mu_pa", young_pa / (2.0 * (1.0 + nu))},
                  {"formulation", name_of(flesh.formulation)},
                  {"contact_range_m", flesh.contact_range * mean_radius_m},
                  {"contact_stiffness_pa", flesh.contact_stiffness * young_pa}});
    if (std::isfinite(reference.own_error_pct())) facts["own_error_pct"] = reference.own_error_pct();
    if (reference.linear_distance_pct) facts["linear_distance_pct"] = *reference.linear_distance_pct;
    if (reference.energy_j) facts["energy_j"] = *reference.energy_j;
    if (reference.lowest_det_f) facts["lowest_det_f"] = *reference.lowest_det_f;
    return facts;
}

// The .vtu of a member that was reached.
std::string reference_text(const pbs::Character& character, const KeptReference& reference)
{
    PlainFields fields = error_fields(character);
    fields.of_points["bone_distance_m"] = rounded(character.binding.distance);
    fields.of_points["displacement"] = rounded(reference.positions - character.mesh.rest);
    fields.labels_of_points["at_tips"] = {reference.at_tips.begin(), reference.at_tips.end()};
    if (std::isfinite(reference.own_error_pct())) fields.facts["own_error_pct"] = reference.own_error_pct();
    if (reference.energy_j) fields.facts["energy_j"] = *reference.energy_j;
    return plain_vtu({rounded(character.mesh.rest), character.mesh.tets}, fields);
}

// Whether the program wrote the whole text. A manual in which the user added or changed a line is the user's. The
// rows of the tables may differ, since they list the poses in the folder.
bool is_manual(const std::string& text)
{
    if (!text.starts_with(exported::exported_references_md)) return false;
    std::istringstream tables(text.substr(std::string(exported::exported_references_md).size()));
    for (std::string line; std::getline(tables, line);)
        if (!line.empty() && !line.starts_with("|") && line != "## Bodies" && line != "## Poses") return false;
    return true;
}

// Says for how many poses a body is not installed. pbs::InputError for a name that is no pose, and for one whose body
// is not installed.
std::vector<std::string> checked_poses(const std::vector<std::string>& named)
{
    std::map<std::string, std::string> body_of;
    std::vector<std::string> names;
    const nlohmann::json cases = cases_document("references").at("case");
    for (const auto& pose : cases) {
        names.push_back(pose.at("name"));
        body_of[names.back()] = pose.at("bodies").at(0);
    }
    for (const std::string& name : named) {
        if (!body_of.contains(name))
            throw pbs::InputError("", 0, "pose", name,
                                  "unknown name; the nearest known one is " + pbs::nearest_name(name, names));
        pbs::require_body(body_of.at(name));
    }
    if (!named.empty()) return {};
    std::map<std::string, int> left_out;  // reason -> poses
    for (const auto& [name, body] : body_of) {
        try {
            pbs::require_body(body);
        } catch (const pbs::InputError& not_installed) {
            ++left_out[not_installed.what()];
        }
    }
    std::vector<std::string> remarks;
    for (const auto& [reason, poses] : left_out)
        remarks.push_back(fmt::format("{} poses are left out: {}", poses, reason));
    return remarks;
}

}  // namespace

PosesToExport poses_to_export(const std::vector<std::string>& names)
{
    PosesToExport chosen{.left_out = checked_poses(names)};
    chosen.poses = reference_poses();
    if (!names.empty()) {
        std::erase_if(chosen.poses,
                      [&](const ReferencePose& pose) { return std::ranges::count(names, pose.name) == 0; });
        return chosen;
    }
    const auto is_kept = [](const ReferencePose& pose) { return fs::exists(file_of_references(pose.name)); };
    if (const auto not_kept = std::erase_if(chosen.poses, std::not_fn(is_kept)); not_kept > 0)
        chosen.left_out.push_back(fmt::format(
            "{} poses are left out: no references of them are kept; `pbskin reproduce references --full` solves them",
            not_kept));
    return chosen;
}

void ReferenceExport::add(const ReferencePose& pose)
{
    const pbs::Character& character = body_of(pose);
    const KeptReferences kept = read_references(pose.name, character, bones_in(pose, character.skeleton));
    if (written_bodies_.insert(kept.body).second) write_body(kept.body, character);
    const std::string folder = analysis::path_in(folder_, pose.name);
    analysis::make_output_folder(folder);
    std::string text = toml_lines({{"pose", pose.name},
                                   {"body", kept.body},
                                   {"stratum", name_of(pose.stratum)},
                                   {"mesh_hash", kept.mesh_hash},
                                   {"revision", kept.revision},
                                   {"tets", "../bodies/" + kept.body + ".vtu"},
                                   {"skeleton", "../bodies/" + kept.body + ".skeleton.toml"}});
    for (std::size_t b = 0; b < kept.bones.size(); ++b) {
        ordered_json rows;
        for (int i = 0; i < 3; ++i)
            rows.push_back({kept.bones[b](i, 0), kept.bones[b](i, 1), kept.bones[b](i, 2), kept.bones[b](i, 3)});
        text += "\n[[bone]]\n" + toml_lines({{"name", character.skeleton.bones[b].name}, {"transform", rows}});
    }
    for (const KeptReference& reference : kept.members) {
        const auto flesh = options_of<FemOptions>(flesh_of(reference_flesh(pose.scene), reference.member));
        text += "\n[[member]]\n" + toml_lines(member_facts(kept.body, character, flesh, reference));
        write_springs(kept.body, character, flesh, reference.member);
        if (reference.is_reached())
            write(analysis::path_in(folder, reference.member.name + ".vtu"), reference_text(character, reference));
    }
    write(analysis::path_in(folder, "pose.toml"), text);
    ++poses_;
}

void ReferenceExport::write_manual()
{
    analysis::remove_abandoned_files(folder_);
    write(analysis::path_in(folder_, "own_solver.py"), exported::own_solver_py);
    const std::string poses = table_of_poses();
    const std::string text =
        exported::exported_references_md +
        "\n## Bodies\n\n| body | vertices | tets | bones | diagonal at rest [m] |\n"
        "|---|---|---|---|---|\n" +
        table_of_bodies() + "\n## Poses\n\n| pose | body | stratum | members that were reached |\n|---|---|---|---|\n" +
        poses;
    const std::string manual = analysis::path_in(folder_, "README.md");
    if (!fs::exists(manual) || is_manual(analysis::read_text(manual)))
        analysis::write_text_atomically(manual, text);
    else
        not_replaced_.push_back(manual);
}

void ReferenceExport::write(const std::string& path, const std::string& text)
{
    if (!fs::exists(path))
        analysis::write_text_atomically(path, text);
    else if (analysis::read_text(path) != text)
        not_replaced_.push_back(path);
}

std::string ReferenceExport::table_of_bodies() const
{
    std::string table;
    for (const std::string& name : written_bodies_) {
        const pbs::Character& character = bodies_.at(name);
        const pbs::Positions& rest = character.mesh.rest;
        table += fmt::format("| `{}` | {} | {} | {} | {:.4f} |\n", name, rest.rows(), character.mesh.tets.rows(),
                             character.skeleton.bones.size(), pbs::diagonal_m(rest));
    }
    return table;
}

// A row per pose in the folder; their bodies belong to the other table.
std::string ReferenceExport::table_of_poses()
{
    std::string table;
    for (const ReferencePose& pose : reference_poses()) {
        if (!fs::exists(fs::path(folder_) / pose.name / "pose.toml")) continue;
        const pbs::Character& character = body_of(pose);
        const KeptReferences kept = read_references(pose.name, character, bones_in(pose, character.skeleton));
        const auto reached = std::ranges::count_if(kept.members, &KeptReference::is_reached);
        table += fmt::format("| `{}` | {} | {} | {} of {} |\n", pose.name, kept.body, name_of(pose.stratum), reached,
                             kept.members.size());
        written_bodies_.insert(kept.body);
    }
    return table;
}

const pbs::Character& ReferenceExport::body_of(const ReferencePose& pose)
{
    const auto known = bodies_.find(pose.of.body);
    return known != bodies_.end()
               ? known->second
               : bodies_.emplace(pose.of.body, pbs::make_character(pose.scene.character)).first->second;
}

void ReferenceExport::write_body(const std::string& name, const pbs::Character& character)
{
    analysis::make_output_folder(fs::path(folder_) / "bodies");
    PlainFields fields = error_fields(character);
    fields.labels_of_points["nearest_bone"] = character.binding.bone;
    fields.labels_of_tets["held_by_bone"] = pbs::bones_that_move_alone(character);
    write(body_file(name + ".vtu"), plain_vtu(character.mesh, fields));
    write(body_file(name + ".skeleton.toml"), skeleton_text(character.skeleton));
    write(body_file(name + ".weights.csv"), weights_table(character).text());
    write(body_file(name + ".capsules.csv"), capsules_table(character).text());
}

void ReferenceExport::write_springs(const std::string& body, const pbs::Character& character, const FemOptions& flesh,
                                    const EnsembleMember& member)
{
    const std::string file = springs_file(body, member);
    if (!written_springs_.insert(file).second) return;
    const pbs::CapsuleSprings held =
        pbs::bone_springs(character, spring_placement(flesh.attachment), spring_options(flesh));
    write(body_file(file), springs_table(character, held.springs).text());
}

std::string ReferenceExport::body_file(const std::string& name) const
{
    return (fs::path(folder_) / "bodies" / name).string();
}

}  // namespace experiments
