// The family of references that a comparison of deformers has to survive: nobody knows how flesh is held by its bones, nor how
// compressible it is. The members differ in the attachment (factor q of the springs, radius of the bones) and in Poisson's ratio.
//   for (const EnsembleMember& member : family()) PosedReference(character, flesh_of(reference_flesh(scene), member), pose, dt) ...
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/deformers/deformer.hpp"
#include "experiments/deformers/fem/fem_options.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace experiments {

struct EnsembleMember {
    std::string name;  // smooth, stiffer_springs, ...
    double spring_factor = 10.0, core_radius = 0.7, poisson = 0.45;
    reference_fem::Formulation formulation = reference_fem::Formulation::displacement;
};
nlohmann::json to_json(const EnsembleMember& member);

// q 10 and 100 with a core radius of 0.5 and 0.7; and, with 10 and 0.7, Poisson's ratio 0.3 and (with mean dilatation) 0.49. The first
// one, smooth, is held like the reference of the other studies (reference_flesh).
std::vector<EnsembleMember> family();

inline constexpr std::size_t further_members = 5;  // of the family, after the first one
// The place of a further member among these, by its name; `further_members` or more for any other name.
std::size_t place_among_further(const std::string& member);

const analysis::Columns<EnsembleMember>& family_member_columns();  // member, spring_factor, core_radius, poisson

// The flesh, a [[fem]] deformer, as the member holds and compresses it.
DeformerSpec flesh_of(DeformerSpec flesh, const EnsembleMember& member);

}  // namespace experiments
