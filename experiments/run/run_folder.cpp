#include "experiments/run/run_folder.hpp"

#include "analysis/records/atomic_file.hpp"
#include "analysis/records/provenance.hpp"
#include "experiments/process/blas_kernels.hpp"
#include "experiments/run/frame_statistics.hpp"
#include "experiments/run/library_versions.hpp"
#include "analysis/records/folder_files.hpp"
#include "analysis/records/record_text.hpp"
#include "experiments/run/surface_record.hpp"
#include "pbs/character/input_file.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io.hpp"
#include "pbs/geometry/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <regex>

namespace experiments {
namespace {

namespace fs = std::filesystem;
using Cell = analysis::CsvTable::Cell;

const std::vector<std::string> metric_columns = {"scene",
                                                 "deformer",
                                                 "variant",
                                                 "order",
                                                 "precision",
                                                 "iterations",
                                                 "threads",
                                                 "frame",
                                                 "time_s",
                                                 "volume_change_pct",
                                                 "volume_abs_change_pct",
                                                 "inverted_tets",
                                                 "mean_abs_j_minus_1",
                                                 "j_min",
                                                 "stretch_rms",
                                                 "bind_rms_m",
                                                 "step_ms"};
const std::vector<std::string> error_columns = {"error_l2_pct", "error_joint_pct", "error_linf_m", "reference_self_intersects"};
const std::vector<std::string> further_columns = {
    "angle_deg", "rotation_deg", "fictitious_strain", "min_section_pct", "surface_volume_change_pct", "outcome"};

const std::vector<std::string> error_bar_columns = {"reference_error_l2_pct", "reference_error_joint_pct", "reference_error_linf_m",
                                                    "error_below_reference_error"};

const std::vector<std::string> sleep_columns = {"sleeping_share", "wakings"};

int most_threads(const Scene& scene)
{
    int threads = 1;
    for (const DeformerSpec& spec : scene.deformers) threads = std::max(threads, spec.threads);
    return threads;
}

bool anything_sleeps(const Scene& scene)
{
    return std::any_of(scene.deformers.begin(), scene.deformers.end(), [](const DeformerSpec& spec) { return traits_of(spec).sleeps; });
}

std::vector<std::string> columns_of(const Scene& scene)
{
    std::vector<std::string> columns = metric_columns;
    if (!scene.reference.empty()) columns.insert(columns.end(), error_columns.begin(), error_columns.end());
    columns.insert(columns.end(), further_columns.begin(), further_columns.end());
    if (scene.error_bar != ErrorBar::none) columns.insert(columns.end(), error_bar_columns.begin(), error_bar_columns.end());
    if (anything_sleeps(scene)) columns.insert(columns.end(), sleep_columns.begin(), sleep_columns.end());
    return columns;
}

Cell cell(const std::optional<double>& value)
{
    return value ? Cell(*value) : Cell(std::nullopt);
}

std::vector<Cell> spec_cells(const Scene& scene, const DeformerSpec& spec)
{
    const DeformerTraits traits = traits_of(spec);
    return {scene.name,    spec.name,        spec.variant,
            traits.order,  traits.precision, traits.iterations ? Cell(*traits.iterations) : Cell(std::nullopt),
            traits.threads};
}

std::vector<Cell> error_cells(const FrameMeasurement& measured)
{
    if (!measured.errors) return std::vector<Cell>(error_columns.size(), std::nullopt);
    const auto& errors = *measured.errors;
    return {errors.l2_pct, errors.joint_pct, errors.linf_m, static_cast<int>(measured.reference_self_intersects)};
}

// The reference's own row has no difference that could be below.
std::vector<Cell> error_bar_cells(const FrameMeasurement& measured, bool is_reference)
{
    if (!measured.reference_error) return std::vector<Cell>(error_bar_columns.size(), std::nullopt);
    const analysis::ErrorNorms& bar = *measured.reference_error;
    return {bar.l2_pct, bar.joint_pct, bar.linf_m,
            is_reference ? Cell(std::nullopt) : Cell(static_cast<int>(measured.error_below_reference_error()))};
}

// Linear strain of a rigid rotation by theta: cos(theta) - 1 along the two axes across it.
double fictitious_strain(double rotation_deg)
{
    return 1.0 - std::cos(rotation_deg * std::numbers::pi / 180.0);
}

std::string frame_file(const std::string& name, int frame, const char* ending)
{
    return fmt::format("{}_{:06d}{}", name, frame, ending);
}

nlohmann::json quality_record(const pbs::TetMesh& mesh)
{
    const pbs::Quality quality = pbs::quality_of(mesh);
    return {{"volume_m3", quality.volume_m3},
            {"min_dihedral_deg", quality.min_dihedral_deg},
            {"edges", quality.edges},
            {"boundary_vertices", quality.boundary_vertices},
            {"boundary_manifold", quality.topology.boundary_manifold},
            {"boundary_euler", quality.topology.boundary_euler},
            {"components", quality.topology.components}};
}

nlohmann::json character_record(const pbs::Character& character)
{
    nlohmann::json record = {{"name", character.name},
                             {"vertices", character.mesh.rest.rows()},
                             {"tets", character.mesh.tets.rows()},
                             {"bones", character.skeleton.bones.size()},
                             {"quality", quality_record(character.mesh)}};
    if (character.refinements > 0) record["refinements"] = character.refinements;
    if (character.surface) record["surface_outside_m"] = character.surface->largest_distance_outside_m;
    return record;
}

// What RunFolder writes into frames/: LABEL_000123.vtu, LABEL_surface_000123.vtp, LABEL.pvd.
bool is_own_frame(const fs::path& file)
{
    static const std::regex own("[A-Za-z0-9_]+_[0-9]{6}\\.vt[up]|[A-Za-z0-9_]+\\.pvd");
    return std::regex_match(file.filename().string(), own);
}

}  // namespace

RunFolder::RunFolder(const Scene& scene, const pbs::Character& character, const std::string& folder)
    : scene_(scene),
      folder_(folder),
      metrics_(columns_of(scene)),
      iterations_({"deformer", "frame", "iteration", "stretch_rms", "volume_rms", "bind_rms_m"}),
      regions_(character)
{
    std::error_code error;
    fs::create_directories(fs::path(folder) / "frames", error);
    if (error) throw pbs::InputError(folder, 0, "", "", "the output folder cannot be made: " + error.message());
    for (const char* old : {"run.json", "metrics.csv", "frame_statistics.csv", "distances.csv", "iterations.csv", "regions.csv",
                            "bones.csv", "bones_rest.csv", "binding.csv", "surface_rest.vtp", "embedding.csv"})
        analysis::remove_record(fs::path(folder) / old);
    analysis::remove_abandoned_files(folder, false);
    analysis::remove_abandoned_files((fs::path(folder) / "frames").string(), false);
    for (const fs::path& file : analysis::files_in(fs::path(folder) / "frames"))
        if (is_own_frame(file)) analysis::remove_record(file);
}

void RunFolder::add_frame(const DeformerSpec& spec, int frame, double time_s, const FrameMeasurement& measured,
                          const pbs::StepSummary& step)
{
    std::vector<Cell> cells = spec_cells(scene_, spec);
    const auto& m = measured.metrics;
    const std::vector<Cell> figures = {
        frame,   time_s,        m.volume_change_pct, m.volume_abs_change_pct, m.inverted_tets, m.mean_abs_j_minus_1,
        m.j_min, m.stretch_rms, measured.bind_rms_m, 1e3 * step.seconds};
    cells.insert(cells.end(), figures.begin(), figures.end());
    if (!scene_.reference.empty())
        for (const Cell& error : error_cells(measured)) cells.push_back(error);
    const Cell strain = traits_of(spec).has_small_strain ? Cell(fictitious_strain(measured.rotation_deg)) : Cell(std::nullopt);
    for (const Cell& further : std::vector<Cell>{cell(measured.angle_deg), measured.rotation_deg, strain, cell(measured.min_section_pct),
                                                 cell(measured.surface_volume_change_pct), std::string(to_string(step.outcome))})
        cells.push_back(further);
    if (scene_.error_bar != ErrorBar::none)
        for (const Cell& bar : error_bar_cells(measured, spec.name == scene_.reference)) cells.push_back(bar);
    if (anything_sleeps(scene_)) {
        cells.push_back(step.sleeping_share);
        cells.push_back(step.wakings);
    }
    metrics_.add_row(cells);
    for (std::size_t k = 0; k < step.history.size(); ++k)
        iterations_.add_row({spec.label, frame, static_cast<int>(k) + 1, step.history[k].stretch_rms, step.history[k].volume_rms,
                             step.history[k].bind_rms_m});
}

void RunFolder::write_frame(const DeformerSpec& spec, int frame, double time_s, const pbs::Character& character,
                            const pbs::Positions& positions, const Eigen::VectorXd& volume_ratios, const std::vector<bool>& prescribed)
{
    pbs::FrameFields fields;
    fields.point_vectors["rest_position"] = character.mesh.rest;
    fields.point_vectors["displacement"] = positions - character.mesh.rest;
    fields.cell_scalars["volume_ratio"] = volume_ratios;
    if (traits_of(spec).solves_equations) {
        std::vector<int> flags(positions.rows(), 0);
        std::copy(prescribed.begin(), prescribed.end(), flags.begin());
        fields.point_flags["prescribed"] = std::move(flags);
    }
    const std::string name = spec.label;
    const fs::path frames = fs::path(folder_) / "frames";
    pbs::write_vtu((frames / frame_file(name, frame, ".vtu")).string(), positions, character.mesh.tets, fields);
    if (character.surface) {
        const pbs::Positions rendered = pbs::embedded_positions(*character.surface, positions, character.mesh.tets);
        pbs::write_vtp((frames / frame_file(name + "_surface", frame, ".vtp")).string(), rendered, character.surface->triangles);
        distances_.add(frame, time_s, name, "rendered surface", rendered);
    } else {
        distances_.add(frame, time_s, name, "mesh", positions);
    }
    collections_[name].emplace_back(time_s, frame_file(name, frame, ".vtu"));
}

void RunFolder::write_pose(int frame, double time_s, const pbs::Skeleton& skeleton, const pbs::Pose& pose)
{
    add_bones(bones_, frame, time_s, skeleton, pose);
}

void RunFolder::add_state(const DeformerSpec& spec, const pbs::Positions& positions)
{
    hashes_[spec.label].add(positions);
}

void RunFolder::write_tables() const
{
    const fs::path folder(folder_);
    metrics_.write((folder / "metrics.csv").string());
    frame_statistics(metrics_).write((folder / "frame_statistics.csv").string());
    if (iterations_.rows() > 0) iterations_.write((folder / "iterations.csv").string());
    regions_.table().write((folder / "regions.csv").string());
    if (distances_.table().rows() > 0) distances_.table().write((folder / "distances.csv").string());
    if (bones_.rows() > 0) bones_.write((folder / "bones.csv").string());
    for (const auto& [name, frames] : collections_) pbs::write_pvd((folder / "frames" / (name + ".pvd")).string(), frames);
}

void RunFolder::write_what_frames_hang_on(const pbs::Character& character) const
{
    const fs::path folder(folder_);
    rest_bone_table(character.skeleton).write((folder / "bones_rest.csv").string());
    binding_table(character).write((folder / "binding.csv").string());
    if (character.surface) write_surface(*character.surface, character.mesh, folder_);
}

void RunFolder::finish(const pbs::Character& character, const std::map<std::string, nlohmann::json>& deformer_records,
                       const nlohmann::json& outcome, CostRecord& cost, const nlohmann::json& reference_error_method)
{
    cost.time("records", [&] {
        write_tables();
        if (bones_.rows() > 0) write_what_frames_hang_on(character);
    });
    analysis::Provenance provenance = analysis::collect_provenance(most_threads(scene_));
    for (const auto& [library, version] : library_versions()) provenance.libraries[library] = version;
    provenance.blas = blas_in_use();
    provenance.input_hashes = pbs::hashes_by_name(character.inputs);

    nlohmann::json run = {{"schema", 1}, {"scene", resolved_with_deformers(scene_)}, {"provenance", provenance}, {"outcome", outcome}};
    for (const auto& [name, hash] : hashes_) run["state_hash"][name] = hash.hex();
    for (const auto& [name, record] : deformer_records) run["deformers"][name] = record;
    run["character"] = cost.time("records", [&] { return character_record(character); });
    if (!reference_error_method.is_null()) run["reference_error_method"] = reference_error_method;
    run["cost"] = cost.json();
    analysis::write_text_atomically((fs::path(folder_) / "run.json").string(), analysis::record_text(run));
}

}  // namespace experiments
