#include "experiments/deformers/fem/fem_deformers.hpp"

#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/skinning/weights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace experiments {

reference_fem::LinearOptions linear_options(const FemOptions& options)
{
    return {.element_order = options.element_order,
            .young_pa = options.young_pa,
            .poisson = options.poisson,
            .density_kg_m3 = options.density_kg_m3,
            .gravity_m_s2 = options.gravity_m_s2,
            .solver = options.solver,
            .formulation = options.formulation};
}

void LinearFemDeformer::reset(const pbs::Character& character)
{
    character_ = &character;
    bones_ = bone_attachment(character, options_);
    elasticity_ =
        std::make_unique<reference_fem::LinearElasticity>(character.mesh, linear_options(options_), bones_.attachment);
    frames_not_finite_ = 0;
    largest_residual_ = 0.0;
    start(elasticity_->setup().spring_tet, elasticity_->prescribed_vertices());
}

pbs::StepSummary LinearFemDeformer::advance(const pbs::Pose& pose, double)
{
    const pbs::Stopwatch stopwatch;
    const pbs::RootFrame frame(character_->skeleton, pose);
    const reference_fem::Targets held = targets_of(frame.pose());
    const reference_fem::SolveSummary solve =
        elasticity_->solve(held.springs, held.vertices, frame.from_world(options_.gravity_m_s2));
    facts_.last_state = positions_ = frame.to_world(elasticity_->positions());

    pbs::StepSummary summary;
    summary.outcome = solve.finite && positions_.allFinite() ? pbs::Outcome::finished : pbs::Outcome::not_finite;
    summary.seconds = stopwatch.seconds();
    summary.work.linear_solves = 1;

    record_frame(frame.pose());
    largest_residual_ = std::max(largest_residual_, solve.residual);
    if (solve.finite)
        record_grip(held.springs, (held.springs - elasticity_->spring_points_deformed()).rowwise().norm());
    else
        ++frames_not_finite_;
    return summary;
}

nlohmann::json LinearFemDeformer::record() const
{
    if (!elasticity_) return nullptr;
    nlohmann::json json = recorded(elasticity_->setup());
    json.update({{"frames_not_finite", frames_not_finite_}, {"largest_residual", largest_residual_}});
    return json;
}

namespace {

constexpr double largest_turn_deg = 45.0;  // of a bone in one solve
constexpr int most_indefinite_in_a_row =
    40;  // of a reference without contact: in a fold its energy falls without limit
constexpr double tip_in_limb_radii = 1.0 / 3.0;
constexpr double far_turn_deg =
    15.0;  // beyond it the solution with fewer nodes is a better initial guess than the last pose's

// The local limb radius of each bone [m], #bones.
std::vector<double> limb_radii(const pbs::Character& character)
{
    std::vector<double> radii_m;
    for (const pbs::BoneCapsule& limb : pbs::bone_capsules(character, 1.0)) radii_m.push_back(limb.radius_m);
    return radii_m;
}

reference_fem::ContactOptions contact_options(const FemOptions& options, const std::vector<double>& limb_radius_m)
{
    if (!options.has_contact()) return {};
    const double mean_m =
        std::accumulate(limb_radius_m.begin(), limb_radius_m.end(), 0.0) / static_cast<double>(limb_radius_m.size());
    return {.range_m = options.contact_range * mean_m, .stiffness_pa = options.contact_stiffness * options.young_pa};
}

reference_fem::ElasticOptions solver_options(const FemOptions& options, const std::vector<double>& limb_radius_m)
{
    reference_fem::ElasticOptions elastic{.model = options.model,
                                          .element_order = options.element_order,
                                          .formulation = options.formulation,
                                          .young_pa = options.young_pa,
                                          .poisson = options.poisson,
                                          .density_kg_m3 = options.density_kg_m3,
                                          .dynamics = options.dynamics,
                                          .rayleigh_mass_1_s = options.rayleigh_mass_1_s,
                                          .rayleigh_stiffness_s = options.rayleigh_stiffness_s,
                                          .contact = contact_options(options, limb_radius_m),
                                          .solver = options.solver,
                                          .path = {.most_newton_steps = options.most_newton_steps}};
    if (options.dynamics == reference_fem::Dynamics::quasi_static) elastic.newton.reuse_contraction = 0.1;
    if (options.most_newton_steps == 0) return elastic;
    // Quadratic elements start at the solution of linear ones, so that there is no way to halve where they need many
    // steps.
    const bool has_no_way = options.nested_start && options.element_order == 2;
    elastic.newton.iterations =
        has_no_way ? options.most_newton_steps : std::min(elastic.newton.iterations, options.most_newton_steps);
    if (!options.has_contact()) elastic.newton.indefinite_in_a_row = most_indefinite_in_a_row;
    return elastic;
}

pbs::Pose placed(pbs::Pose pose, const Eigen::Isometry3d& place)
{
    for (Eigen::Isometry3d& bone : pose) bone = place * bone;
    return pose;
}

// A step of order 1 takes less than a tenth of the time of one of order 2, so that more of them are allowed.
FemOptions with_order_1(FemOptions options)
{
    options.element_order = 1;
    options.most_newton_steps *= 4;
    if (options.formulation == reference_fem::Formulation::mean_dilatation)  // equal to it on order 1
        options.formulation = reference_fem::Formulation::displacement;
    return options;
}

bool was_given_up(const FrameSolve& solve)
{
    return !solve.stages.empty() && !solve.stages.back().steps.empty() &&
           solve.stages.back().steps.back().newton.outcome == reference_fem::NewtonOutcome::given_up;
}

pbs::Pose rest_pose(const pbs::Skeleton& skeleton)
{
    return pbs::Pose(skeleton.bones.size(), Eigen::Isometry3d::Identity());
}

}  // namespace

void ElasticFemDeformer::reset(const pbs::Character& character)
{
    character_ = &character;
    bones_ = bone_attachment(character, options_);
    limb_radius_m_ = limb_radii(character);
    body_ = std::make_unique<reference_fem::ElasticBody>(character.mesh, solver_options(options_, limb_radius_m_),
                                                         bones_.attachment);
    guide_weights_ = {};
    if (options_.attachment != FemAttachment::bind)
        guide_weights_ = pbs::harmonic_weights(character.mesh,
                                               gripping_bones(bones_, character.mesh.tets, body_->setup().spring_tet),
                                               static_cast<int>(character.skeleton.bones.size()));
    reached_pose_ = rest_pose(character.skeleton);
    fewer_nodes_.reset();
    if (options_.nested_start && (options_.element_order == 2 || character.refinements > 0)) {
        const bool same_tets = options_.element_order == 2;
        fewer_nodes_ = std::make_unique<ElasticFemDeformer>(same_tets ? with_order_1(options_) : options_);
        fewer_nodes_->reset(same_tets ? character : *character.unrefined);
    }
    unspent_s_ = 0.0;
    frame_.reset();
    start_ = {};
    is_started_ = false;
    failures_in_a_row_ = 0;
    frames_in_contact_ = most_contact_pairs_ = 0;
    smallest_gap_m_ = std::numeric_limits<double>::infinity();
    newton_record_ = NewtonRecord(pbs::tet_volumes(character.mesh.rest, character.mesh.tets).sum());
    has_tried_ = true;
    start(body_->setup().spring_tet, body_->prescribed_vertices());
    facts_.moved = [this](const std::vector<pbs::Location>& places) { return in_the_world(body_->moved(places)); };
}

pbs::Positions ElasticFemDeformer::in_the_world(const pbs::Positions& points) const
{
    return has_memory() || !frame_ ? points : frame_->to_world(points);
}

void ElasticFemDeformer::continue_from(const pbs::Pose& pose, const pbs::Positions& positions)
{
    if (has_memory()) return;
    const pbs::RootFrame frame(character_->skeleton, pose);
    body_->start_from(frame.to_root(positions));
    reached_pose_ = frame.pose();
    is_started_ = true;
    failures_in_a_row_ = 0;
}

void ElasticFemDeformer::give_up_when(std::function<bool()> is_over)
{
    if (fewer_nodes_) fewer_nodes_->give_up_when(is_over);
    body_->give_up_when(std::move(is_over));
}

// The flesh between two places that press on each other has a tip where they are at most the limb's radius apart at
// rest.
void ElasticFemDeformer::find_tips()
{
    facts_.tips.clear();
    const std::vector<reference_fem::PressedPair> pressed = body_->pressed();
    pbs::Positions middles(static_cast<Eigen::Index>(pressed.size()), 3);
    for (std::size_t p = 0; p < pressed.size(); ++p) middles.row(p) = pressed[p].middle.transpose();
    const pbs::BoneBinding nearest = pbs::bind_to_nearest_bone(middles, character_->skeleton);
    for (std::size_t p = 0; p < pressed.size(); ++p)
        if (const double radius_m = limb_radius_m_[nearest.bone[p]]; pressed[p].apart_m <= radius_m)
            facts_.tips.push_back({pressed[p].middle, tip_in_limb_radii * radius_m});
}

pbs::StepSummary ElasticFemDeformer::advance(const pbs::Pose& pose, double dt_s)
{
    const pbs::Stopwatch stopwatch;
    const pbs::RootFrame& frame = frame_.emplace(character_->skeleton, pose);
    FrameSolve solve;
    facts_.fewer_nodes = {};
    if (has_memory())
        solve = is_started_ ? move(pose, dt_s) : start_at(frame);
    else if (start_.rows() > 0)
        solve = settle_from_start(frame);
    else if (!settle_from_fewer_nodes(pose, frame, solve) && may_go_the_way(solve))
        solve = settle(frame);
    has_tried_ = !solve.stages.empty();
    positions_ = in_the_world(body_->positions());
    facts_.last_state = solve.converged() ? positions_ : in_the_world(last_iterate_at(character_->mesh.rest));
    facts_.energy_j.reset();
    if (solve.converged() && !has_memory()) facts_.energy_j = body_->potential_energy_j();
    find_tips();
    is_started_ = true;
    pbs::StepSummary summary;
    summary.outcome = solve.converged() ? pbs::Outcome::finished : pbs::Outcome::not_converged;
    for (const auto& stage : solve.stages) {
        summary.iterations += stage.newton_steps();
        summary.work += stage.work();
    }
    if (facts_.fewer_nodes.deformer) summary.work += facts_.fewer_nodes.step.work;
    summary.seconds = stopwatch.seconds();

    record_frame(frame.pose());
    record_solve(solve);
    return summary;
}

void ElasticFemDeformer::record_solve(const FrameSolve& solve)
{
    const reference_fem::Jacobians jacobians = body_->jacobians();
    facts_.lowest_det_f = jacobians.lowest;
    if (!has_tried_) {
        newton_record_.add_frame_without_start(fewer_nodes_->newton_record_.last_failure());
        return;
    }
    newton_record_.add_frame(solve, solve.converged() ? jacobians : body_->jacobians_of_last_iterate());
    if (!solve.converged()) return;
    if (const reference_fem::ContactState contact = body_->contact(); contact.pairs > 0) {
        ++frames_in_contact_;
        most_contact_pairs_ = std::max(most_contact_pairs_, contact.pairs);
        smallest_gap_m_ = std::min(smallest_gap_m_, contact.smallest_distance_m);
    }
    const reference_fem::Targets held = targets_of(reached_pose_);
    if (held.springs.rows() > 0)
        record_grip(held.springs, (held.springs - body_->spring_points_deformed()).rowwise().norm());
    if (options_.attachment == FemAttachment::bind)
        record_grip(held.bind_points,
                    (body_->positions() - held.bind_points).rowwise().norm() - bones_.attachment.bind_distance);
}

// Where Newton's method was not tried with these nodes, the state is the last one with fewer nodes.
pbs::Positions ElasticFemDeformer::last_iterate_at(const pbs::Positions& points_at_rest) const
{
    if (!has_tried_) return fewer_nodes_->last_iterate_at(points_at_rest);
    return body_->moved_in_last_iterate(body_->places_of(points_at_rest));
}

// Solves for equilibria along a path of poses, each placed in the world.
void ElasticFemDeformer::follow(const pbs::PosePath& way, const Eigen::Isometry3d& place, const pbs::Vec3& gravity_m_s2,
                                FrameSolve& solve)
{
    const pbs::Positions& rest = character_->mesh.rest;
    const int stages = std::max(1, static_cast<int>(std::ceil(way.largest_turn_deg() / largest_turn_deg)));
    for (int stage = 0; stage < stages; ++stage) {
        const auto on_the_way = [&](double fraction) { return (stage + fraction) / stages; };
        const pbs::Pose from = placed(way.at(on_the_way(0.0)), place);
        const pbs::Positions before =
            rest + Eigen::Map<const pbs::Positions>(body_->displacement().data(), rest.rows(), 3);
        const auto targets_at = [&](double fraction) {
            pbs::Pose pose = placed(way.at(on_the_way(fraction)), place);
            reference_fem::Targets held = targets_of(pose);
            if (options_.attachment == FemAttachment::bind) return held;
            // the motion of each bone
            for (std::size_t j = 0; j < pose.size(); ++j) pose[j] = pose[j] * from[j].inverse();
            pbs::dual_quaternion_skinning(before, guide_weights_, pose, held.guide);
            return held;
        };
        solve.stages.push_back(body_->solve(targets_at, gravity_m_s2));
        solve.reached = on_the_way(solve.stages.back().reached);
        if (!solve.stages.back().converged()) break;
    }
    reached_pose_ = placed(way.at(solve.reached), place);
}

// With a limit on Newton's steps, a body whose solution with fewer nodes was not reached is not reached either: it
// would take longer.
bool ElasticFemDeformer::may_go_the_way(const FrameSolve& solve) const
{
    if (options_.most_newton_steps == 0) return true;
    const bool has_spent_its_steps = !solve.stages.empty() && solve.stages.back().steps.back().newton.outcome ==
                                                                  reference_fem::NewtonOutcome::iterations_exhausted;
    const bool fewer_nodes_failed =
        facts_.fewer_nodes.deformer && facts_.fewer_nodes.step.outcome != pbs::Outcome::finished;
    return !has_spent_its_steps && !fewer_nodes_failed;
}

// Where this fails, the body returns to where it was.
bool ElasticFemDeformer::settle_from_fewer_nodes(const pbs::Pose& pose, const pbs::RootFrame& frame, FrameSolve& solve)
{
    if (!fewer_nodes_) return false;
    const pbs::PosePath from_last_pose(character_->skeleton, reached_pose_, frame.pose());
    if (is_started_ && from_last_pose.largest_turn_deg() <= far_turn_deg) return false;
    facts_.fewer_nodes = {fewer_nodes_.get(), fewer_nodes_->advance(pose, 0.0)};
    if (facts_.fewer_nodes.step.outcome != pbs::Outcome::finished) return false;
    const pbs::Positions& rest = body_->nodes_at_rest();
    const pbs::Positions before = rest + Eigen::Map<const pbs::Positions>(body_->displacement().data(), rest.rows(), 3);
    body_->start_from_nodes(fewer_nodes_->body_->moved(fewer_nodes_->body_->places_of(rest)));
    solve.stages.push_back(body_->solve_here(targets_of(frame.pose()), frame.from_world(options_.gravity_m_s2)));
    solve.reached = solve.stages.back().reached;
    if (!solve.converged()) {
        body_->start_from_nodes(before);
        return false;
    }
    reached_pose_ = frame.pose();
    failures_in_a_row_ = 0;
    return true;
}

FrameSolve ElasticFemDeformer::settle(const pbs::RootFrame& frame)
{
    const pbs::Skeleton& skeleton = character_->skeleton;
    const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();
    const pbs::Vec3 gravity_m_s2 = frame.from_world(options_.gravity_m_s2);
    FrameSolve solve;
    follow(pbs::PosePath(skeleton, reached_pose_, frame.pose()), here, gravity_m_s2, solve);
    if (was_given_up(solve)) return solve;
    failures_in_a_row_ = solve.converged() ? 0 : failures_in_a_row_ + 1;
    if (failures_in_a_row_ != 2) return solve;

    solve.restarted = true;
    body_->start_from(character_->mesh.rest);
    follow(pbs::PosePath(skeleton, rest_pose(skeleton), frame.pose()), here, gravity_m_s2, solve);
    if (solve.converged()) failures_in_a_row_ = 0;
    return solve;
}

FrameSolve ElasticFemDeformer::settle_from_start(const pbs::RootFrame& frame)
{
    body_->start_from(frame.to_root(start_));
    start_ = {};
    const reference_fem::NewtonSummary newton =
        body_->solve_at_once(targets_of(frame.pose()), frame.from_world(options_.gravity_m_s2));
    reached_pose_ = frame.pose();
    failures_in_a_row_ = 0;
    if (newton.outcome == reference_fem::NewtonOutcome::intersects_itself) {
        body_->start_from(character_->mesh.rest);
        reached_pose_ = rest_pose(character_->skeleton);
    }
    const double reached = newton.converged() ? 1.0 : 0.0;
    return {{{reached, {{1.0, newton}}, newton.seconds}}, reached};
}

FrameSolve ElasticFemDeformer::start_at(const pbs::RootFrame& frame)
{
    FrameSolve solve;
    body_->start_from(frame.to_world(character_->mesh.rest));
    follow(pbs::PosePath(character_->skeleton, rest_pose(character_->skeleton), frame.pose()), frame.root(),
           options_.gravity_m_s2, solve);
    return solve;
}

FrameSolve ElasticFemDeformer::move(const pbs::Pose& pose, double dt_s)
{
    const pbs::PosePath way(character_->skeleton, reached_pose_, pose);
    unspent_s_ += dt_s;
    FrameSolve solve;
    const auto targets_at = [&](double fraction) { return targets_of(way.at(fraction)); };
    solve.stages.push_back(body_->advance(targets_at, options_.gravity_m_s2, unspent_s_));
    if (!solve.stages.back().converged()) return solve;
    solve.reached = 1.0;
    reached_pose_ = pose;
    unspent_s_ = 0.0;
    return solve;
}

nlohmann::json ElasticFemDeformer::record() const
{
    if (!body_) return nullptr;
    nlohmann::json json = recorded(body_->setup());
    json["newton"] = newton_record_.to_json();
    if (!options_.has_contact()) return json;
    const reference_fem::ContactOptions contact = contact_options(options_, limb_radius_m_);
    json["contact"] = {{"range_m", contact.range_m},
                       {"stiffness_pa", contact.stiffness_pa},
                       {"frames", frames_in_contact_},
                       {"most_pairs", most_contact_pairs_},
                       {"smallest_distance_m", frames_in_contact_ > 0 ? nlohmann::json(smallest_gap_m_) : nullptr}};
    return json;
}

}  // namespace experiments

experiments::Deformer* pbskin_make_fem(const experiments::FemOptions& options)
{
    const bool linear =
        options.model == reference_fem::Model::linear && options.dynamics == reference_fem::Dynamics::quasi_static;
    if (linear) return new experiments::LinearFemDeformer(options);
    return new experiments::ElasticFemDeformer(options);
}
