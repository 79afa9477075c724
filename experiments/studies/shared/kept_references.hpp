// The solved references as data: one file per pose, with the shape of the flesh for each member of the family.
//   const KeptReferences kept = read_references(pose.name, character, bones_in(pose, character.skeleton));
//   for (const KeptReference& reference : kept.members) if (reference.is_reached()) ... reference.positions ...
// The files lie in experiments/references, from where they are installed. `pbskin reproduce references --full` solves
// them.
#pragma once

#include "experiments/characters/character.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "pbs/skinning/pose.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// One member of the family in one pose: quadratic elements on the body's own tets.
struct KeptReference {
    EnsembleMember member;
    std::string outcome;  // reached, not_reached
    std::optional<double> linear_distance_pct =
        {};  // from the solution with linear elements on the same tets, in the norm of error_joint_pct
    std::optional<double> energy_j = {}, lowest_det_f = {};
    int newton_steps = 0;
    double seconds = 0.0;            // of both solutions, wall time
    pbs::Positions positions = {};   // [m], #V x 3; empty if it was not reached
    std::vector<bool> at_tips = {};  // of creases, which are left out, #V

    bool is_reached() const { return outcome == "reached"; }
    // U, an estimate of its own error in the norm of error_joint_pct [%]: this share of the distance from linear
    // elements. NaN where it is not known. README.md has the check of the share.
    double own_error_pct() const;
};
inline constexpr double share_of_linear_distance = 0.6;

struct KeptReferences {
    std::string pose, body;
    std::string mesh_hash;  // content_hash of the body's tets
    std::string revision;   // of the program that solved them
    pbs::Pose bones;
    std::vector<KeptReference> members = {};

    const KeptReference* find(const std::string& member) const;  // null: the pose was not solved with it
};

// A file of some 60 kB: the residual of each vertex from its bone's rigid motion (the first member) or from the member
// before, in multiples of kept_quantum_m, compressed.
std::string packed(const KeptReferences& references, const pbs::Character& character);
inline constexpr double kept_quantum_m = 2e-6;

// InputError for a text that is damaged, and for a character whose tets are not those of the references: it names the
// command that solves them.
KeptReferences unpacked(const std::string& text, const std::string& file, const pbs::Character& character);

// The mesher that made the tets of the record.
inline constexpr const char* cgal_of_the_record = "5.5.1";

// Why the kept references of an installed body do not belong to its tets here. The tets of a body that may not be
// redistributed are made on each system, and another version of CGAL makes others. Empty if the references belong to
// them, or if there are none of this body.
std::string why_other_tets(const std::string& body);
// InputError with this reason, and what to do.
void require_kept_tets(const std::string& body);

// The file of a pose in pbs::references_folder().
std::string file_of_references(const std::string& pose);
// InputError as unpacked; where there is no such file; and where the file has another pose, or its bones are not those
// of the pose.
KeptReferences read_references(const std::string& pose, const pbs::Character& character, const pbs::Pose& bones);

}  // namespace experiments
