// The shared options of the deformers that minimise the energy of elastic flesh: material, springs of the bones and initial guess.
// The options of such a deformer are a struct with these members and its own; its keys begin with flesh_fields<Options>(kind).
#pragma once

#include "experiments/settings/option_fields.hpp"
#include "pbs/character/bone_capsules.hpp"
#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/flesh/held_flesh.hpp"
#include "pbs/skinning/blend.hpp"

#include <optional>

namespace experiments {

template <>
struct OptionNames<pbs::Arithmetic> {
    static constexpr std::array<std::pair<pbs::Arithmetic, const char*>, 3> table{{{pbs::Arithmetic::packed_f32, "packed_f32"},
                                                                                   {pbs::Arithmetic::packed_f64, "packed_f64"},
                                                                                   {pbs::Arithmetic::plain_f64, "plain_f64"}}};
};

template <>
struct OptionNames<pbs::FleshStart> {
    static constexpr std::array<std::pair<pbs::FleshStart, const char*>, 2> table{
        {{pbs::FleshStart::smooth_dqs, "smooth_dqs"}, {pbs::FleshStart::lbs, "lbs"}}};
};

template <typename Options>
OptionFields<Options> flesh_fields(const std::string& kind)
{
    return OptionFields<Options>(kind)
        .add("iterations", &Options::iterations, {.lowest = 0, .highest = 1e6, .meaning = "iterations per frame"})
        .add("poisson", &Options::poisson,
             {.lowest = 0.0, .highest = 0.4999, .meaning = "Poisson's ratio of the flesh where strains are small"})
        .add("core_radius", &Options::core_radius,
             {.lowest = above_zero,
              .highest = 1.0,
              .meaning = "radius of the capsules whose springs hold the flesh, a factor on the limb's radius, without a unit"})
        .add("spring_factor", &Options::spring_factor,
             {.lowest = above_zero,
              .meaning = "q, a factor without a unit: the springs have the density q E / r^2 on the axis of a capsule of radius r"})
        .add("start", &Options::start,
             {.meaning = "initial guess of each frame: dual quaternion skinning with weights that the springs determine, or LBS"})
        .add("arithmetic", &Options::arithmetic,
             {.meaning = "several elements side by side in float or double, or one after the other in double"});
}

// The flesh of a character and the initial guesses of its frames.
class PosedFlesh {
public:
    // volume_share is the share of lambda in the Laplacian that determines the weights of the initial guess. Methods that also solve with
    // this Laplacian choose a share of their own.
    template <typename Options>
    PosedFlesh(const pbs::Character& character, const Options& options, double volume_share = pbs::HeldFleshOptions().volume_share)
        : PosedFlesh(character, {.core_radius = options.core_radius, .spring_factor = options.spring_factor},
                     {.poisson = options.poisson, .volume_share = volume_share}, options.start)
    {
    }

    // Sets the centres of the springs and the initial guess of a pose: the shape of start_from, if there is one, or as the options say.
    void pose(const pbs::Pose& pose);
    void start_from(const pbs::Positions& shape) { next_start_ = shape; }  // [m], #V x 3, for the next pose

    const pbs::HeldFlesh& flesh() const { return flesh_; }
    const pbs::Positions& centres() const { return centres_; }  // [m], #V x 3
    const pbs::Positions& start() const { return start_; }      // [m], #V x 3
    nlohmann::json record() const;                              // of the springs and the factor, for run.json

private:
    PosedFlesh(const pbs::Character& character, const pbs::SmoothSpringOptions& springs, const pbs::HeldFleshOptions& options,
               pbs::FleshStart start);

    pbs::HeldFlesh flesh_;
    pbs::FleshStart how_;
    pbs::BlendSkinning<double> skinning_;
    pbs::Positions centres_, start_;
    std::optional<pbs::Positions> next_start_;
};

}  // namespace experiments
