// Elastic flesh in equilibrium by vertex block descent (pbs/flesh/vertex_block_descent.hpp).
#include "experiments/deformers/flesh/flesh_deformer.hpp"
#include "pbs/flesh/vertex_block_descent.hpp"

namespace experiments {

template <>
struct OptionNames<pbs::Acceleration> {
    static constexpr std::array<std::pair<pbs::Acceleration, const char*>, 2> table{
        {{pbs::Acceleration::over_relaxation, "over_relaxation"}, {pbs::Acceleration::chebyshev, "chebyshev"}}};
};

namespace {

struct VbdOptions {
    int iterations = 64;
    double poisson = 0.45, core_radius = 0.7, spring_factor = 10.0;
    pbs::FleshStart start = pbs::FleshStart::smooth_dqs;
    pbs::Arithmetic arithmetic = pbs::Arithmetic::packed_f32;
    pbs::Acceleration acceleration = pbs::Acceleration::over_relaxation;
    double omega = 1.88;
    double rho = 0.95;
};

const OptionFields<VbdOptions>& vbd_fields()
{
    static const OptionFields<VbdOptions> fields =
        flesh_fields<VbdOptions>("vbd")
            .add("acceleration", &VbdOptions::acceleration,
                 {.meaning = "over-relaxation of each vertex, or Chebyshev's weights after each sweep, which may diverge"})
            .add("omega", &VbdOptions::omega,
                 {.lowest = above_zero,
                  .highest = 1.999,
                  .meaning = "each vertex moves by omega times the way to its minimum; 1 with chebyshev"})
            .add("rho", &VbdOptions::rho,
                 {.lowest = 0.0, .highest = 0.9999, .meaning = "the spectral radius of a sweep that chebyshev assumes; unused otherwise"});
    return fields;
}

class VbdDeformer : public FleshDeformer {
public:
    VbdDeformer(const VbdOptions& options, int threads) : options_(options), threads_(threads) {}

private:
    PosedFlesh make_flesh(const pbs::Character& character) const override { return {character, options_}; }

    void make_solver(const pbs::Character& character, const pbs::HeldFlesh& flesh) override
    {
        const pbs::VertexBlockOptions options{.iterations = options_.iterations,
                                              .acceleration = options_.acceleration,
                                              .omega = options_.omega,
                                              .rho = options_.rho,
                                              .arithmetic = options_.arithmetic,
                                              .threads = threads_};
        solver_.make(options_.arithmetic, character.mesh, flesh.energy(), options);
    }

    pbs::StepSummary minimise(const PosedFlesh& flesh, const pbs::Pose& /*pose*/, pbs::Positions& x) override
    {
        const pbs::VertexBlockSummary descent = solver_.minimise(flesh.centres(), x);
        pbs::StepSummary summary;
        summary.iterations = descent.iterations;
        summary.work = {.vertex_visits = (1 + descent.iterations) * x.rows(),  // blended once, then moved
                        .tet_visits = 4 * descent.iterations * tets()};        // once for each of its vertices
        return summary;
    }

    VbdOptions options_;
    int threads_;
    InArithmetic<pbs::VertexBlockDescent> solver_;
};

}  // namespace

DeformerKind vbd_kind()
{
    return {.name = "vbd",
            .meaning = "neo-Hookean flesh in equilibrium on linear tets, by vertex block descent with over-relaxation (Chen 2024)",
            .make = [](const DeformerSpec& spec) -> std::unique_ptr<Deformer> {
                return std::make_unique<VbdDeformer>(options_of<VbdOptions>(spec), spec.threads);
            },
            .options = VbdOptions{},
            .keys = vbd_fields().keys(),
            .read = [](const SceneValues& values, const std::string& table,
                       DeformerSpec& spec) { spec.options = vbd_fields().read(values, table); },
            .options_json = [](const DeformerSpec& spec) { return vbd_fields().json(options_of<VbdOptions>(spec)); },
            .traits = flesh_traits<VbdOptions>};
}

}  // namespace experiments
