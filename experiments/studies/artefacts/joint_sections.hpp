// Cross-sections of a limb from one side of a joint to the other, in any pose, relative to rest.
//   const JointSections sections(character, joint);
//   sections.measure(positions, pose);            // a profile, one section per station
//   extremes_of(profile).smallest_area;           // of the narrowest section, over the same at rest
// Stations lie on the bones, up to 2 limb radii or the joint's reach away from it. Over 3 radii on each side, their planes turn evenly from
// the direction of one bone to that of the other. On the inside of a joint that is bent by an angle they meet 6 radii / angle away from it,
// so that they do not cut the limb's other half. The planes move with the bones and are the same for all deformers. Only the limb's own
// outline is measured, the one that encloses the bone. Where the skin is folded deeply into a joint, this outline may enclose both halves.
#pragma once

#include "analysis/metrics/cross_section.hpp"
#include "experiments/studies/shared/limb_joints.hpp"
#include "pbs/geometry/meshing.hpp"

namespace experiments {

struct JointSection {
    double offset_m = 0.0;                                           // from the joint in the rest pose, negative on the parent
    double area = 1.0, smallest_radius = 1.0, largest_radius = 1.0;  // over the same station's at rest
    int outlines = 0;                                                // that the plane cuts out of the whole body
    double limb_share = 1.0;  // share of the outline's length whose skin is bound to the parent or a bone below it
};
using JointProfile = std::vector<JointSection>;

struct SectionExtremesOverRest {
    double smallest_radius = 1.0, smallest_area = 1.0, largest_radius = 1.0, largest_area = 1.0;
    double limb_share_of_widest = 1.0;  // where the largest radius is
};
SectionExtremesOverRest extremes_of(const JointProfile& profile);

class JointSections {
public:
    JointSections(const pbs::Character& character, const LimbJoint& joint);

    double bend_deg(const pbs::Pose& pose) const;  // between the directions of the two bones; 0: straight

    // A station whose plane no longer meets the skin has size 0.
    JointProfile measure(const pbs::Positions& positions, const pbs::Pose& pose) const;

private:
    std::vector<pbs::CuttingPlane> planes(const pbs::Pose& pose) const;
    struct Cut {
        analysis::OutlineSize size = {};
        int outlines = 0;
        double limb_share = 1.0;
    };
    std::vector<Cut> cuts(const pbs::Positions& positions, const pbs::Pose& pose) const;

    pbs::Skeleton skeleton_;
    LimbJoint joint_;
    pbs::Triangles skin_;
    std::vector<bool> on_limb_;  // #V
    std::vector<double> offsets_m_;
    std::vector<Cut> rest_;  // of each station
};

}  // namespace experiments
