// The folder of a run: metrics.csv, frame_statistics.csv, iterations.csv, regions.csv and run.json. If frames are
// written, it also has frames/, distances.csv, bones.csv, bones_rest.csv, binding.csv and, for a body with a rendered
// surface, surface_rest.vtp and embedding.csv; for a model with joints skin/. Each file is written whole or not at all.
// run.json comes last, so that a folder with run.json is a finished run.
#pragma once

#include "analysis/records/provenance.hpp"
#include "analysis/records/tables.hpp"
#include "experiments/characters/character.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/rigs/glb_writer.hpp"
#include "experiments/run/cost_record.hpp"
#include "experiments/run/drawn_frames.hpp"
#include "experiments/run/earlier_results.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/run/region_record.hpp"
#include "experiments/scene/scene.hpp"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace experiments {

// The record of a rigged model for run.json and try.json: the parts that the run uses and the parts that it leaves out.
// file, joints (the bones), joints_dropped with reasons, containers, meshes, bind_pose_deg, metres_per_unit, extent_m,
// animations, animation (the one that determined the size), weights_transferred_pct (pbs::CarriedWeight). The character
// has a model.
nlohmann::json model_record(const pbs::Character& character);

class RunFolder {
public:
    // Puts the records of an earlier run aside. frames: of the motion.
    RunFolder(const Scene& scene, const pbs::Character& character, const std::string& folder, int frames);

    void add_frame(const DeformerSpec& spec, int frame, double time_s, const FrameMeasurement& measured,
                   const pbs::StepSummary& step);
    void write_frame(const DeformerSpec& spec, int frame, double time_s, const pbs::Pose& pose,
                     const pbs::Character& character, const pbs::Positions& positions, FrameMeasurer& measurer,
                     const std::vector<bool>& prescribed);
    // Adds the pose of a frame that is written to the table of bones.
    void write_pose(int frame, double time_s, const pbs::Skeleton& skeleton, const pbs::Pose& pose)
    {
        add_bones(bones_, frame, time_s, skeleton, pose);
        ++posed_frames_;
    }
    // skin/artist_000123.vtp: the model's surface by the skinning formula of its file, for its animation with scale and
    // shear, for a clip or a sweep with the bones' rigid pose; nothing for a model without joints.
    void write_artist_skin(int frame, double time_s, const pbs::Character& character, const MotionSpec& motion,
                           const pbs::Pose& pose);
    // Where the surface that LBS carries with the tets is farthest from the artist's; no frame: they were not compared.
    struct FollowedSkin {
        double largest_m = 0.0;
        int frame = -1;
        Eigen::Index vertex = -1;
    };
    const FollowedSkin& followed_skin() const { return followed_; }
    // What the .glb files do not show of the model, a sentence each.
    const std::vector<std::string>& remarks() const { return materials_.remarks; }
    // Adds a frame's positions to the state hash of the deformer and to the changes of its regions.
    void add_positions(const std::string& label, const pbs::Positions& positions)
    {
        hashes_[label].add(positions);
        regions_.add(label, positions);
    }

    // Writes all CSV files and the collections of the frames so far, which are all records of an interrupted run. The
    // moving surfaces (.glb) are large and need to be written only once.
    void write_tables(bool with_moving_surfaces);

    std::string earlier_results() const { return earlier_->path(); }  // as EarlierResults::path
    // Keeps the earlier results aside of an interrupted run, whose tables stay.
    void keep_earlier_aside() { earlier_->keep_aside(); }

    // A sentence on the frames that are left out to stay within the sizes of OutputSpec; empty: none.
    std::string words_on_left_out_frames() const;

    // Writes the tables and, last, run.json with the cost. A method of the reference's error bar that is null is left
    // out.
    void finish(const pbs::Character& character, const std::map<std::string, nlohmann::json>& deformer_records,
                const nlohmann::json& outcome, CostRecord& cost,
                const nlohmann::json& reference_error_method = nullptr);

private:
    void leave_frames_out(const pbs::GlbWriter& surface);  // which is like those of the other deformers
    void write_what_frames_depend_on(const pbs::Character& character) const;

    const Scene& scene_;
    std::string folder_;
    std::optional<EarlierResults> earlier_;
    analysis::CsvTable metrics_, iterations_;
    std::vector<PosedBone> bones_;
    RegionRecord regions_;
    DistanceRecord distances_;
    std::map<std::string, analysis::StateHash> hashes_;
    // label -> time and file of each frame, for its .pvd
    std::map<std::string, std::vector<std::pair<double, std::string>>> collections_;
    std::vector<std::pair<double, std::string>> artist_frames_;
    int written_frames_ = 0;  // of the motion, in all
    int skins_ = 0;           // frames with an artist's surface so far
    int posed_frames_ = 0;    // that were written
    int skin_every_ = 1,
        glb_every_ = 1;           // every n-th frame has a file of the artist's surface, and is in the .glb files
    pbs::Positions lbs_surface_;  // of the frame that was written last
    FollowedSkin followed_;
    pbs::RigLook look_;  // of the model's surface
    pbs::RigMaterials materials_;
    std::map<std::string, pbs::GlbWriter> surfaces_;  // by label, for output.glb
};

// Removes what ParaView shows of a run's frames: all in frames/ except the .glb files.
void remove_frames(const std::string& folder);

}  // namespace experiments
