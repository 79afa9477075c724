#include "experiments/studies/shared/posed_reference.hpp"

#include "analysis/records/provenance.hpp"
#include "analysis/records/record_files.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/characters/body_cache.hpp"
#include "experiments/characters/bone_capsules.hpp"
#include "experiments/characters/embedding.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/run/reference_error_bar.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/system/module.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

namespace experiments {

namespace fs = std::filesystem;

// The positions and the smallest det F are written apart.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(NestedSolution, element_order, refinements, other_tets, edges_per_radius, vertices,
                                   tets, volume_m3, along_the_bones, finished, energy_j, inverted_tets, j_min,
                                   worst_tet, newton_steps, projected, seconds, at_tips)

namespace {

// Each step takes about 15 s and 5 GB on tets cut into eight. In a fold without contact their number has no limit.
// Measured: 84 steps on the human standing with stiffer springs, and 119 on the limb bent by 90 degrees whose skin
// has 13.5 edges per radius.
constexpr int most_newton_steps = 200;
// Rigid capsules take 8 to 35 steps where they are reached, and in some deep flexions more than 200.
constexpr int most_newton_steps_rigid = 60;
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
constexpr analysis::ErrorNorms unknown_bound{not_known, not_known, not_known};
constexpr double analysis::ErrorNorms::*norms[] = {&analysis::ErrorNorms::l2_pct, &analysis::ErrorNorms::joint_pct,
                                                   &analysis::ErrorNorms::linf_m};

constexpr double same_energy = 1e-6;  // relative: Newton's method leaves less

// The skin is finer where a joint is bent. A crease has the edges of the character's own cells alone to form at
// otherwise. On the limb and the human, solutions with four and six edges per radius have their creases in other places
// than finer ones. These meshes are not cut into eight, which would take 50,000 vertices and 400,000 nodes of the
// human, and are solved from linear elements alone.
constexpr double least_bend_cosine = 0.866, ball_in_radii = 2.0 / 3.0;
constexpr double edges_per_radius_of_meshes[] = {9.0, 9.0, 13.5};
constexpr int meshes_without_creases = 2;
constexpr double correlated_errors = 1.25;  // see posed_reference.hpp

// Raised where this file makes something else of a solve or of its result: the options of a level, the fields of a
// solution, the vertices' places in other tets, or the tips of creases.
constexpr int kept_format = 1;

std::string text_of(const std::vector<NestedSolution>& solutions)
{
    nlohmann::json list = nlohmann::json::array();
    for (const NestedSolution& solution : solutions) {
        nlohmann::json& entry = list.emplace_back(solution);
        if (solution.lowest_det_f) entry["lowest_det_f"] = *solution.lowest_det_f;
        entry["positions"] =
            std::vector<double>(solution.positions.data(), solution.positions.data() + solution.positions.size());
    }
    // which has numbers that are not finite, too
    const std::vector<std::uint8_t> bytes = nlohmann::json::to_cbor(list);
    return {bytes.begin(), bytes.end()};
}

// Empty if the text is damaged.
std::vector<NestedSolution> solutions_in(const std::string& text)
{
    std::vector<NestedSolution> solutions;
    try {
        for (const nlohmann::json& entry : nlohmann::json::from_cbor(text)) {
            NestedSolution& solution = solutions.emplace_back(entry.get<NestedSolution>());
            if (entry.contains("lowest_det_f")) solution.lowest_det_f = entry["lowest_det_f"];
            const std::vector<double> numbers = entry.at("positions");
            solution.positions =
                Eigen::Map<const pbs::Positions>(numbers.data(), static_cast<Eigen::Index>(numbers.size()) / 3, 3);
        }
    } catch (const nlohmann::json::exception&) {
        return {};
    }
    return solutions;
}

}  // namespace

std::string solutions_of_run(const std::string& folder)
{
    return (fs::path(folder).parent_path().parent_path() / "reference_solutions").string();
}

analysis::ErrorNorms larger_of(const analysis::ErrorNorms& one, const analysis::ErrorNorms& other)
{
    analysis::ErrorNorms larger = one;
    for (const auto norm : norms)
        if (std::isnan(other.*norm) || other.*norm > one.*norm) larger.*norm = other.*norm;
    return larger;
}

std::string worst_tet_of(const NestedSolution& solution)
{
    return fmt::format("worst tet {} of volume ratio {:.3g}, {} inverted", solution.worst_tet, solution.j_min,
                       solution.inverted_tets);
}

DeformerSpec reference_flesh(const Scene& scene)
{
    const DeformerSpec* fem = find_deformer_with<FemOptions>(scene);
    if (!fem) throw pbs::InputError(scene.file, 0, "deformers.use", scene.name, "expected a [[fem]] deformer");
    DeformerSpec flesh = *fem;
    flesh.name = flesh.label = "neo_hookean";
    const auto& own = options_of<FemOptions>(*fem);
    flesh.options = FemOptions{.model = reference_fem::Model::neo_hookean,
                               .young_pa = own.young_pa,
                               .poisson = own.poisson,
                               .density_kg_m3 = own.density_kg_m3,
                               .attachment = FemAttachment::smooth,
                               .most_newton_steps = most_newton_steps};
    return flesh;
}

std::vector<pbs::FineBall> fine_at_bent_joints(const pbs::Character& character, const pbs::Pose& pose,
                                               double edges_per_radius)
{
    const std::vector<pbs::BoneCapsule> limbs = pbs::bone_capsules(character, 1.0);
    const std::vector<pbs::Bone>& bones = character.skeleton.bones;
    std::vector<pbs::FineBall> fine;
    for (std::size_t b = 0; b < bones.size(); ++b) {
        if (bones[b].parent < 0) continue;
        const pbs::Vec3 along = (bones[b].tail - bones[b].head).normalized(),
                        bent = pose[bones[b].parent].linear().transpose() * pose[b].linear() * along;
        if (along.dot(bent) > least_bend_cosine) continue;
        const double radius_m = limbs[b].radius_m;
        const pbs::Vec3 inward = (bent - along.dot(bent) * along).normalized();
        fine.push_back({bones[b].head + radius_m * inward, ball_in_radii * radius_m, radius_m / edges_per_radius});
    }
    return fine;
}

PosedReference::PosedReference(const pbs::Character& character, const DeformerSpec& spec, const pbs::Pose& pose,
                               double time_step_s, ReferenceEffort effort, const std::string& solutions)
    : character_(character),
      spec_(spec),
      pose_(pose),
      time_step_s_(time_step_s),
      label_(spec.label),
      kept_in_(solutions),
      error_metrics_(error_domain(character, {})),
      masked_(character.mesh.rest.rows(), false),
      spread_{}
{
    if (effort == ReferenceEffort::own_tets) {
        add("own", {{character, 2}, {character, 1}});
    } else {
        const pbs::Character fine = pbs::refined(character);
        add("refined", {{fine, 2}, {fine, 1}, {character, 1}});
        add("quadratic", {{character, 2}});
        std::rotate(solutions_.begin() + 1, solutions_.end() - 1, solutions_.end());  // the finest first
    }
    nested_ = solutions_.size();
    if (effort == ReferenceEffort::other_tets) solve_on_other_tets();
    choose_the_reference();
    if (!which_) return;
    if (effort != ReferenceEffort::own_tets) observe_order();
    observe_spread();
}

void PosedReference::add(const std::string& name, const std::vector<Level>& levels)
{
    const std::string file = kept_in_.empty() ? "" : file_of(name, levels);
    Solutions found = kept(file);
    if (found.empty()) {
        found = solved(levels);
        if (!file.empty()) keep(file, found);
    }
    for (NestedSolution& solution : found) {
        for (std::size_t v = 0; v < solution.at_tips.size(); ++v) masked_[v] = masked_[v] || solution.at_tips[v];
        solutions_.push_back(std::move(solution));
    }
}

PosedReference::Solutions PosedReference::kept(const std::string& file) const
{
    if (!fs::exists(file)) return {};
    const Solutions solutions = solutions_in(analysis::read_text(file));
    const auto fits = [&](const NestedSolution& solution) {
        return solution.positions.rows() == character_.mesh.rest.rows() &&
               (!solution.finished || solution.at_tips.size() == masked_.size());
    };
    return std::ranges::all_of(solutions, fits) ? solutions : Solutions{};
}

// A solution that cannot be kept is none the worse.
void PosedReference::keep(const std::string& file, const Solutions& solutions) const
{
    try {
        analysis::make_output_folder(kept_in_);
        analysis::remove_abandoned_files(kept_in_);
        analysis::write_text_atomically(file, text_of(solutions));
    } catch (const pbs::InputError& error) {
        warn({fmt::format("{}: a solution is not kept: {}", label_, error.what())});
    }
}

// By the module that solves, the settings, and all that the module reads of the characters and the pose. The program
// itself makes these and does not count.
std::string PosedReference::file_of(const std::string& name, const std::vector<Level>& levels) const
{
    static const std::string module = pbs::hash_of_file(load_module_with_blas("pbskin_fem").path());
    const std::string stated = analysis::record_text(
        {module, kept_format, to_json(spec_), time_step_s_, character_.refinements, levels.size()});
    analysis::StateHash hash;
    const auto put = [&](const auto* data, std::size_t size) { hash.add_bytes(data, size * sizeof *data); };
    const auto put_mesh = [&](const pbs::Character& character) {
        hash.add(character.mesh.rest);
        put(character.mesh.tets.data(), character.mesh.tets.size());
        put(character.binding.bone.data(), character.binding.bone.size());
        put(character.binding.distance.data(), character.binding.distance.size());
        put(character.binding.parameter.data(), character.binding.parameter.size());
        if (!character.artist || !character.artist->is_cut) return;
        const pbs::Weights& holding = character.artist->weights;  // by which bones hold flesh that is cut between parts
        put(holding.bone.data(), holding.bone.size());
        put(holding.weight.data(), holding.weight.size());
    };
    put(stated.data(), stated.size());
    put_mesh(character_);  // by which the bones' sizes and the places of its vertices in other tets are found
    for (const Level& level : levels) {
        put_mesh(level.character);
        put(&level.element_order, 1);
    }
    for (const pbs::Bone& bone : character_.skeleton.bones) {
        put(bone.head.data(), 3);
        put(bone.tail.data(), 3);
        put(&bone.parent, 1);
    }
    for (const auto& of_bone : pose_) put(of_bone.data(), of_bone.matrix().size());
    return (fs::path(kept_in_) / (name + "-" + hash.hex() + ".cbor")).string();
}

// levels: the finest first, each of which sets out from the next one.
PosedReference::Solutions PosedReference::solved(const std::vector<Level>& levels) const
{
    DeformerSpec nested = spec_;
    auto& options = options_of<FemOptions>(nested);
    options.element_order = levels.front().element_order;
    options.nested_start = !levels.front().along_the_bones;
    // mean dilatation is the same there
    if (options.element_order == 1) options.formulation = reference_fem::Formulation::displacement;
    const std::unique_ptr<Deformer> deformer = make_deformer(nested);
    deformer->reset(levels.front().character);
    TriedSolution solution{deformer.get(), deformer->advance(pose_, time_step_s_)};
    Solutions solutions;
    for (const Level& level : levels) {
        if (!solution.deformer) break;
        const TriedSolution coarser = solution.deformer->facts()->fewer_nodes;
        if (levels.size() > 1) solution.step.seconds -= coarser.step.seconds;  // which is recorded by itself
        solutions.push_back(solution_of(solution, level));
        solution = coarser;
    }
    return solutions;
}

// First along the bones on the character's own tets. The equilibrium with the lower energy there is kept among the
// nested solutions.
void PosedReference::solve_on_other_tets()
{
    add("along_the_bones", {{.character = character_, .element_order = 2, .along_the_bones = true}});
    NestedSolution &nested = solutions_[1], &alone = solutions_.back();
    if (alone.finished && (!nested.finished || alone.energy_j < (1.0 - same_energy) * nested.energy_j))
        std::swap(nested, alone);
    unsigned seed = 0;
    creases_ = !fine_at_bent_joints(character_, pose_, edges_per_radius_of_meshes[0]).empty();
    if (creases_)
        for (const double edges : edges_per_radius_of_meshes) solve_on_tets(++seed, edges);
    else
        while (seed < meshes_without_creases) solve_on_tets(++seed, 0.0);
}

void PosedReference::solve_on_tets(unsigned seed, double edges_per_radius)
{
    std::vector<pbs::FineBall> fine;
    if (edges_per_radius > 0.0) fine = fine_at_bent_joints(character_, pose_, edges_per_radius);
    std::optional<pbs::Character> other;
    try {
        other = pbs::remeshed(character_, {.seed = seed, .fine = fine});
    } catch (const pbs::InputError& error) {  // known only now, after the long solutions
        warn({fmt::format("{} on other tets: {}", label_, error.what())});
        solutions_.push_back({.element_order = 2, .other_tets = seed, .edges_per_radius = edges_per_radius});
        return;
    }
    add(fmt::format("tets_{}", seed),
        {{.character = *other, .element_order = 2, .other_tets = seed, .edges_per_radius = edges_per_radius}});
}

// The energy is compared per volume, since other tets are smaller than the skin that they fill: by 0.03 % of the limb
// and 0.2 to 0.3 % of the human. Solutions whose energies differ by less than that may be taken in the wrong order. The
// bound does not depend on it.
void PosedReference::choose_the_reference()
{
    const auto energy_density = [](const NestedSolution& solution) { return solution.energy_j / solution.volume_m3; };
    for (std::size_t i = 0; i < solutions_.size(); ++i) {
        const NestedSolution& solution = solutions_[i];
        if (!(solution.lowest_det_f > 0.0)) continue;
        const bool is_first = !which_ && i < nested_;
        const bool is_lower = creases_ && solution.element_order == 2 &&
                              (!which_ || solutions_[*which_].element_order == 1 ||
                               energy_density(solution) < energy_density(solutions_[*which_]));
        if (is_first || is_lower) which_ = i;
    }
}

NestedSolution PosedReference::solution_of(const TriedSolution& tried, const Level& level) const
{
    NestedSolution solution{.element_order = level.element_order,
                            .refinements = level.character.refinements,
                            .other_tets = level.other_tets,
                            .edges_per_radius = level.edges_per_radius,
                            .vertices = static_cast<int>(level.character.mesh.rest.rows()),
                            .tets = static_cast<int>(level.character.mesh.tets.rows()),
                            .volume_m3 = pbs::tet_volumes(level.character.mesh.rest, level.character.mesh.tets).sum(),
                            .along_the_bones = level.along_the_bones,
                            .finished = tried.step.outcome == pbs::Outcome::finished,
                            .seconds = tried.step.seconds};
    const pbs::Positions& rest = character_.mesh.rest;
    const FemFacts& facts = *tried.deformer->facts();
    if (level.other_tets == 0) {
        solution.positions = last_state(*tried.deformer).topRows(rest.rows());
    } else {
        const pbs::EmbeddedSurface in_tets = pbs::embed(rest, {}, level.character.mesh);
        std::vector<pbs::Location> places;
        for (Eigen::Index v = 0; v < rest.rows(); ++v)
            places.push_back({in_tets.tet(v), in_tets.barycentric.row(v).tail<3>().transpose()});
        solution.positions = facts.moved(places);
    }
    const nlohmann::json newton = tried.deformer->record().at("newton");
    solution.newton_steps = newton.at("newton_steps").at("most");
    solution.projected = newton.at("projected_hessians");
    const pbs::Tets& tets = character_.mesh.tets;
    const Eigen::VectorXd ratios =
        pbs::tet_volumes(solution.positions, tets).cwiseQuotient(pbs::tet_volumes(rest, tets));
    solution.j_min = ratios.minCoeff(&solution.worst_tet);
    solution.inverted_tets = static_cast<int>((ratios.array() <= 0.0).count());
    if (!solution.finished) return solution;
    solution.lowest_det_f = facts.lowest_det_f.value();
    solution.energy_j = facts.energy_j.value();
    solution.at_tips = near_tips(facts.tips, rest);
    return solution;
}

void PosedReference::observe_order()
{
    if (!std::all_of(solutions_.begin(), solutions_.begin() + nested_,
                     [](const NestedSolution& solution) { return solution.finished; }))
        return;
    constexpr std::size_t finest = 0, quadratic = 1, linear_refined = 2, linear = 3;
    const auto to_finest = [&](std::size_t solution) {
        return distance(solutions_[solution].positions, solutions_[finest].positions).joint_pct;
    };
    order_ = analysis::nested_order({to_finest(linear), to_finest(linear_refined), to_finest(quadratic)},
                                    convergence_order(options_of<FemOptions>(spec_).attachment));
}

void PosedReference::observe_spread()
{
    for (std::size_t i = nested_; i < solutions_.size(); ++i) {
        const NestedSolution& other = solutions_[i];
        const bool is_on_own_tets = other.other_tets == 0;
        if (is_on_own_tets && !other.finished) continue;
        spread_ = larger_of(spread_, !other.finished  ? unknown_bound
                                     : is_on_own_tets ? distance(other.positions, solutions_[1].positions)
                                                      : error_of(other.positions));
    }
    const NestedSolution& finest = solutions_.front();
    if (creases_) spread_ = larger_of(spread_, finest.finished ? error_of(finest.positions) : unknown_bound);
}

analysis::ErrorNorms PosedReference::bound() const
{
    if (!is_reached() || (creases_ && reference().element_order == 1)) return unknown_bound;
    if (!creases_ && !order_) return unknown_bound;
    analysis::ErrorNorms bound;
    constexpr std::size_t finest = 0, quadratic = 1;
    const analysis::ErrorNorms apart = distance(solutions_[quadratic].positions, solutions_[finest].positions),
                               to_finest = error_of(solutions_[finest].positions);
    for (const auto norm : norms)
        bound.*norm =
            creases_ ? correlated_errors * spread_.*norm : to_finest.*norm + order_->bound(apart.*norm) + spread_.*norm;
    return bound;
}

analysis::ErrorNorms PosedReference::bound_on_own_tets() const
{
    const auto quadratic = std::ranges::find_if(solutions_, [](const NestedSolution& solution) {
        return solution.element_order == 2 && solution.refinements == 0 && solution.other_tets == 0;
    });
    if (!is_reached() || quadratic == solutions_.end() || !quadratic->finished) return unknown_bound;
    analysis::ErrorNorms own = error_of(quadratic->positions);
    for (const auto norm : norms) own.*norm += bound().*norm;
    return own;
}

analysis::ErrorNorms PosedReference::error_on_whole_body(const pbs::Positions& positions) const
{
    return error_metrics_.measure(positions, reference().positions);
}

analysis::ErrorNorms PosedReference::distance(const pbs::Positions& positions, const pbs::Positions& other) const
{
    return error_metrics_.measure(positions, other, masked_);
}

std::vector<EnsembleMember> family()
{
    return {
        {.name = "smooth"},
        {.name = "stiffer_springs", .spring_factor = 100.0},
        {.name = "thinner_bones", .core_radius = 0.5},
        {.name = "stiffer_springs_thinner_bones", .spring_factor = 100.0, .core_radius = 0.5},
        {.name = "nu_0.3", .poisson = 0.3},
        {.name = "nu_0.49", .poisson = 0.49, .formulation = reference_fem::Formulation::mean_dilatation},
        {.name = "rigid_capsules", .attachment = FemAttachment::embedded, .spring_factor = 1e4, .core_radius = 0.35},
        {.name = "held_parts", .attachment = FemAttachment::held}};
}

RECORD_SETTINGS(EnsembleMember, name, attachment, spring_factor, core_radius, poisson, formulation)

DeformerSpec flesh_of(DeformerSpec flesh, const EnsembleMember& member)
{
    auto& options = options_of<FemOptions>(flesh);
    options.attachment = member.attachment;
    options.spring_factor = member.spring_factor;
    options.core_radius = member.core_radius;
    options.poisson = member.poisson;
    options.formulation = member.formulation;
    if (member.attachment == FemAttachment::embedded) options.most_newton_steps = most_newton_steps_rigid;
    return flesh;
}

}  // namespace experiments
