// The folder of a run: metrics.csv, frame_statistics.csv, iterations.csv, regions.csv and run.json. If frames are written, it also has
// frames/, distances.csv, bones.csv, bones_rest.csv, binding.csv and, for a body with a rendered surface, surface_rest.vtp and
// embedding.csv; for a model with joints skin/. Each file is written whole or not at all. run.json comes last, so that a folder with
// run.json is a finished run.
#pragma once

#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/records/provenance.hpp"
#include "analysis/records/tables.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/character/character.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/rig/glb_writer.hpp"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace experiments {

// The bones of a run's frames and what binds the vertices to them, for programs that draw the frames: bones.csv, bones_rest.csv and
// binding.csv. The columns explain their contents.
struct BonePlace {
    std::string bone, parent;
    pbs::Vec3 head, tail;  // [m]
};
struct PosedBone {
    int frame = 0;
    double time_s = 0.0;
    BonePlace place;
};
struct BoundVertex {
    int vertex = 0;
    std::string bone;
    double parameter = 0.0, rest_distance_m = 0.0;
    bool blended = false, jiggles = false;
};

extern const analysis::Columns<BonePlace> bone_columns;            // bones_rest.csv
extern const analysis::Columns<PosedBone> posed_bone_columns;      // bones.csv: every bone in each frame that is written
extern const analysis::Columns<BoundVertex> bound_vertex_columns;  // binding.csv

std::vector<BonePlace> bones_at_rest(const pbs::Skeleton& skeleton);
void add_bones(std::vector<PosedBone>& bones, int frame, double time_s, const pbs::Skeleton& skeleton, const pbs::Pose& pose);
std::vector<BoundVertex> bound_vertices(const pbs::Character& character);

// The cost of a run: seconds of each of its parts, peak memory, loaded shared objects. Every run.json has it under `cost`.
//   CostRecord cost;
//   const pbs::Character character = cost.time("character", [&] { return pbs::make_character(source); });
//   run["cost"] = cost.json();
class CostRecord {
public:
    // Does the work and adds its time to that of the part.
    template <typename Work>
    auto time(const std::string& part, const Work& work)
    {
        const Part timed(seconds_[part], cpu_seconds_[part]);
        return work();
    }
    // The same, and adds the time to that of one deformer too, by its label.
    template <typename Work>
    auto time(const std::string& part, const std::string& label, const Work& work)
    {
        const Part of_deformer(deformers_[label][part], cpu_deformers_[label][part]);
        return time(part, work);
    }

    double seconds(const std::string& part) const;  // 0 for a part that was not timed

    // seconds: by part, `total` since construction, `deformers` by label and part. cpu_seconds: the same in processor time of all threads,
    // which other work on the machine stretches less. peak_memory_mb (10^6 bytes) and shared_objects are those of the process.
    nlohmann::json json() const;

private:
    class Part {
    public:
        Part(double& seconds, double& cpu_seconds) : seconds_(seconds), cpu_seconds_(cpu_seconds) {}
        ~Part()
        {
            seconds_ += stopwatch_.seconds();
            cpu_seconds_ += process_cpu_s() - cpu_start_s_;
        }
        Part(const Part&) = delete;
        Part& operator=(const Part&) = delete;

    private:
        double &seconds_, &cpu_seconds_;
        pbs::Stopwatch stopwatch_;
        double cpu_start_s_ = process_cpu_s();
    };

    pbs::Stopwatch stopwatch_;
    double cpu_start_s_ = process_cpu_s();
    std::map<std::string, double> seconds_, cpu_seconds_;
    std::map<std::string, std::map<std::string, double>> deformers_, cpu_deformers_;
};

// distances.csv: the distances between the points that two deformers give. One row per written frame and pair of deformers.
//   DistanceRecord record;   record.add(frame, time_s, "pbs", "mesh", positions);   record.table().write("distances.csv");
struct DeformerDistance {
    int frame = 0;
    double time_s = 0.0;
    std::string deformer, other, of;
    int points = 0;
    double rms_mm = 0.0, largest_mm = 0.0;
};
extern const analysis::Columns<DeformerDistance> distance_columns;

class DistanceRecord {
public:
    // points [m]: #P x 3, with the same #P for all deformers of a frame. of: what the points belong to.
    void add(int frame, double time_s, const std::string& label, const std::string& owner, const pbs::Positions& points);

    analysis::CsvTable table() const { return table_of(distance_columns, distances_); }

private:
    int frame_ = -1;
    std::vector<std::pair<std::string, pbs::Positions>> before_;  // of this frame
    std::vector<DeformerDistance> distances_;
};

// regions.csv: the volume that the tets of each bone and of each joint gain or lose over the frames of a run. One row per deformer and
// region.

// The bone that a region belongs to, or the two bones of a joint.
struct RegionBones {
    std::string bone, second_bone = {};
    auto operator<=>(const RegionBones&) const = default;
    std::string text() const { return second_bone.empty() ? bone : bone + " - " + second_bone; }
};

// A character's tets cut into regions, by the weights of Eq. 2 whatever weights the character is skinned with.
struct BodyRegions {
    std::string kind;  // bone, joint
    std::vector<RegionBones> bones;
    std::vector<int> of_tet;  // index into `bones`; -1: none, #T
};

// Each tet belongs to the bone that has most weight over its four corners; among equals, to the one that most corners are nearest to.
BodyRegions regions_by_bone(const pbs::Character& character);

// Each tet with a blended corner belongs to the joint of the two bones with most weight, in the order of the skeleton. Joints without
// tets are left out.
BodyRegions regions_by_joint(const pbs::Character& character);

struct RegionChange {
    std::string deformer, kind;
    RegionBones bones;
    double rest_share_pct = 0.0, change_pct = 0.0, abs_change_pct = 0.0, lowest_pct = 0.0, highest_pct = 0.0, own_change_pct = 0.0;
    int frames = 0;
};
extern const analysis::Columns<RegionChange> region_columns;

class RegionRecord {
public:
    explicit RegionRecord(const pbs::Character& character);

    // Adds one frame of a deformer. Frames that are not finite are left out.
    void add(const std::string& label, const pbs::Positions& positions);

    std::vector<RegionChange> changes() const;
    analysis::CsvTable table() const { return table_of(region_columns, changes()); }

private:
    struct Kind {
        BodyRegions regions;
        analysis::RegionMetrics region_metrics;
    };

    std::vector<Kind> kinds_;
    std::vector<std::vector<RegionChange>> sums_;  // of each deformer's frames, in order of first appearance: by kind and region
};

// The record of a rigged model for run.json and try.json: the parts that the run uses and the parts that it leaves out.

// file, joints (the bones), joints_dropped with reasons, containers, meshes, bind_pose_deg, metres_per_unit, extent_m, animations,
// animation (the one that determined the size), weights_transferred_pct (pbs::CarriedWeight). The character has a model.
nlohmann::json model_record(const pbs::Character& character);

// The rendered surface of a run's frames and the tets that carry it, for programs that move the surface with the tets:
//   surface_rest.vtp   the surface at rest [m]
//   embedding.csv      the tet that carries each of its points, with the point's barycentric coordinates
struct EmbeddedPoint {
    int point = 0, tet = 0;
    std::array<double, 4> barycentric = {};  // their sum is one; for a point outside its tet some are negative
};
extern const analysis::Columns<EmbeddedPoint> embedding_columns;

analysis::CsvTable embedding_table(const pbs::EmbeddedSurface& surface);

// Writes both files into the folder of a run.
void write_surface(const pbs::EmbeddedSurface& surface, const pbs::TetMesh& mesh, const std::string& folder);

class RunFolder {
public:
    // Removes the records of an earlier run. frames: of the motion.
    RunFolder(const Scene& scene, const pbs::Character& character, const std::string& folder, int frames);

    void add_frame(const DeformerSpec& spec, int frame, double time_s, const FrameMeasurement& measured, const pbs::StepSummary& step);
    void write_frame(const DeformerSpec& spec, int frame, double time_s, const pbs::Character& character, const pbs::Positions& positions,
                     FrameMeasurer& measurer, const std::vector<bool>& prescribed);
    // For a frame that is written.
    void write_pose(int frame, double time_s, const pbs::Skeleton& skeleton, const pbs::Pose& pose)
    {
        add_bones(bones_, frame, time_s, skeleton, pose);
        ++posed_frames_;
    }
    // skin/artist_000123.vtp: the model's surface by the skinning formula of its file, for its animation with scale and shear, for a clip
    // or a sweep with the bones' rigid pose; nothing for a model without joints.
    void write_artist_skin(int frame, double time_s, const pbs::Character& character, const MotionSpec& motion, const pbs::Pose& pose);
    // Where the surface that LBS carries with the tets is farthest from the artist's; no frame: they were not compared.
    struct FollowedSkin {
        double largest_m = 0.0;
        int frame = -1;
        Eigen::Index vertex = -1;
    };
    const FollowedSkin& followed_skin() const { return followed_; }
    // What of the model the .glb files do not show.
    const std::vector<std::string>& remarks() const { return materials_.remarks; }
    // Into the deformer's state hash and the changes of its regions.
    void add_positions(const std::string& label, const pbs::Positions& positions)
    {
        hashes_[label].add(positions);
        regions_.add(label, positions);
    }

    // All CSV files of the frames so far, and the collections: all records of an interrupted run. The moving surfaces (.glb) are large, and
    // need to be written once.
    void write_tables(bool with_moving_surfaces);

    // A sentence on the frames that are left out to stay within the sizes of OutputSpec; empty: none.
    std::string words_on_left_out_frames() const;

    // Writes the tables and, last, run.json with the cost. A method of the reference's error bar that is null is left out.
    void finish(const pbs::Character& character, const std::map<std::string, nlohmann::json>& deformer_records,
                const nlohmann::json& outcome, CostRecord& cost, const nlohmann::json& reference_error_method = nullptr);

private:
    void leave_frames_out(const pbs::GlbWriter& surface);  // which is like those of the other deformers
    void write_what_frames_depend_on(const pbs::Character& character) const;

    const Scene& scene_;
    std::string folder_;
    analysis::CsvTable metrics_, iterations_;
    std::vector<PosedBone> bones_;
    RegionRecord regions_;
    DistanceRecord distances_;
    std::map<std::string, analysis::StateHash> hashes_;
    std::map<std::string, std::vector<std::pair<double, std::string>>> collections_;  // label -> time and file of each frame, for its .pvd
    std::vector<std::pair<double, std::string>> artist_frames_;
    int written_frames_ = 0;              // of the motion, in all
    int skins_ = 0;                       // frames with an artist's surface so far
    int posed_frames_ = 0;                // that were written
    int skin_every_ = 1, glb_every_ = 1;  // every n-th frame has a file of the artist's surface, and is in the .glb files
    pbs::Positions lbs_surface_;          // of the frame that was written last
    FollowedSkin followed_;
    pbs::RigLook look_;  // of the model's surface
    pbs::RigMaterials materials_;
    std::map<std::string, pbs::GlbWriter> surfaces_;  // by label, for output.glb
};

// Removes what ParaView shows of a run's frames: all in frames/ except the .glb files.
void remove_frames(const std::string& folder);

}  // namespace experiments
