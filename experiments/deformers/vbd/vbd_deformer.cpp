// Elastic flesh in equilibrium by vertex block descent (pbs/flesh/vertex_block_descent.hpp). Every frame begins at the initial guess anew,
// so that it does not depend on the frames before.
#include "experiments/deformers/flesh/flesh_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "pbs/flesh/vertex_block_descent.hpp"
#include "pbs/geometry/stopwatch.hpp"

#include <variant>

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

class VbdDeformer : public Deformer {
public:
    VbdDeformer(const VbdOptions& options, int threads) : options_(options), threads_(threads) {}

    void reset(const pbs::Character& character) override
    {
        flesh_.emplace(character, options_);
        positions_ = character.mesh.rest;
        tets_ = character.mesh.tets.rows();
        const pbs::VertexBlockOptions options{.iterations = options_.iterations,
                                              .acceleration = options_.acceleration,
                                              .omega = options_.omega,
                                              .rho = options_.rho,
                                              .arithmetic = options_.arithmetic,
                                              .threads = threads_};
        if (options_.arithmetic == pbs::Arithmetic::packed_f32)
            solver_.emplace<pbs::VertexBlockDescent<float>>(character.mesh, flesh_->flesh().energy(), options);
        else
            solver_.emplace<pbs::VertexBlockDescent<double>>(character.mesh, flesh_->flesh().energy(), options);
    }

    pbs::StepSummary advance(const pbs::Pose& pose, double /*dt_s*/) override
    {
        const pbs::Stopwatch stopwatch;
        flesh_->pose(pose);
        positions_ = flesh_->start();
        pbs::VertexBlockSummary descent;
        if (auto* in_float = std::get_if<pbs::VertexBlockDescent<float>>(&solver_))
            descent = in_float->minimise(flesh_->centres(), positions_);
        if (auto* in_double = std::get_if<pbs::VertexBlockDescent<double>>(&solver_))
            descent = in_double->minimise(flesh_->centres(), positions_);
        pbs::StepSummary summary;
        summary.iterations = descent.iterations;
        summary.work = {.vertex_visits = (1 + descent.iterations) * positions_.rows(),  // blended once, then moved
                        .tet_visits = 4 * descent.iterations * tets_};                  // once for each of its vertices
        summary.seconds = stopwatch.seconds();
        if (!descent.is_finite) summary.outcome = pbs::Outcome::not_finite;
        return summary;
    }

    void start_from(const pbs::Positions& shape) override { flesh_->start_from(shape); }
    const pbs::Positions& positions() const override { return positions_; }
    nlohmann::json record() const override { return flesh_ ? flesh_->record() : nullptr; }

private:
    VbdOptions options_;
    int threads_;
    std::int64_t tets_ = 0;
    std::optional<PosedFlesh> flesh_;
    std::variant<std::monostate, pbs::VertexBlockDescent<float>, pbs::VertexBlockDescent<double>> solver_;
    pbs::Positions positions_;
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
            .traits = [](const DeformerSpec& spec) -> DeformerTraits {
                const auto& options = options_of<VbdOptions>(spec);
                return {.precision = options.arithmetic == pbs::Arithmetic::packed_f32 ? "f32" : "f64",
                        .packed = options.arithmetic != pbs::Arithmetic::plain_f64,
                        .iterations = options.iterations,
                        .threads = spec.threads};
            }};
}

}  // namespace experiments
