// Another program's solution of the same problems, node by node. CalculiX's elements C3D4 and C3D10 are P1 and P2, so
// both programs solve one and the same system, and what differs is rounding or an error of one of them. CalculiX solved
// a cantilever under its weight and an end load, and the limb, whose bones (####) hold whole tets or, by the smooth
// attachment, springs, with the forearm bent or twisted:
//
//   #|=====================| |     (---####---.---####---)
//   #|=====================| v
//
// Its displacements are kept. experiments/references/keep_calculix.py sets the problems up a second time, solves and
// keeps them.

#include "analysis/records/record_files.hpp"
#include "experiments/characters/body_cache.hpp"
#include "experiments/studies/verification/problem.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"
#include "reference_fem/linear_elasticity.hpp"
#include "reference_fem/linear_flesh.hpp"
#include "reference_fem/linear_solvers.hpp"
#include "reference_fem/verification/problems.hpp"

#include <fmt/format.h>

#include <cstring>
#include <map>

namespace experiments {

using namespace reference_fem;

namespace {

// The condition number of the cantilever on the finest mesh, from its first bending mode (12.4 E I / L^3 over a third
// of its 16,393 nodes) against the stiffness of one edge (5 E h), is 2e7; sqrt(n) eps cond(K) = 5e-7. CalculiX stops
// Newton at 1e-9 of the mean force.
constexpr double largest_difference = 1e-6;
const std::string largest_difference_from =
    "rounding of a direct solve: sqrt(n) eps cond(K), cond(K) = 2e7 from the slowest mode of the longest cantilever";

// At which residual, relative to the mean force, CalculiX stopped Newton's method where springs hold the flesh; and the
// reference's.
constexpr double calculix_residual = 1e-12;
const NewtonOptions calculix_newton{.relative_tolerance = 1e-11};

struct CalculixAnswer {
    pbs::Positions displacements;  // [m], #nodes x 3
    std::string program;           // with its version
};

pbs::Positions at_nodes(const Eigen::VectorXd& dofs)
{
    return Eigen::Map<const pbs::Positions>(dofs.data(), dofs.size() / 3, 3);
}

// The node of each kept row: the vertices, then the middles of edges, sorted by the vertices at their ends.
std::vector<int> kept_order(const SimplexSpace& space)
{
    std::map<std::pair<int, int>, int> middles;
    if (space.element_order() == 2)
        for (const auto& tet : space.tet_nodes().rowwise())
            for (int k = 0; k < 6; ++k) {
                const int* const ends = SimplexSpace::edge_corners[k];
                middles[std::minmax({tet(ends[0]), tet(ends[1])})] = tet(4 + k);
            }
    std::vector<int> order;
    for (int v = 0; v < space.nodes() - static_cast<int>(middles.size()); ++v) order.push_back(v);
    for (const auto& [ends, node] : middles) order.push_back(node);
    return order;
}

CalculixAnswer calculix_answer(const std::string& problem, const SimplexSpace& space)
{
    const std::string folder = analysis::path_in(pbs::references_folder(), "calculix");
    const std::string file = analysis::path_in(folder, problem + ".f64"), bytes = pbs::read_text_file(file);
    const analysis::CsvTable answers = analysis::read_csv(analysis::path_in(folder, "answers.csv"));
    int row = 0;
    while (row < answers.rows() && answers.text_at(row, "problem") != problem) ++row;
    if (row == answers.rows() || answers.text_at(row, "content_hash") != pbs::content_hash(bytes))
        throw pbs::InputError(file, 0, "", "", "damaged: expected the hash that answers.csv states");
    const std::size_t expected = sizeof(double) * static_cast<std::size_t>(space.dofs());
    if (bytes.size() != expected)
        throw pbs::InputError(file, 0, "bytes", std::to_string(bytes.size()),
                              fmt::format("expected {}: {} nodes x 3 numbers of 8 bytes", expected, space.nodes()));
    pbs::Positions kept(space.nodes(), 3);
    std::memcpy(kept.data(), bytes.data(), bytes.size());
    CalculixAnswer answer{kept, answers.text_at(row, "program")};
    const std::vector<int> order = kept_order(space);
    for (std::size_t n = 0; n < order.size(); ++n)
        answer.displacements.row(order[n]) = kept.row(static_cast<Eigen::Index>(n));
    return answer;
}

// The largest difference of a node's displacement over the largest displacement.
double relative_difference(const pbs::Positions& ours, const pbs::Positions& theirs)
{
    if (!ours.allFinite()) return not_reached;
    return (theirs - ours).rowwise().norm().maxCoeff() / ours.rowwise().norm().maxCoeff();
}

VerificationRow calculix_row(const std::string& problem, const std::string& pose, const std::string& law,
                             const SimplexSpace& space, const pbs::Positions& displacements)
{
    const CalculixAnswer answer = calculix_answer(problem, space);
    VerificationRow row = row_about(
        {"calculix", elements_of(space.element_order()), material_of(law, calculix_flesh.poisson), "", 0.0,
         space.dofs()},
        {"largest_node_difference", "largest node difference over largest displacement, " + pose, identifier_of(pose)},
        relative_difference(displacements, answer.displacements), 0.0, "1",
        answer.program + (space.element_order() == 1 ? ", C3D4" : ", C3D10"));
    bound(row, {}, largest_difference, largest_difference_from);
    return row;
}

// Nodes at the lowest x are held; the nodes at the highest x share the end load equally.
VerificationRow cantilever_row(const Effort& effort, int element_order)
{
    const Divisions divisions = {48, 6, 6};
    constexpr double length_m = 10.0;
    const pbs::Vec3 weight_n_m3 = 1000.0 * pbs::Vec3(0.0, 1e-3, -1e-2), end_load_n(0.3, 0.0, -0.5);
    const SimplexSpace space(box_mesh({0, 0, 0}, {length_m, 1, 1}, divisions), element_order);
    const auto x = space.node_positions().col(0).array();
    const auto loaded_nodes = static_cast<double>((x == length_m).count());
    Eigen::VectorXd load = load_vector(space, [&](const pbs::Vec3&) { return weight_n_m3; });
    std::vector<bool> held(space.dofs());
    for (int node = 0; node < space.nodes(); ++node) {
        if (x(node) == length_m) load.segment<3>(3 * node) += end_load_n / loaded_nodes;
        for (int c = 0; c < 3; ++c) held[3 * node + c] = x(node) == 0.0;
    }
    const ElasticMaterial material = solver_material(effort, calculix_flesh);
    const EliminatedSystem system(stiffness_matrix(space, lame_parameters(material.young_pa, material.poisson)), held,
                                  LinearSolver::cholmod);
    const Eigen::VectorXd displacement = system.solve(load, Eigen::VectorXd::Zero(space.dofs())).displacement;
    VerificationRow row = calculix_row(fmt::format("cantilever_p{}", element_order), "cantilever", "linear", space,
                                       at_nodes(displacement));
    row.mesh = text_of(divisions);
    row.h_m = 1.0 / divisions[1];
    return row;
}

Eigen::VectorXd by_linear_elasticity(const pbs::TetMesh& mesh, const HeldBody& body)
{
    const LinearOptions options{
        .element_order = body.element_order, .young_pa = body.material.young_pa, .poisson = body.material.poisson};
    LinearElasticity elasticity(mesh, options, body.attachment);
    const Targets targets = body.targets_at(1.0);
    elasticity.solve(targets.springs, targets.vertices);
    return elasticity.displacement();
}

Eigen::VectorXd by_elastic_body(const pbs::TetMesh& mesh, const HeldBody& body)
{
    ElasticOptions options;
    options.model = Model::st_venant_kirchhoff;
    options.element_order = body.element_order;
    options.young_pa = body.material.young_pa;
    options.poisson = body.material.poisson;
    options.newton = calculix_newton;
    ElasticBody elastic(mesh, options, body.attachment);
    const bool converged = elastic.solve(body.targets_at, pbs::Vec3::Zero()).converged();
    return converged ? elastic.displacement() : Eigen::VectorXd::Constant(elastic.displacement().size(), not_reached);
}

// The four points of C3D10, exact to degree 2: A. Stroud, Approximate Calculation of Multiple Integrals, 1971, T3: 2-1.
TetQuadrature four_points()
{
    const double near = (5.0 + 3.0 * std::sqrt(5.0)) / 20.0, far = (5.0 - std::sqrt(5.0)) / 20.0;
    TetQuadrature quadrature{pbs::Positions::Constant(4, 3, far), Eigen::VectorXd::Constant(4, 1.0 / 24.0)};
    for (int point = 1; point < 4; ++point) quadrature.points(point, point - 1) = near;
    return quadrature;
}

std::vector<bool> held_dofs(const SimplexSpace& space, const HeldBody& body)
{
    std::vector<bool> held(space.dofs());
    for (const int tet : body.attachment.prescribed_tets)
        for (const int node : space.tet_nodes().row(tet))
            for (int c = 0; c < 3; ++c) held[3 * node + c] = true;
    return held;
}

Eigen::VectorXd by_four_points(const pbs::TetMesh& mesh, const HeldBody& body)
{
    const SimplexSpace space(mesh, body.element_order);
    const ElasticPotential flesh(space, Model::st_venant_kirchhoff,
                                 lame_parameters(body.material.young_pa, body.material.poisson),
                                 Formulation::displacement, element_tables(space, four_points()));
    const AttachedPoints points(mesh, space, body.attachment.spring_points, body.attachment.spring_stiffness);
    SpringPotential springs(points);
    NewtonMinimiser newton(space, held_dofs(space, body), LinearSolver::cholmod);
    Eigen::VectorXd displacement = Eigen::VectorXd::Zero(space.dofs());
    const auto attempt = [&](double fraction) {
        const Targets targets = body.targets_at(fraction);
        springs.move_to(targets.springs);
        const pbs::Positions held_at = space.from_vertices(targets.vertices - mesh.rest);
        return newton.minimise({&flesh, &springs}, Eigen::Map<const Eigen::VectorXd>(held_at.data(), held_at.size()),
                               displacement, calculix_newton);
    };
    const bool converged = follow_load_path(attempt, displacement, {}).converged();
    return converged ? displacement : Eigen::VectorXd::Constant(space.dofs(), not_reached);
}

pbs::Positions displacements_of(const pbs::TetMesh& mesh, const HeldBody& body)
{
    const auto solve_by = body.model == BodyModel::linear                ? by_linear_elasticity
                          : body.model == BodyModel::st_venant_kirchhoff ? by_elastic_body
                                                                         : by_four_points;
    return at_nodes(solve_by(mesh, body));
}

// How far the two programs' answers may differ at a node, relative to the largest displacement: an error of forces
// relative to |K| |u|, times cond(K), which turns it into one of displacements, times |u| over the largest
// displacement. Norms are 2-norms, and a node's difference is at most that of all. K is the stiffness at rest with the
// springs (problems.hpp). The errors of forces are
//   rounding: sqrt(n) eps, n unknowns;
//   at large strain the reference's last residual, 1e-11 of the gradients of flesh and springs, each at most |K| |u|;
//   and CalculiX's: in each unknown at most its bound times the mean force of elements on their nodes, which is at most
//   |K| |u|.
double difference_bound(const pbs::TetMesh& mesh, const HeldBody& body, const pbs::Positions& displacements)
{
    const SimplexSpace space(mesh, body.element_order);
    SparseMatrix stiffness = stiffness_matrix(space, lame_parameters(body.material.young_pa, body.material.poisson));
    AttachedPoints(mesh, space, body.attachment.spring_points, body.attachment.spring_stiffness).add_to(stiffness);
    const Spectrum at_rest = spectrum(stiffness, held_dofs(space, body));
    double bound = rounding_bound(at_rest);
    if (body.model != BodyModel::linear)
        bound += (2.0 * calculix_newton.relative_tolerance + std::sqrt(at_rest.unknowns) * calculix_residual) *
                 at_rest.condition();
    return bound * displacements.norm() / displacements.rowwise().norm().maxCoeff();
}

std::string difference_bound_text(BodyModel model)
{
    const std::string of_both = "by eigenvalues of this very matrix, times |u| over the largest displacement";
    if (model == BodyModel::linear) return "rounding of a direct solve: sqrt(n) eps cond(K), cond(K) " + of_both;
    return "rounding and both Newton methods' last residuals: (sqrt(n) (eps + 1e-12) + 2e-11) cond(K), cond(K) at "
           "rest " +
           of_both;
}

}  // namespace

std::string CalculixLimb::problem() const
{
    return fmt::format("limb_{}_{}_{}_by_{}_p{}", vertices, is_smooth() ? "smooth" : "held", way, angle_deg,
                       element_order);
}

HeldBody held_body(const pbs::Character& character, const CalculixLimb& limb, const ElasticMaterial& material)
{
    constexpr double whole_tets_fit = 0.6;  // radius of a capsule over that of the limb
    FemOptions options{.young_pa = material.young_pa, .attachment = limb.attachment};
    if (limb.attachment == FemAttachment::nodes) options.core_radius = whole_tets_fit;
    const BoneAttachment bones = bone_attachment(character, options);
    const pbs::Vec3 axis = limb.way == "bent" ? pbs::Vec3::UnitZ() : pbs::Vec3::UnitX();
    const auto targets_at = [=, rest = character.mesh.rest, skeleton = character.skeleton](double fraction) {
        return targets(bones, rest,
                       pbs::joint_sweep(skeleton, 1, axis, fraction * limb.angle_deg, 2, 0.01).steps.back());
    };
    return {material, limb.model, limb.element_order, bones.attachment, targets_at};
}

VerificationRow calculix_row(const pbs::Character& character, const CalculixLimb& limb, const HeldBody& body)
{
    const SimplexSpace space(character.mesh, limb.element_order);
    const pbs::Positions displacements = displacements_of(character.mesh, body);
    const bool is_linear = limb.model == BodyModel::linear;
    VerificationRow row = calculix_row(
        limb.problem(),
        fmt::format("limb, {}{} by {} deg", limb.is_smooth() ? "smooth attachment, " : "", limb.way, limb.angle_deg),
        is_linear ? "linear" : "st_venant_kirchhoff", space, displacements);
    row.mesh = std::to_string(character.mesh.rest.rows()) + " vertices";
    if (limb.is_smooth())
        bound(row, {}, difference_bound(character.mesh, body, displacements), difference_bound_text(limb.model));
    if (limb.model == BodyModel::st_venant_kirchhoff_at_four_points) row.note = "P2 integrated by C3D10's four points";
    if (limb.model == BodyModel::st_venant_kirchhoff && limb.element_order == 2) {
        row.quantity.setting += "_six_points";
        unbound(row);
        row.note = "six quadrature points against C3D10's four";
    }
    return row;
}

std::vector<CalculixLimb> calculix_limbs(bool full)
{
    constexpr BodyModel linear = BodyModel::linear, large = BodyModel::st_venant_kirchhoff,
                        four_points = BodyModel::st_venant_kirchhoff_at_four_points;
    constexpr FemAttachment smooth = FemAttachment::smooth;
    const int whole = 1775, small = 400, second_order = full ? whole : 600;  // vertices that the mesher is asked for
    return {{whole, "bent", 10, linear, 1},
            {whole, "bent", 90, linear, 1},
            {whole, "twisted", 90, linear, 1},
            {whole, "bent", 10, linear, 2},
            {whole, "bent", 90, linear, 2},
            {whole, "twisted", 90, linear, 2},
            {whole, "bent", 30, large, 1},
            {whole, "twisted", 30, large, 1},
            {second_order, "bent", 30, four_points, 2},
            {second_order, "bent", 30, large, 2},
            {small, "bent", 10, linear, 1, smooth},
            {small, "bent", 30, large, 1, smooth},
            {small, "twisted", 30, large, 1, smooth},
            {small, "bent", 10, linear, 2, smooth},
            {small, "bent", 30, four_points, 2, smooth},
            {small, "twisted", 30, four_points, 2, smooth}};
}

VerificationRows calculix_rows(const Effort& effort)
{
    VerificationRows rows = {cantilever_row(effort, 1), cantilever_row(effort, 2)};
    if (!effort.limb) return rows;
    for (const CalculixLimb& limb : calculix_limbs(effort.full)) {
        const pbs::Character character = effort.limb(limb.vertices);
        rows.push_back(
            calculix_row(character, limb, held_body(character, limb, solver_material(effort, calculix_flesh))));
    }
    return rows;
}

}  // namespace experiments
