// The base class of the deformers that minimise the energy of elastic flesh. It has their frames, initial guesses, records and traits.
// Every frame begins at the initial guess anew, so that it does not depend on the frames before. A deformer of this kind derives from
// FleshDeformer, sets up its solver in make_solver, and minimises in `minimise`.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/deformers/flesh/flesh_options.hpp"
#include "experiments/deformers/registry.hpp"

#include <optional>
#include <type_traits>
#include <variant>

namespace experiments {

// Solver<float> or Solver<double>, whichever an arithmetic needs.
template <template <typename> class Solver>
class InArithmetic {
public:
    template <typename... Arguments>
    void make(pbs::Arithmetic arithmetic, const Arguments&... arguments)
    {
        if (arithmetic == pbs::Arithmetic::packed_f32)
            solver_.template emplace<Solver<float>>(arguments...);
        else
            solver_.template emplace<Solver<double>>(arguments...);
    }

    auto minimise(const pbs::Positions& targets, pbs::Positions& x)
    {
        using Summary = decltype(std::declval<Solver<double>&>().minimise(targets, x));
        return std::visit(
            [&](auto& solver) {
                if constexpr (std::is_same_v<std::decay_t<decltype(solver)>, std::monostate>)
                    return Summary{};
                else
                    return solver.minimise(targets, x);
            },
            solver_);
    }

private:
    std::variant<std::monostate, Solver<float>, Solver<double>> solver_;
};

class FleshDeformer : public Deformer {
public:
    void reset(const pbs::Character& character) final;
    // Times the frame. A shape that is not finite is the outcome not_finite, whatever the method reports.
    pbs::StepSummary advance(const pbs::Pose& pose, double dt_s) final;
    void start_from(const pbs::Positions& shape) override { flesh_->start_from(shape); }
    const pbs::Positions& positions() const override { return positions_; }
    nlohmann::json record() const override { return flesh_ ? flesh_->record() : nullptr; }

protected:
    virtual PosedFlesh make_flesh(const pbs::Character& character) const = 0;
    virtual void make_solver(const pbs::Character& character, const pbs::HeldFlesh& flesh) = 0;
    // x: the initial guess in, the result out [m], #V x 3. Returns iterations, work and outcome.
    virtual pbs::StepSummary minimise(const PosedFlesh& flesh, const pbs::Pose& pose, pbs::Positions& x) = 0;

    std::int64_t tets() const { return tets_; }

private:
    std::int64_t tets_ = 0;
    std::optional<PosedFlesh> flesh_;
    pbs::Positions positions_;
};

// Returns the traits of a spec. Options must have the members `arithmetic` and `iterations`.
template <typename Options>
DeformerTraits flesh_traits(const DeformerSpec& spec)
{
    const auto& options = options_of<Options>(spec);
    return {.precision = options.arithmetic == pbs::Arithmetic::packed_f32 ? "f32" : "f64",
            .packed = options.arithmetic != pbs::Arithmetic::plain_f64,
            .iterations = options.iterations,
            .threads = spec.threads};
}

}  // namespace experiments
