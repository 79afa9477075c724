// The finite element reference in one pose, with a bound on its own error.
//   const PosedReference reference(character, spec, pose, time_step_s);
//   if (reference.is_reached()) reference.error_of(positions).joint_pct <= reference.bound().joint_pct ...
//
// Several solutions, all with the same bones and contact, give the reference and the bound:
//   nested             linear and quadratic elements on the character's own tets and on these tets cut into eight
//   on other tets      quadratic elements on other tets in the same skin, which are finer where joints are bent
//   along the bones    quadratic elements on the own tets, followed along the whole way of the bones from rest
//
// Where no joint is bent, or without other tets, the reference is the finest nested solution. Its bound is that of
// analysis/statistics/grid_convergence.hpp plus the largest distance of a further mesh.
//
// Where a joint is bent, flesh can crease. The place of a crease follows the edges of the elements, so that it differs
// from mesh to mesh. A crease is resolved only by elements that are much smaller than the limb, so that nested
// solutions show no order. There the reference is the solution with the lowest energy, which approximates the
// equilibrium best in energy. Its bound is 1.25 times the largest of these distances from it: that of a solution on
// other tets, that of the solution on tets cut into eight, and that between the two equilibria on the own tets.
//
// The factor has a derivation for root mean square norms. Let e be the error of the reference, e' that of another
// solution, and c the cosine of the angle between the two. Their squared distance is |e|^2 + |e'|^2 - 2 c |e| |e'|,
// which is at least (1 - c^2) |e|^2 for every |e'|. The factor 1.25 therefore covers c up to 0.6, and every c where
// |e'| is at least 1.8 |e|. Meshes whose creases lie in the same place have nearly the same error. The largest distance
// is taken for this reason: one mesh whose crease lies elsewhere is enough. The bound of linf_m has the same factor
// without this derivation. Errors are measured outside the tips of the creases of all solutions.
//
// The equilibrium of compressed flesh is not unique. Of two equilibria on the own tets, the one with the lower energy
// counts.
#pragma once

#include "analysis/metrics/error_norms.hpp"
#include "analysis/records/tables.hpp"
#include "analysis/statistics/grid_convergence.hpp"
#include "experiments/characters/character.hpp"
#include "experiments/deformers/deformer.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_names.hpp"

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace experiments {

// The flesh that convergence, ensemble and work_precision compare with: neo-Hookean, with the Young's modulus,
// Poisson's ratio and density of the scene's first [[fem]] deformer, held by smooth springs. Its energy is infinite at
// det F <= 0, so that no quadrature point of a converged solution is inverted. pbs::InputError without a [[fem]]
// deformer.
DeformerSpec reference_flesh(const Scene& scene);

// One of the solutions.
struct NestedSolution {
    int element_order = 1;
    int refinements = 0;            // how often the tets are cut into eight: 0 or 1
    unsigned other_tets = 0;        // seed of the other tets (pbs::Remeshing); 0: the character's own tets
    double edges_per_radius = 0.0;  // of the other tets at bent joints; 0: no joint is bent
    int vertices = 0, tets = 0;     // of its mesh
    double volume_m3 = 0.0;         // of its mesh, at rest
    bool along_the_bones = false;   // from rest; otherwise from the solution with fewer nodes
    bool finished = false;
    double energy_j = 0.0;                    // of flesh, springs and contact
    std::optional<double> lowest_det_f = {};  // at the quadrature points of its elements; nothing if it did not finish
    int inverted_tets = 0;                    // of the character's own tets, by their vertices alone
    double j_min = 1.0;                       // smallest volume ratio of such a tet
    int worst_tet = -1;                       // that tet
    int newton_steps = 0;                     // on the whole path to the pose
    // The steps with a projected Hessian, because it was not positive definite or the last step met negative curvature.
    int projected = 0;
    double seconds = 0.0;  // wall time, without that of the solution with fewer nodes
    // Positions of the character's vertices [m], #V x 3. If Newton's method did not finish, they are those of its last
    // state. If the solution with fewer nodes did not finish, they are the positions of that solution.
    pbs::Positions positions = {};
    std::vector<bool> at_tips = {};  // of creases, #V; empty if it did not finish
};

// The larger value of each norm. It is not a number if one of the two is not.
analysis::ErrorNorms larger_of(const analysis::ErrorNorms& norms, const analysis::ErrorNorms& other);
// "worst tet 812 of volume ratio -0.04, 3 inverted"
std::string worst_tet_of(const NestedSolution& solution);

// Which solutions a reference has. Each value has those of the values before it, too.
enum class ReferenceEffort {
    own_tets,   // both element orders on the own tets, without a bound
    refined,    // both element orders on the own tets cut into eight
    other_tets  // quadratic elements on other tets and along the bones
};
NAMED_OPTIONS(ReferenceEffort, own_tets, refined, other_tets)

// The folder in which all studies of a results folder keep solutions: DIR/reference_solutions of a run in
// DIR/STUDY/RUN. What an interrupted run or another study has solved is not solved again. The files' names depend on
// all that is solved and on the module pbskin_fem that solves it, but not on the rest of the program.
std::string solutions_of_run(const std::string& folder);

// Smaller triangles of the skin on the inner side of each joint that a pose bends by more than 30 degrees: so many
// edges per radius of the limb within two thirds of it.
std::vector<pbs::FineBall> fine_at_bent_joints(const pbs::Character& character, const pbs::Pose& pose,
                                               double edges_per_radius);

class PosedReference {
public:
    // spec: a [[fem]] deformer with a nonlinear model and attachment smooth, embedded or held; its element order does
    // not matter. character: not refined itself. solutions: a folder in which solutions are kept and found again; "":
    // none.
    PosedReference(const pbs::Character& character, const DeformerSpec& spec, const pbs::Pose& pose, double time_step_s,
                   ReferenceEffort effort = ReferenceEffort::other_tets, const std::string& solutions = "");

    const std::string& label() const { return label_; }  // of spec
    // The reference finished with det F > 0 at all quadrature points. With other tets, where a joint is bent, it has
    // the lowest energy of all such quadratic solutions. Otherwise, or if there is none, it is the finest such solution
    // on the own or the refined tets.
    bool is_reached() const { return which_.has_value(); }
    // std::bad_optional_access if it is not reached
    const NestedSolution& reference() const { return solutions_.at(which_.value()); }
    // the finest nested one first, those that failed too
    const std::vector<NestedSolution>& solutions() const { return solutions_; }
    // Empty if the reference is reached; otherwise the worst tet of the finest solution's last state.
    std::string why_not_reached() const { return is_reached() ? "" : worst_tet_of(solutions_.front()); }

    // The vertices at the tips of creases, which are left out of all distances, #V.
    const std::vector<bool>& masked() const { return masked_; }
    double masked_share_pct() const { return error_metrics_.share_pct(masked_); }

    // Positions are those of the character's vertices [m], #V x 3. The error is the distance from the reference. Both
    // are measured outside the tips of creases, except by error_on_whole_body.
    analysis::ErrorNorms distance(const pbs::Positions& positions, const pbs::Positions& other) const;
    analysis::ErrorNorms error_of(const pbs::Positions& positions) const
    {
        return distance(positions, reference().positions);
    }
    analysis::ErrorNorms error_on_whole_body(const pbs::Positions& positions) const;

    // The observed order is empty unless the four nested solutions finished.
    const std::optional<analysis::NestedOrder>& order() const { return order_; }
    // The largest distance from the reference of a solution on other tets and, where a joint is bent, of that on tets
    // cut into eight; or of the two equilibria on the own tets; 0 without any. Not a number where one of these
    // solutions did not finish. Where the way along the bones did not, there is no second equilibrium.
    analysis::ErrorNorms spread() const { return spread_; }
    // Bounds the distance of the reference from the limit: by the order and the spread, or by the spread where a joint
    // is bent. NaN where there is no order.
    analysis::ErrorNorms bound() const;
    // The same for its quadratic solution on the own tets. NaN where there is no such bound.
    analysis::ErrorNorms bound_on_own_tets() const;

private:
    struct Level {
        const pbs::Character& character;
        int element_order;
        unsigned other_tets = 0;
        double edges_per_radius = 0.0;
        bool along_the_bones = false;
    };
    // The solutions of one call of a deformer, the finest first.
    using Solutions = std::vector<NestedSolution>;
    Solutions solved(const std::vector<Level>& levels) const;
    void add(const std::string& name, const std::vector<Level>& levels);  // solves, or finds what is kept
    Solutions kept(const std::string& file) const;                        // empty if the file is missing or damaged
    void keep(const std::string& file, const Solutions& solutions) const;
    std::string file_of(const std::string& name, const std::vector<Level>& levels) const;
    void solve_on_other_tets();
    void solve_on_tets(unsigned seed, double edges_per_radius);
    void choose_the_reference();
    NestedSolution solution_of(const TriedSolution& tried, const Level& level) const;
    void observe_order();
    void observe_spread();

    const pbs::Character& character_;
    DeformerSpec spec_;
    pbs::Pose pose_;
    double time_step_s_;
    std::string label_, kept_in_;
    analysis::ErrorMetrics error_metrics_;
    std::vector<NestedSolution> solutions_;
    std::size_t nested_ = 0;            // number of solutions on the own and the refined tets, which are the first ones
    bool creases_ = false;              // a joint is bent, and other tets show how well its crease is resolved
    std::optional<std::size_t> which_;  // the solution that is the reference
    std::vector<bool> masked_;
    std::optional<analysis::NestedOrder> order_;
    analysis::ErrorNorms spread_;
};

// The family of references that a comparison of deformers has to survive: nobody knows how flesh is held by its bones,
// nor how compressible it is. The members differ in the attachment (factor q of the springs, radius of the bones) and
// in Poisson's ratio.
//   for (const EnsembleMember& member : family())
//       PosedReference(character, flesh_of(reference_flesh(scene), member), pose, dt) ...
struct EnsembleMember {
    std::string name;  // smooth, stiffer_springs, ...
    FemAttachment attachment = FemAttachment::smooth;
    double spring_factor = 10.0, core_radius = 0.7, poisson = 0.45;
    reference_fem::Formulation formulation = reference_fem::Formulation::displacement;
};
nlohmann::json to_json(const EnsembleMember& member);

// q 10 and 100 with a core radius of 0.5 and 0.7; and, with 10 and 0.7, Poisson's ratio 0.3 and (with mean dilatation)
// 0.49; bones that are rigid capsules; and bones that hold the flesh that they alone move. The first one, smooth, is
// held like the reference of the other studies (reference_flesh).
std::vector<EnsembleMember> family();

inline constexpr std::size_t further_members = 7;  // of the family, after the first one
// The flesh, a [[fem]] deformer, as the member holds and compresses it.
DeformerSpec flesh_of(DeformerSpec flesh, const EnsembleMember& member);

}  // namespace experiments
