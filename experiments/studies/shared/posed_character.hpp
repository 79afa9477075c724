// One character in a few poses of a scene, and the shapes that deformers give it there.
//   const PosedCharacter limb(scene, {3, 6, 9});
//   const Shapes reference = limb.shapes(spec_of(scene, "nh_p2"));
//   limb.distance(reference[0], other[0]).joint_pct;
#pragma once

#include "analysis/metrics/error_norms.hpp"
#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/solver/options.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace experiments {

// The columns of a pose that the tables of several studies share: body, motion, pose, angle_deg. It is a function,
// since columns of other files are made from it before main() begins.
const analysis::Columns<analysis::CaseKey>& pose_columns();

// The shape that linear blend skinning gives [m], #V x 3.
pbs::Positions blended(const pbs::Character& character, const pbs::Pose& pose);

// The shapes that a deformer gives a character in all frames of a motion [m], #V x 3. With memory it takes the steps
// between them, too.
std::vector<pbs::Positions> shapes_in_motion(const pbs::Character& character, const pbs::Motion& motion,
                                             const DeformerSpec& spec);

// A shape that LBS carries with the bones' motion from one pose to another [m], #V x 3: where a frame begins that
// continues the one before.
pbs::Positions carried_by_lbs(const pbs::Positions& shape, const pbs::Character& character, const pbs::Pose& from,
                              const pbs::Pose& to);

struct Shape {
    pbs::Positions positions;  // vertices [m], #V x 3
    bool finished = false;     // false: not finite or not converged; nothing is measured against it
    double seconds = 0.0;
    // in the solver's last state, if it did not finish: "worst tet 7 of volume ratio -0.1, 2 inverted"
    std::string worst_element = {};
};
using Shapes = std::vector<Shape>;  // one per pose

class PosedCharacter {
public:
    // frames: of the scene's motion, increasing.
    PosedCharacter(const Scene& scene, const std::vector<int>& frames);

    // A deformer goes from pose to pose in their order, without the frames between. One with memory starts at rest for
    // each pose, since it would take the poses for the frames of a motion. poses: only the first so many.
    Shapes shapes(const DeformerSpec& spec, std::optional<std::size_t> poses = {}) const;

    // PBS with each of these options, from the paper's LBS. All options and all poses are solved together
    // (pbs::PosesSolver).
    std::vector<Shapes> shapes(const std::vector<pbs::PbsOptions>& options) const;

    // Between two shapes, on this character's vertices, which are the first ones of a refined character; by the metrics
    // of every record. Not a number where one of them did not finish.
    analysis::ErrorNorms distance(const Shape& shape, const Shape& other) const;

    const pbs::Character& character() const { return character_; }
    // that all deformers blend with from now on
    void set_weights(pbs::Weights weights) { character_.weights = std::move(weights); }
    const pbs::Pose& pose(std::size_t pose) const { return poses_[pose]; }
    const pbs::Triangles& boundary() const { return boundary_; }            // of its tets
    double angle_deg(std::size_t pose) const { return angles_deg_[pose]; }  // of a sweep; not a number for a clip

private:
    Shape shape_of(const pbs::StepSummary& step, const pbs::Positions& positions,
                   const pbs::Positions& last_state) const;

    pbs::Character character_;
    double time_step_s_;
    std::vector<pbs::Pose> poses_;
    std::vector<double> angles_deg_;
    analysis::ErrorMetrics error_metrics_;
    pbs::Triangles boundary_;
};

// The scene's deformer of that name. pbs::InputError where there is none.
const DeformerSpec& spec_of(const Scene& scene, const std::string& name);

}  // namespace experiments
