#include "experiments/distributed/distributed_record.hpp"

#include "analysis/records/provenance.hpp"
#include "experiments/deformers/fem/fem_option_names.hpp"
#include "experiments/deformers/fem/fem_record.hpp"
#include "experiments/process/blas_kernels.hpp"
#include "experiments/settings/option_fields.hpp"

#include <nlohmann/json.hpp>

namespace experiments {

const analysis::Columns<DisplacedNode> node_columns = {
    {"first", &DisplacedNode::first, "", "the vertex that the node lies on, or the first of the two that it lies halfway between"},
    {"second", &DisplacedNode::second, "", "the second of the two, or the same vertex"},
    {"x_m", [](auto& node) -> decltype(auto) { return (node.displacement_m.x()); }, "m", "x of its displacement"},
    {"y_m", [](auto& node) -> decltype(auto) { return (node.displacement_m.y()); }, "m", "y of its displacement"},
    {"z_m", [](auto& node) -> decltype(auto) { return (node.displacement_m.z()); }, "m", "z of its displacement"}};

namespace {

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

// One thread per rank, and the BLAS of the direct solvers.
analysis::Provenance provenance()
{
    analysis::Provenance provenance = analysis::collect_provenance(1);
    provenance.blas = blas_in_use();
    return provenance;
}

}  // namespace

nlohmann::json to_json(const DistributedSettings& settings)
{
    using reference_fem::IterativeOptions;
    using reference_fem::LinearOptions;
    static const auto body = OptionFields<BodyArguments>("body")
                                 .record("bar_tets", &BodyArguments::bar_tets)
                                 .record("limb_vertices", &BodyArguments::limb_vertices)
                                 .record("mesh_file", &BodyArguments::mesh_file)
                                 .record("held_below_m", &BodyArguments::held_below_m)
                                 .record("pulled_above_m", &BodyArguments::pulled_above_m)
                                 .record("traction_pa", &BodyArguments::traction_pa)
                                 .record("twist_deg", &BodyArguments::twist_deg)
                                 .record("bend_deg", &BodyArguments::bend_deg)
                                 .complete();
    static const auto elastic = OptionFields<LinearOptions>("elastic")
                                    .record("element_order", &LinearOptions::element_order)
                                    .record("young_pa", &LinearOptions::young_pa)
                                    .record("poisson", &LinearOptions::poisson)
                                    .record("density_kg_m3", &LinearOptions::density_kg_m3)
                                    .record("gravity_m_s2", &LinearOptions::gravity_m_s2)
                                    .record("solver", &LinearOptions::solver)
                                    .record("formulation", &LinearOptions::formulation)
                                    .complete();
    static const auto iterative = OptionFields<IterativeOptions>("iterative")
                                      .record("tolerance", &IterativeOptions::tolerance)
                                      .record("most_iterations", &IterativeOptions::most_iterations)
                                      .complete();
    return {{"body", body.json(settings.body)},
            {"elastic", elastic.json(settings.elastic)},
            {"iterative", iterative.json(settings.iterative)},
            {"serial", settings.serial}};
}

nlohmann::json to_json(const DistributedSettings& settings, const LoadedBody& body, const reference_fem::ElasticSolution& solution)
{
    const reference_fem::ElasticSummary& summary = solution.summary;
    return {{"schema", 3},
            {"body", body.name},
            {"settings", to_json(settings)},
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
            {"provenance", provenance()}};
}

void write_nodes(const std::string& path, const reference_fem::ElasticSolution& solution)
{
    std::vector<DisplacedNode> nodes;
    for (Eigen::Index n = 0; n < solution.nodes.rows(); ++n)
        nodes.push_back({solution.nodes(n, 0), solution.nodes(n, 1), solution.displacement.row(n)});
    table_of(node_columns, nodes).write(path);
}

}  // namespace experiments
