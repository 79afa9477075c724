// A run's directory: metrics.csv, frame_statistics.csv, iterations.csv, regions.csv, frames/ with distances.csv, bones.csv, bones_rest.csv,
// binding.csv and, where there is a rendered surface, surface_rest.vtp and embedding.csv beside, run.json. Each file is written beside and
// renamed; run.json comes last, so that a folder with run.json is a finished run.
#pragma once

#include "analysis/records/csv_table.hpp"
#include "analysis/records/state_hash.hpp"
#include "experiments/run/bone_record.hpp"
#include "experiments/run/cost_record.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/run/distance_record.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/run/region_record.hpp"

#include <map>
#include <string>

namespace experiments {

class RunFolder {
public:
    // Clears an earlier run's records.
    RunFolder(const Scene& scene, const pbs::Character& character, const std::string& folder);

    void add_frame(const DeformerSpec& spec, int frame, double time_s, const FrameMeasurement& measured, const pbs::StepSummary& step);
    void write_frame(const DeformerSpec& spec, int frame, double time_s, const pbs::Character& character, const pbs::Positions& positions,
                     const Eigen::VectorXd& volume_ratios, const std::vector<bool>& prescribed);
    void write_pose(int frame, double time_s, const pbs::Skeleton& skeleton, const pbs::Pose& pose);  // of a frame that is written
    void add_state(const DeformerSpec& spec, const pbs::Positions& positions);                        // into the deformer's state hash

    void add_regions(const std::string& label, const pbs::Positions& positions) { regions_.add(label, positions); }

    void write_tables() const;  // metrics.csv, iterations.csv, regions.csv and the collections: of an interrupted run, all there is

    // Writes the tables and, last, run.json with what all of it cost; a null method of the reference's error bar is left out.
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
    std::map<std::string, std::vector<std::pair<double, std::string>>> collections_;  // .pvd: time, file
};

}  // namespace experiments
