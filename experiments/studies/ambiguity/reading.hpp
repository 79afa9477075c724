// The places where the paper can be read in more than one way, and what it leaves unstated. Each reading is a set of options of the same
// solver and of what surrounds it. Reading A of a place is the baseline that a reading names, and B is the reading itself.
//   for (const Reading& reading : readings_of_a_step(scene_options)) ...
// Substeps are no reading where nothing jiggles: every step then begins with LBS, and the step before has no influence.
#pragma once

#include "analysis/verdicts/case_record.hpp"
#include "experiments/deformers/deformer.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_names.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/options.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace experiments {

enum class BindPoint { carried, reprojected };  // a material point of the bone; or the LBS position projected on the posed bone, each step
template <>
inline constexpr NameTable<BindPoint, 2> option_names<BindPoint>{
    {{BindPoint::carried, "carried"}, {BindPoint::reprojected, "reprojected"}}};
enum class BlendedBones { nearest_end, either_end };  // Eq. 2's n_joints
template <>
inline constexpr NameTable<BlendedBones, 2> option_names<BlendedBones>{
    {{BlendedBones::nearest_end, "nearest_end"}, {BlendedBones::either_end, "either_end"}}};
enum class ZoneMean { of_all, of_bone };  // whose mean distance a jiggling vertex exceeds
template <>
inline constexpr NameTable<ZoneMean, 2> option_names<ZoneMean>{{{ZoneMean::of_all, "of_all"}, {ZoneMean::of_bone, "of_bone"}}};

struct Reading {
    std::string place;  // of the paper, an identifier: title_of_place; empty: a baseline
    std::string name;   // of the reading, an identifier
    std::string baseline;
    pbs::PbsOptions options;
    BindPoint bind_point = BindPoint::carried;
    BlendedBones blended_bones = BlendedBones::nearest_end;
    ZoneMean zone_mean = ZoneMean::of_all;
    int substeps = 1;  // of each time step
};

nlohmann::json to_json(const Reading& reading);  // whatever its motion depends on
bool has_memory(const Reading& reading);         // its steps depend on the last one

// Why a reading cannot change a claim, from how the claim's values are measured and not from the results; empty where it can.
std::string untouched_because(const std::string& claim, const Reading& reading, const Reading& baseline);

inline constexpr const char* own_reading = "as_the_scene";  // baselines
inline constexpr const char* jiggling_reading = "jiggling_0.9";

std::string title_of_place(const std::string& place);  // for readers: "Eq. 2: n_joints"

// Readings of a single step, in which nothing jiggles; the baseline comes first.
std::vector<Reading> readings_of_a_step(const pbs::PbsOptions& own);
// Readings of steps that depend on the last one, since particles are integrated; both baselines come first.
std::vector<Reading> readings_of_motion(const pbs::PbsOptions& own);

// Position based skinning by one reading of the paper as a deformer, so that whatever a study measures of a deformer can be measured of a
// reading; and a character that is moved by it through the frames of a scene.
//   ReadDeformer deformer(reading);
//   deformer.reset(character);
//   deformer.advance(pose, dt_s);   // one of the reading's substeps
//   const ReadMotion moved = move(character, scene, reading);
pbs::Weights weights_of(const pbs::Character& character, const Reading& reading);

// Posed q_i [m], #V x 3.
pbs::Positions bind_points_of(const pbs::Character& character, const Reading& reading, const pbs::Pose& pose, const pbs::Positions& lbs);

class ReadDeformer final : public Deformer {
public:
    explicit ReadDeformer(const Reading& reading) : reading_(reading) {}

    void reset(const pbs::Character& character) override;
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) override;
    const pbs::Positions& positions() const override { return solver_->positions(); }
    bool has_memory() const override { return experiments::has_memory(reading_); }

    const pbs::Positions& lbs() const { return lbs_; }  // of the last step [m], #V x 3

private:
    Reading reading_;
    const pbs::Character* character_ = nullptr;
    std::optional<pbs::BlendSkinning<double>> skinning_;
    std::unique_ptr<pbs::PbsSolver> solver_;
    pbs::Positions lbs_;
};

struct ReadMotion {
    analysis::CaseRecord pbs, lbs;       // volume, from which a verdict is computed
    std::vector<pbs::Positions> shapes;  // of PBS, one per frame [m], #V x 3
    bool finite = true;
};

ReadMotion move(const pbs::Character& character, const Scene& scene, const Reading& reading);

}  // namespace experiments
