// Position based skinning as in the code that the paper's first author published in 2018 (pbs/author/author_solver.hpp). README.md lists
// where that code departs from the paper; `pbskin explain pbs_author` prints it. It has its own weights, whatever those of the scene are,
// and its own time step, whatever the frame rate.
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/option_fields.hpp"
#include "pbs/author/author_solver.hpp"

#include <optional>

namespace experiments {
namespace {

using pbs::AuthorOptions;

const OptionFields<AuthorOptions>& author_fields()
{
    static const OptionFields<AuthorOptions> fields =
        OptionFields<AuthorOptions>("pbs_author")
            .add("iterations", &AuthorOptions::iterations, {.lowest = 0, .highest = 1e6, .meaning = "iterations per frame"})
            .add("time_step_s", &AuthorOptions::time_step_s,
                 {.unit = "s", .lowest = above_zero, .meaning = "h, whatever the time between two frames is; without gravity it cancels"})
            .add("gravity_m_s2", &AuthorOptions::gravity_m_s2,
                 {.unit = "m/s^2",
                  .meaning = "acceleration of every particle; the published code has (0, -9.81, 0) in its own unit of length"})
            .add("length_unit_m", &AuthorOptions::length_unit_m,
                 {.unit = "m",
                  .lowest = 1e-6,
                  .highest = 1e6,
                  .meaning = "unit of length of the threshold 1e-6, below which the sum of a tet's squared volume gradients leaves it out"})
            .add("k_compression", &AuthorOptions::k_compression,
                 {.lowest = 0, .highest = 1, .meaning = "stiffness of edges and binds that are shorter than at rest"})
            .add("k_stretch", &AuthorOptions::k_stretch, {.lowest = 0, .highest = 1, .meaning = "stiffness of all other edges and binds"})
            .add("k_volume_inverted", &AuthorOptions::k_volume_inverted,
                 {.lowest = 0, .highest = 6, .meaning = "stiffness of tets with negative volume; as k_volume"})
            .add("k_volume", &AuthorOptions::k_volume,
                 {.lowest = 0,
                  .highest = 6,
                  .meaning = "stiffness of all other tets; a projection removes k_volume / 6 of the error, since the gradients lack 1/6"});
    return fields;
}

class PbsAuthorDeformer : public Deformer {
public:
    explicit PbsAuthorDeformer(const AuthorOptions& options) : options_(options) {}

    void reset(const pbs::Character& character) override
    {
        solver_.emplace(character.mesh, character.skeleton, character.binding, options_);
    }
    pbs::StepSummary advance(const pbs::Pose& pose, double /*dt_s*/) override { return solver_->advance(pose); }
    const pbs::Positions& positions() const override { return solver_->positions(); }
    bool has_memory() const override { return true; }

private:
    AuthorOptions options_;
    std::optional<pbs::AuthorSolver> solver_;
};

}  // namespace

DeformerKind pbs_author_kind()
{
    return {.name = "pbs_author",
            .meaning = "PBS as in the code that the paper's first author published in 2018, which departs from the paper",
            .make = [](const DeformerSpec& spec) -> std::unique_ptr<Deformer> {
                return std::make_unique<PbsAuthorDeformer>(options_of<AuthorOptions>(spec));
            },
            .options = AuthorOptions{},
            .keys = author_fields().keys(),
            .read = [](const SceneValues& values, const std::string& table,
                       DeformerSpec& spec) { spec.options = author_fields().read(values, table); },
            .options_json = [](const DeformerSpec& spec) { return author_fields().json(options_of<AuthorOptions>(spec)); },
            .traits = [](const DeformerSpec& spec) -> DeformerTraits {
                return {.order = "first_fit", .iterations = options_of<AuthorOptions>(spec).iterations};
            }};
}

}  // namespace experiments
