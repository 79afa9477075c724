#include "experiments/run/run_folder.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/statistics/statistics.hpp"
#include "experiments/characters/body_cache.hpp"
#include "experiments/characters/model_character.hpp"
#include "experiments/characters/skinning_weights.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "experiments/run/metrics_table.hpp"
#include "experiments/run/run.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

struct IterationRow {
    std::string deformer;
    int frame = 0, iteration = 0;
    pbs::Residuals residuals;
};
const analysis::Columns<pbs::Residuals> residual_columns =
    MEMBER_COLUMNS(pbs::Residuals, stretch_rms, volume_rms, bind_rms_m);
const analysis::Columns<IterationRow> iteration_columns = MEMBER_COLUMNS(IterationRow, deformer, frame, iteration) +
                                                          analysis::within(&IterationRow::residuals, residual_columns);

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
    if (character.artist) record["model"] = model_record(character);
    if (character.surface) record["surface_outside_m"] = character.surface->largest_distance_outside_m;
    return record;
}

// A model without joints has no skinning of its own.
bool has_artist_skin(const pbs::Character& character)
{
    return character.artist && character.artist->model && !character.artist->model->body.skeleton.bones.empty();
}

}  // namespace

nlohmann::json model_record(const pbs::Character& character)
{
    const pbs::RiggedModel& model = *character.artist->model;
    const pbs::RiggedBody& body = model.body;
    nlohmann::json record = {{"file", pbs::file_name(model.rig.file)}, {"containers", body.containers}};
    for (const auto* list : {"joints", "joints_dropped", "meshes", "animations"})
        record[list] = nlohmann::json::array();
    for (const pbs::Bone& bone : body.skeleton.bones) record["joints"].push_back(bone.name);
    for (const pbs::DroppedJoint& joint : body.dropped)
        record["joints_dropped"].push_back({{"name", joint.name}, {"reason", joint.reason}});
    for (const pbs::RigMesh& mesh : body.binding.meshes) record["meshes"].push_back(mesh.name);
    for (const pbs::RigAnimation& animation : model.rig.animations) record["animations"].push_back(animation.name);
    record["animation"] = model.animation ? nlohmann::json(model.animation->name) : nlohmann::json();
    record["bind_pose_deg"] = body.bind_pose_deg;
    record["metres_per_unit"] = body.binding.metres_per_unit;
    record["extent_m"] = (body.surface.colwise().maxCoeff() - body.surface.colwise().minCoeff()).maxCoeff();
    if (!body.skeleton.bones.empty())
        record["weights_transferred_pct"] =
            pbs::carried_weight(body.skin, character.artist->weights, *character.surface, character.mesh.tets,
                                static_cast<int>(body.skeleton.bones.size()))
                .share_pct();
    return record;
}

RunFolder::RunFolder(const Scene& scene, const pbs::Character& character, const std::string& folder, int frames)
    : scene_(scene),
      folder_(folder),
      metrics_(metric_columns_of(scene).names()),
      iterations_(iteration_columns.names()),
      regions_(character)
{
    for (int frame = 0; frame < frames; ++frame) written_frames_ += scene.output.writes(frame);
    std::error_code error;
    fs::create_directories(fs::path(folder) / "frames", error);
    if (error) throw pbs::InputError(folder, 0, "", "", "the output folder cannot be made: " + error.message());
    earlier_.emplace(folder);
    analysis::remove_abandoned_files(folder, false);
    analysis::remove_abandoned_files((fs::path(folder) / "frames").string(), false);
    if (has_artist_skin(character)) fs::create_directories(fs::path(folder) / "skin", error);
    if (scene.output.glb && character.artist && character.artist->model) {
        const pbs::RiggedModel& model = *character.artist->model;
        look_ = model.body.look;
        materials_ = pbs::read_materials(model.rig.file);
    }
}

void RunFolder::add_frame(const DeformerSpec& spec, int frame, double time_s, const FrameMeasurement& measured,
                          const pbs::StepSummary& step)
{
    metrics_.add_row(cells_of(metric_columns_of(scene_), metric_row(scene_, spec, frame, time_s, measured, step)));
    for (std::size_t k = 0; k < step.history.size(); ++k)
        iterations_.add_row(cells_of(iteration_columns, {spec.label, frame, static_cast<int>(k) + 1, step.history[k]}));
}

void RunFolder::write_frame(const DeformerSpec& spec, int frame, double time_s, const pbs::Pose& pose,
                            const pbs::Character& character, const pbs::Positions& positions, FrameMeasurer& measurer,
                            const std::vector<bool>& prescribed)
{
    pbs::FrameFields fields;
    fields.point_vectors["rest_position"] = character.mesh.rest;
    fields.point_vectors["displacement"] = positions - character.mesh.rest;
    fields.point_flags["contact_depth_um"] = measurer.contact_depths_um(positions);
    fields.cell_scalars["volume_ratio"] = measurer.volume_ratios(positions);
    if (traits_of(spec).solves_equations) {
        std::vector<int> flags(positions.rows(), 0);
        std::copy(prescribed.begin(), prescribed.end(), flags.begin());
        fields.point_flags["prescribed"] = std::move(flags);
    }
    const std::string name = spec.label;
    const fs::path frames = fs::path(folder_) / "frames";
    pbs::write_vtu((frames / frame_file(name, frame, ".vtu")).string(), positions, character.mesh.tets, fields);
    if (character.surface) {
        const pbs::Positions rendered = pbs::surface_positions(character, positions, pose);
        if (scene_.output.surface_files)
            pbs::write_vtp((frames / frame_file(name + "_surface", frame, ".vtp")).string(), rendered,
                           character.surface->triangles);
        distances_.add(frame, time_s, name, "rendered surface", rendered);
        if (name == "lbs") lbs_surface_ = rendered;
        const bool is_in_glb = posed_frames_ % glb_every_ == 0;
        if (scene_.output.glb && is_in_glb && rendered.allFinite()) {  // a frame that broke down has no place in it
            const bool is_first = surfaces_.empty();
            surfaces_.try_emplace(name, (frames / (name + ".glb")).string(), name, character.surface->triangles, look_,
                                  materials_);
            surfaces_.at(name).add_frame(time_s, rendered);
            if (is_first) leave_frames_out(surfaces_.at(name));
        }
    } else {
        distances_.add(frame, time_s, name, "mesh", positions);
    }
    collections_[name].emplace_back(time_s, frame_file(name, frame, ".vtu"));
}

void RunFolder::leave_frames_out(const pbs::GlbWriter& surface)
{
    const auto bytes = [&] {
        return surface.bytes(1 + (written_frames_ - 1) / glb_every_) * static_cast<double>(scene_.deformers.size());
    };
    while (bytes() > scene_.output.most_glb_bytes && glb_every_ < written_frames_ - 1) ++glb_every_;
}

void RunFolder::write_artist_skin(int frame, double time_s, const pbs::Character& character, const MotionSpec& motion,
                                  const pbs::Pose& pose)
{
    if (!has_artist_skin(character)) return;
    const pbs::RiggedModel& model = *character.artist->model;
    const pbs::Positions points =
        motion.of_model ? pbs::artist_frame(model.rig, model.body, *model.animation, sampling_of(motion), frame)
                        : pbs::artist_points(model.body, pose);
    if (skins_++ % skin_every_ == 0) {
        const std::string name = frame_file("artist", frame, ".vtp"),
                          file = (fs::path(folder_) / "skin" / name).string();
        pbs::write_vtp(file, points, model.body.triangles);
        artist_frames_.emplace_back(time_s, name);
        if (skins_ == 1)
            skin_every_ += static_cast<int>(static_cast<double>(written_frames_) *
                                            static_cast<double>(fs::file_size(file)) / scene_.output.most_skin_bytes);
    }
    const bool has_own_weights = character.weight_kind == pbs::WeightKind::artist;
    if (!has_own_weights || lbs_surface_.rows() != points.rows() || !lbs_surface_.allFinite()) return;
    // The artist's surface by the same rigid bones: scale in an animation is not an error of the tets.
    const Eigen::VectorXd distance_m = (lbs_surface_ - pbs::artist_points(model.body, pose)).rowwise().norm();
    for (const int corner : model.body.triangles.reshaped())  // some points of a file belong to no triangle
        if (followed_.frame < 0 || distance_m(corner) > followed_.largest_m)
            followed_ = {distance_m(corner), frame, corner};
}

void remove_frames(const std::string& folder)
{
    for (const fs::path& file : analysis::files_in(fs::path(folder) / "frames"))
        if (is_own_frame(file) && file.extension() != ".glb") analysis::remove_record(file);
}

void RunFolder::write_tables(bool with_moving_surfaces)
{
    const fs::path folder(folder_);
    metrics_.write((folder / "metrics.csv").string());
    frame_statistics(metrics_).write((folder / "frame_statistics.csv").string());
    if (iterations_.rows() > 0) iterations_.write((folder / "iterations.csv").string());
    regions_.table().write((folder / "regions.csv").string());
    if (distances_.table().rows() > 0) distances_.table().write((folder / "distances.csv").string());
    if (!bones_.empty()) table_of(posed_bone_columns, bones_).write((folder / "bones.csv").string());
    for (const auto& [name, frames] : collections_)
        pbs::write_pvd((folder / "frames" / (name + ".pvd")).string(), frames);
    if (!artist_frames_.empty()) pbs::write_pvd((folder / "skin" / "artist.pvd").string(), artist_frames_);
    if (with_moving_surfaces)
        for (auto& [name, surface] : surfaces_) surface.write();
}

std::string RunFolder::words_on_left_out_frames() const
{
    std::vector<std::string> words;
    if (glb_every_ > 1) words.push_back(fmt::format("the .glb files have one of {} frames", glb_every_));
    if (skin_every_ > 1) words.push_back(fmt::format("skin/ has one of {}", skin_every_));
    if (words.empty()) return "";
    return fmt::format(
        "{}: to save space, {}; those that they have are exact, and --paraview of `pbskin try` keeps all", scene_.file,
        fmt::join(words, " and "));
}

void RunFolder::write_what_frames_depend_on(const pbs::Character& character) const
{
    const fs::path folder(folder_);
    table_of(bone_columns, bones_at_rest(character.skeleton)).write((folder / "bones_rest.csv").string());
    table_of(bound_vertex_columns, bound_vertices(character)).write((folder / "binding.csv").string());
    if (character.surface)
        write_surface(*character.surface, character.mesh,
                      character.artist ? character.artist->of_joints : JointShares(), folder_);
}

void RunFolder::finish(const pbs::Character& character, const std::map<std::string, nlohmann::json>& deformer_records,
                       const nlohmann::json& outcome, CostRecord& cost, const nlohmann::json& reference_error_method)
{
    cost.time("records", [&] {
        write_tables(true);
        if (!bones_.empty()) write_what_frames_depend_on(character);
    });
    analysis::Provenance provenance =
        run_provenance(std::ranges::max(scene_.deformers, {}, &DeformerSpec::threads).threads);
    provenance.input_hashes = pbs::hashes_by_name(character.inputs);

    nlohmann::json run = {
        {"schema", run_schema}, {"scene", to_json(scene_)}, {"provenance", provenance}, {"outcome", outcome}};
    for (const auto& [name, hash] : hashes_) run["state_hash"][name] = hash.hex();
    for (const auto& [name, record] : deformer_records) run["deformers"][name] = record;
    run["character"] = cost.time("records", [&] { return character_record(character); });
    if (!reference_error_method.is_null()) run["reference_error_method"] = reference_error_method;
    run["cost"] = cost.json();
    analysis::write_text_atomically((fs::path(folder_) / "run.json").string(), analysis::record_text(run));
    if (outcome.value("interrupted", false))
        earlier_->keep_aside();
    else
        earlier_->replace();
}

}  // namespace experiments
