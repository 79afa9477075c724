// pbskin_distributed: the linear reference on a mesh that is spread over MPI ranks.
//   pbskin_distributed --bar 10000 --gravity 0 0 -9.81 -o results/bar                    one process
//   mpirun -n 2 pbskin_distributed --bar 1000000 --gravity 0 0 -9.81 -o results/bar_1m   two
//   pbskin_distributed --bar 10000 --gravity 0 0 -9.81 --solver cholmod                  the serial reference, for comparison
//   mpirun -n 2 pbskin_distributed --limb 1775 --bend 10                                 held by the skeleton's springs
//
//   |/|==================+   held at x = 0, gravity everywhere, traction on the far end at x = 10 m
//   |/|==================+
//
// Prints the record and writes it to DIR/record.json, and with --nodes the displacement of every node to DIR/nodes.csv. It takes seconds
// for 10,000 tets and about a minute for 1,000,000 on 2 ranks.
#include "analysis/records/record_files.hpp"
#include "experiments/deformers/fem/fem_option_names.hpp"
#include "experiments/distributed/distributed_record.hpp"
#include "experiments/process/blas_kernels.hpp"
#include "experiments/process/failure.hpp"
#include "pbs/geometry/input_error.hpp"
#include "reference_fem/distributed/elastic_problem.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>

namespace experiments {
namespace {

struct Arguments : DistributedSettings {
    std::vector<double> gravity_m_s2 = {0, 0, 0}, traction_pa = {0, 0, 0};
    std::string solver = "cg_ml", folder;
    bool nodes = false;
};

void add_options(CLI::App& app, Arguments& arguments)
{
    app.add_option("--bar", arguments.body.bar_tets, "a cantilever of about this number of tets")->check(CLI::Range(6, 1'000'000'000));
    app.add_option("--limb", arguments.body.limb_vertices, "the built-in limb of about this number of vertices, held by its skeleton");
    app.add_option("--mesh", arguments.body.mesh_file, "a tet mesh [m]: .msh .vtu .vtk .mesh .node .ele");
    app.add_option("--held-below", arguments.body.held_below_m, "the boundary with x up to this is held [m]; default: the lowest x");
    app.add_option("--pulled-above", arguments.body.pulled_above_m,
                   "the boundary with x from this bears the traction [m]; default: the highest x");
    app.add_option("--traction", arguments.traction_pa, "x y z [Pa]")->expected(3);
    app.add_option("--gravity", arguments.gravity_m_s2, "x y z [m/s^2]")->expected(3);
    app.add_option("--twist", arguments.body.twist_deg, "twist of the limb's forearm about x [deg]");
    app.add_option("--bend", arguments.body.bend_deg, "bend of the limb's forearm about z [deg]");
    app.add_option("--order", arguments.elastic.element_order, "order of the elements")->check(CLI::Range(1, 2))->capture_default_str();
    app.add_option("--young", arguments.elastic.young_pa, "Young's modulus [Pa]")->capture_default_str();
    app.add_option("--poisson", arguments.elastic.poisson, "Poisson's ratio")->capture_default_str();
    app.add_option("--density", arguments.elastic.density_kg_m3, "density [kg/m^3]")->capture_default_str();
    app.add_flag("--serial", arguments.serial, "the serial reference on one process, which the distributed solution is compared with");
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

pbs::Vec3 vector(const std::vector<double>& components)
{
    return {components[0], components[1], components[2]};
}

// Rank 0 builds the body. An error in the input is thrown on every rank.
LoadedBody same_body_everywhere(const reference_fem::MpiSession& session, const Arguments& arguments)
{
    LoadedBody body;
    std::string failure;
    if (session.rank() == 0) {
        try {
            body = load_body(arguments.body, arguments.elastic);
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
    if (arguments.nodes) write_nodes(arguments.folder + "/nodes.csv", solution);
}

int solve_and_record(const reference_fem::MpiSession& session, Arguments& arguments)
{
    arguments.body.traction_pa = vector(arguments.traction_pa);
    arguments.elastic.gravity_m_s2 = vector(arguments.gravity_m_s2);
    arguments.elastic.solver = option_of<reference_fem::LinearSolver>(arguments.solver);
    const bool distributed = arguments.solver == "cg_ml" && !arguments.serial;
    if (!distributed && session.ranks() > 1)
        throw pbs::InputError("", 0, "solver", arguments.solver, "expected cg_ml without --serial on several ranks");
    const LoadedBody body = same_body_everywhere(session, arguments);
    const reference_fem::ElasticSolution solution = distributed
                                                        ? reference_fem::solve_distributed(body.mesh, body.problem, arguments.iterative)
                                                        : reference_fem::solve_serially(body.mesh, body.problem);
    if (session.rank() == 0) write(arguments, body, solution);
    return solution.summary.converged ? exit_finished : exit_breakdown;
}

int parse_and_act(const reference_fem::MpiSession& session, int argc, char** argv)
{
    CLI::App app("pbskin_distributed: the linear reference on a mesh that is spread over MPI ranks", "pbskin_distributed");
    Arguments arguments;
    add_options(app, arguments);
    app.failure_message([](const CLI::App*, const CLI::Error& error) { return std::string("pbskin_distributed: ") + error.what() + "\n"; });
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::ostringstream out, errors;
        const int status = app.exit(error, out, errors) == 0 ? exit_finished : exit_input;
        if (session.rank() == 0) std::fprintf(stdout, "%s", out.str().c_str()), std::fprintf(stderr, "%s", errors.str().c_str());
        return status;
    }
    return solve_and_record(session, arguments);
}

}  // namespace
}  // namespace experiments

int main(int argc, char** argv)
{
    experiments::restart_with_better_blas_kernels(argv);
    const reference_fem::MpiSession session(argc, argv);
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
