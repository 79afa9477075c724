// The folder of a run: metrics.csv, frame_statistics.csv, iterations.csv, regions.csv and run.json. If frames are written, it also has
// frames/, distances.csv, bones.csv, bones_rest.csv, binding.csv and, for a body with a rendered surface, surface_rest.vtp and
// embedding.csv; of a model's animation skin/. Each file is written whole or not at all. run.json comes last, so that a folder with
// run.json is a finished run.
#pragma once

#include "analysis/records/provenance.hpp"
#include "analysis/records/tables.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/run/run_records.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/rig/glb_writer.hpp"

#include <map>
#include <string>

namespace experiments {

class RunFolder {
public:
    // Removes the records of an earlier run.
    RunFolder(const Scene& scene, const pbs::Character& character, const std::string& folder);

    void add_frame(const DeformerSpec& spec, int frame, double time_s, const FrameMeasurement& measured, const pbs::StepSummary& step);
    void write_frame(const DeformerSpec& spec, int frame, double time_s, const pbs::Character& character, const pbs::Positions& positions,
                     const Eigen::VectorXd& volume_ratios, const std::vector<bool>& prescribed);
    void write_pose(int frame, double time_s, const pbs::Skeleton& skeleton, const pbs::Pose& pose);  // for a frame that is written
    // skin/artist_000123.vtp: the model's surface by the skinning formula of its file; nothing without an animation of a model.
    void write_artist_skin(int frame, double time_s, const pbs::Character& character, const MotionSpec& motion);
    void add_state(const DeformerSpec& spec, const pbs::Positions& positions);  // into the deformer's state hash

    void add_regions(const std::string& label, const pbs::Positions& positions) { regions_.add(label, positions); }

    void write_tables();  // all CSV files of the frames so far, and the collections; of an interrupted run, these are all records

    // Writes the tables and, last, run.json with the cost. A method of the reference's error bar that is null is left out.
    void finish(const pbs::Character& character, const std::map<std::string, nlohmann::json>& deformer_records,
                const nlohmann::json& outcome, CostRecord& cost, const nlohmann::json& reference_error_method = nullptr);

private:
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
    std::map<std::string, pbs::GlbWriter> surfaces_;  // by label, for output.glb
};

}  // namespace experiments
