// pbskin_distributed: the linear reference on a mesh that is spread over MPI ranks.
//   pbskin_distributed --bar 10000 --gravity 0 0 -9.81 -o results/bar                    one process
//   mpirun -n 2 pbskin_distributed --bar 1000000 --gravity 0 0 -9.81 -o results/bar_1m   two
//   pbskin_distributed --bar 10000 --gravity 0 0 -9.81 --solver cholmod                  the serial reference, for
//   comparison mpirun -n 2 pbskin_distributed --limb 1775 --bend 10                                 held by the
//   skeleton's springs
//
//   |/|==================+   held at x = 0, gravity everywhere, traction on the far end at x = 10 m
//   |/|==================+
//
// Prints the record and writes it to DIR/record.json, and with --nodes the displacement of every node to DIR/nodes.csv.
// It takes seconds for 10,000 tets and about a minute for 1,000,000 on 2 ranks.

#include "analysis/records/provenance.hpp"
#include "analysis/records/record_files.hpp"
#include "analysis/records/tables.hpp"
#include "experiments/deformers/fem/bone_attachment.hpp"
#include "experiments/deformers/fem/fem_deformers.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io.hpp"
#include "reference_fem/distributed/elastic_problem.hpp"
#include "reference_fem/options.hpp"
#include "reference_fem/verification/problems.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

namespace experiments {
namespace {

// The bodies of pbskin_distributed: tets with their supports and loads.
struct BodyArguments {
    // One of these. A file is held and pulled like the bar.
    int bar_tets = 0;       // a cantilever [0, 10] x [0, 1]^2 m of about this number of tets
    int limb_vertices = 0;  // the built-in limb, held by its bones with the smooth attachment of the reference
    std::string mesh_file;  // a tet mesh

    // Bar and file: vertices with x <= held_below_m are held, and those with x >= pulled_above_m are pulled. NaN: the
    // lowest, the highest x.
    double held_below_m = std::numeric_limits<double>::quiet_NaN();
    double pulled_above_m = std::numeric_limits<double>::quiet_NaN();
    pbs::Vec3 traction_pa = pbs::Vec3::Zero();
    double twist_deg = 0.0, bend_deg = 0.0;  // of the forearm of the limb, about x and z
};

struct LoadedBody {
    std::string name;
    pbs::TetMesh mesh;
    reference_fem::ElasticProblem problem;
    // the options of the attachment to bones; nothing if the body has none. On rank 0 only
    std::optional<FemOptions> held_by = {};
};

// Everything that a solution depends on.
struct DistributedSettings {
    BodyArguments body;
    reference_fem::LinearOptions elastic{.element_order = 1, .poisson = 0.3};
    reference_fem::IterativeOptions iterative;
    bool serial = false;  // on one process, by the serial reference
};
struct DisplacedNode {
    int first = 0, second = 0;
    pbs::Vec3 displacement_m;
};
// Cubes of 6 tets each: n along each side of the section, and as many along the bar as give the wanted number of tets.
pbs::TetMesh bar(int tets)
{
    const int n = std::max(1, static_cast<int>(std::lround(std::cbrt(tets / 60.0))));
    const int along = std::max(1, static_cast<int>(std::lround(tets / (6.0 * n * n))));
    return reference_fem::box_mesh({0, 0, 0}, {10, 1, 1}, {along, n, n});
}

std::vector<int> vertices_where(const pbs::TetMesh& mesh, const auto& holds)
{
    std::vector<int> vertices;
    for (int v = 0; v < mesh.rest.rows(); ++v)
        if (holds(mesh.rest(v, 0))) vertices.push_back(v);
    return vertices;
}

LoadedBody held_at_the_end(const BodyArguments& arguments, const reference_fem::LinearOptions& options)
{
    LoadedBody body;
    body.name = arguments.bar_tets > 0 ? "bar" : std::filesystem::path(arguments.mesh_file).filename().string();
    body.mesh = arguments.bar_tets > 0 ? bar(arguments.bar_tets) : pbs::read_tet_mesh(arguments.mesh_file).mesh;
    const double low = body.mesh.rest.col(0).minCoeff(), high = body.mesh.rest.col(0).maxCoeff(),
                 rounding = 1e-9 * (high - low);
    const double held = std::isnan(arguments.held_below_m) ? low + rounding : arguments.held_below_m;
    const double pulled = std::isnan(arguments.pulled_above_m) ? high - rounding : arguments.pulled_above_m;
    body.problem.options = options;
    body.problem.held_vertices = vertices_where(body.mesh, [&](double x) { return x <= held; });
    body.problem.pulled_vertices = vertices_where(body.mesh, [&](double x) { return x >= pulled; });
    body.problem.traction_pa = arguments.traction_pa;
    return body;
}

LoadedBody limb(const BodyArguments& arguments, const reference_fem::LinearOptions& options)
{
    pbs::CharacterSource source;
    source.body = "limb";
    source.vertices = arguments.limb_vertices;
    const pbs::Character character = pbs::make_character(source);
    const FemOptions fem{.young_pa = options.young_pa, .attachment = FemAttachment::smooth};
    const BoneAttachment bones = bone_attachment(character, fem);
    constexpr double degree = std::numbers::pi / 180.0;
    std::vector<Eigen::Quaterniond> joints(character.skeleton.bones.size(), Eigen::Quaterniond::Identity());
    joints.back() = Eigen::AngleAxisd(arguments.bend_deg * degree, pbs::Vec3::UnitZ()) *
                    Eigen::AngleAxisd(arguments.twist_deg * degree, pbs::Vec3::UnitX());
    LoadedBody body{character.name, character.mesh, {}, fem};
    body.problem.options = options;
    body.problem.attachment = bones.attachment;
    body.problem.spring_targets =
        targets(bones, character.mesh.rest, pbs::pose_from_joints(character.skeleton, joints, pbs::Vec3::Zero()))
            .springs;
    return body;
}

// Sends the body from rank 0 to all ranks, without its options.
void broadcast(const reference_fem::MpiSession& session, LoadedBody& body)
{
    session.broadcast(body.name);
    session.broadcast(body.mesh.rest);
    session.broadcast(body.mesh.tets);
    session.broadcast(body.problem.held_vertices);
    session.broadcast(body.problem.pulled_vertices);
    session.broadcast(body.problem.attachment.spring_points);
    session.broadcast(body.problem.attachment.spring_stiffness);
    session.broadcast(body.problem.attachment.prescribed_tets);
    session.broadcast(body.problem.spring_targets);
    session.broadcast(body.problem.vertex_targets);
}

const analysis::Columns<DisplacedNode> node_columns = {
    {"first", &DisplacedNode::first},
    {"second", &DisplacedNode::second},
    {"x_m", [](auto& node) -> decltype(auto) { return (node.displacement_m.x()); }},
    {"y_m", [](auto& node) -> decltype(auto) { return (node.displacement_m.y()); }},
    {"z_m", [](auto& node) -> decltype(auto) { return (node.displacement_m.z()); }}};

// Mean displacement [m] of the vertices with the greatest x.
pbs::Vec3 tip_displacement(const pbs::TetMesh& mesh, const reference_fem::ElasticSolution& solution)
{
    const double high = mesh.rest.col(0).maxCoeff(), rounding = 1e-9 * (high - mesh.rest.col(0).minCoeff());
    pbs::Vec3 sum = pbs::Vec3::Zero();
    int vertices = 0;
    for (Eigen::Index n = 0; n < solution.nodes.rows(); ++n) {
        const int vertex = solution.nodes(n, 0);
        if (vertex != solution.nodes(n, 1) || mesh.rest(vertex, 0) < high - rounding) continue;
        sum += solution.displacement.row(n);
        ++vertices;
    }
    return sum / vertices;
}

RECORD_SETTINGS(BodyArguments, bar_tets, limb_vertices, mesh_file, held_below_m, pulled_above_m, traction_pa, twist_deg,
                bend_deg)
RECORD_SETTINGS(reference_fem::LinearOptions, element_order, young_pa, poisson, density_kg_m3, gravity_m_s2, solver,
                formulation)
RECORD_SETTINGS(reference_fem::IterativeOptions, tolerance, most_iterations)

nlohmann::json to_json(const DistributedSettings& settings, const LoadedBody& body,
                       const reference_fem::ElasticSolution& solution)
{
    const reference_fem::ElasticSummary& summary = solution.summary;
    analysis::Provenance provenance = analysis::collect_provenance(1);  // one thread per rank
    provenance.blas = blas_in_use();                                    // of the direct solvers
    return {{"schema", 3},
            {"body", body.name},
            {"settings",
             {{"body", to_json(settings.body)},
              {"elastic", to_json(settings.elastic)},
              {"iterative", to_json(settings.iterative)},
              {"serial", settings.serial}}},
            {"attachment", body.held_by ? attachment_json(*body.held_by) : nlohmann::json()},
            {"springs", body.problem.attachment.spring_points.rows()},
            {"solver", summary.solver},
            {"ranks", summary.ranks},
            {"vertices", body.mesh.rest.rows()},
            {"tets", summary.tets},
            {"tets_of_rank_min", summary.tets_of_rank_min},
            {"tets_of_rank_max", summary.tets_of_rank_max},
            {"dofs", summary.dofs},
            {"mesh_s", summary.mesh.wall_s},
            {"mesh_cpu_s", summary.mesh.cpu_s},
            {"assembly_s", summary.assembly.wall_s},
            {"assembly_cpu_s", summary.assembly.cpu_s},
            {"setup_s", summary.setup.wall_s},
            {"setup_cpu_s", summary.setup.cpu_s},
            {"solve_s", summary.solve.wall_s},
            {"solve_cpu_s", summary.solve.cpu_s},
            {"peak_mb_of_rank_max", summary.peak_mb},
            {"iterations", summary.iterations},
            {"relative_residual", summary.relative_residual},
            {"converged", summary.converged},
            {"compliance_j", summary.compliance_j},
            {"tip_displacement_m", option_json(tip_displacement(body.mesh, solution))},
            {"largest_displacement_m", solution.displacement.rowwise().norm().maxCoeff()},
            {"provenance", provenance}};
}

struct Arguments : DistributedSettings {
    std::vector<double> gravity_m_s2 = {0, 0, 0}, traction_pa = {0, 0, 0};
    std::string solver = "cg_ml", folder;
    bool nodes = false;
};

void add_options(CLI::App& app, Arguments& arguments)
{
    app.add_option("--bar", arguments.body.bar_tets, "a cantilever of about this number of tets")
        ->check(CLI::Range(6, 1'000'000'000));
    app.add_option("--limb", arguments.body.limb_vertices,
                   "the built-in limb of about this number of vertices, held by its skeleton");
    app.add_option("--mesh", arguments.body.mesh_file, "a tet mesh [m]: .msh .vtu .vtk .mesh .node .ele");
    app.add_option("--held-below", arguments.body.held_below_m,
                   "the boundary with x up to this is held [m]; default: the lowest x");
    app.add_option("--pulled-above", arguments.body.pulled_above_m,
                   "the boundary with x from this bears the traction [m]; default: the highest x");
    app.add_option("--traction", arguments.traction_pa, "x y z [Pa]")->expected(3);
    app.add_option("--gravity", arguments.gravity_m_s2, "x y z [m/s^2]")->expected(3);
    app.add_option("--twist", arguments.body.twist_deg, "twist of the limb's forearm about x [deg]");
    app.add_option("--bend", arguments.body.bend_deg, "bend of the limb's forearm about z [deg]");
    app.add_option("--order", arguments.elastic.element_order, "order of the elements")
        ->check(CLI::Range(1, 2))
        ->capture_default_str();
    app.add_option("--young", arguments.elastic.young_pa, "Young's modulus [Pa]")->capture_default_str();
    app.add_option("--poisson", arguments.elastic.poisson, "Poisson's ratio")->capture_default_str();
    app.add_option("--density", arguments.elastic.density_kg_m3, "density [kg/m^3]")->capture_default_str();
    app.add_flag("--serial", arguments.serial,
                 "the serial reference on one process, which the distributed solution is compared with");
    app.add_option("--solver", arguments.solver, "cholmod and umfpack are serial")
        ->check(CLI::IsMember({"cg_ml", "cholmod", "umfpack"}))
        ->capture_default_str();
    app.add_option("--tolerance", arguments.iterative.tolerance, "relative residual of cg_ml")
        ->check(CLI::Range(1e-15, 0.1))
        ->capture_default_str();
    app.add_option("--most-iterations", arguments.iterative.most_iterations, "largest number of iterations of cg_ml")
        ->check(CLI::Range(1, 1'000'000))
        ->capture_default_str();
    app.add_option("-o,--output", arguments.folder, "folder for record.json; default: none");
    app.add_flag("--nodes", arguments.nodes, "also write nodes.csv into the folder");
}

// Rank 0 builds the body. An error in the input is thrown on every rank.
LoadedBody same_body_everywhere(const reference_fem::MpiSession& session, const Arguments& arguments)
{
    LoadedBody body;
    std::string failure;
    if (session.rank() == 0) {
        const BodyArguments& wanted = arguments.body;
        try {
            if ((wanted.bar_tets > 0) + (wanted.limb_vertices > 0) + !wanted.mesh_file.empty() != 1)
                throw pbs::InputError("", 0, "body", "", "expected one of --bar, --limb and --mesh");
            body =
                wanted.limb_vertices > 0 ? limb(wanted, arguments.elastic) : held_at_the_end(wanted, arguments.elastic);
        } catch (const pbs::InputError& error) {
            failure = error.what();
        }
    }
    session.broadcast(failure);
    if (!failure.empty()) throw pbs::InputError("", 0, "", "", failure);
    broadcast(session, body);
    body.problem.options = arguments.elastic;
    body.problem.traction_pa = arguments.body.traction_pa;
    return body;
}

void write(const Arguments& arguments, const LoadedBody& body, const reference_fem::ElasticSolution& solution)
{
    const std::string text = to_json(arguments, body, solution).dump(2) + "\n";
    std::fputs(text.c_str(), stdout);
    if (arguments.folder.empty()) return;
    std::filesystem::create_directories(arguments.folder);
    analysis::write_text_atomically(arguments.folder + "/record.json", text);
    if (!arguments.nodes) return;
    std::vector<DisplacedNode> nodes;
    for (Eigen::Index n = 0; n < solution.nodes.rows(); ++n)
        nodes.push_back({solution.nodes(n, 0), solution.nodes(n, 1), solution.displacement.row(n)});
    table_of(node_columns, nodes).write(arguments.folder + "/nodes.csv");
}

int solve_and_record(const reference_fem::MpiSession& session, Arguments& arguments)
{
    arguments.body.traction_pa = pbs::Vec3(arguments.traction_pa.data());
    arguments.elastic.gravity_m_s2 = pbs::Vec3(arguments.gravity_m_s2.data());
    arguments.elastic.solver = option_of<reference_fem::LinearSolver>(arguments.solver);
    const bool distributed = arguments.solver == "cg_ml" && !arguments.serial;
    if (!distributed && session.ranks() > 1)
        throw pbs::InputError("", 0, "solver", arguments.solver, "expected cg_ml without --serial on several ranks");
    const LoadedBody body = same_body_everywhere(session, arguments);
    const reference_fem::ElasticSolution solution =
        distributed ? reference_fem::solve_distributed(body.mesh, body.problem, arguments.iterative)
                    : reference_fem::solve_serially(body.mesh, body.problem);
    if (session.rank() == 0) write(arguments, body, solution);
    return solution.summary.converged ? exit_finished : exit_breakdown;
}

int parse_and_act(const reference_fem::MpiSession& session, int argc, char** argv)
{
    CLI::App app("pbskin_distributed: the linear reference on a mesh that is spread over MPI ranks",
                 "pbskin_distributed");
    Arguments arguments;
    add_options(app, arguments);
    app.failure_message([](const CLI::App*, const CLI::Error& error) {
        return std::string("pbskin_distributed: ") + error.what() + "\n";
    });
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::ostringstream out, errors;
        const int status = app.exit(error, out, errors) == 0 ? exit_finished : exit_input;
        if (session.rank() == 0)
            std::fprintf(stdout, "%s", out.str().c_str()), std::fprintf(stderr, "%s", errors.str().c_str());
        return status;
    }
    return solve_and_record(session, arguments);
}

}  // namespace
}  // namespace experiments

int main(int argc, char** argv)
{
    experiments::restart_with_better_blas_kernels(argv);
    const reference_fem::MpiSession session(argv);
    try {
        return experiments::parse_and_act(session, argc, argv);
    } catch (const pbs::InputError& error) {  // on every rank
        if (session.rank() == 0) std::fprintf(stderr, "pbskin_distributed: %s\n", error.what());
        return experiments::exit_input;
    } catch (...) {
        const experiments::Failure failure = experiments::caught_failure();
        std::fprintf(stderr, "pbskin_distributed: rank %d: %s\n", session.rank(), failure.message().c_str());
        session.abort(failure.status);
    }
}
