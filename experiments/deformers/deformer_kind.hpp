// From the options and the class of a deformer to its DeformerKind:
//   struct LiftOptions { double height_m = 0.5; };
//   class Lift : public TimedDeformer { public: explicit Lift(const LiftOptions& options); ... };
//   DeformerKind lift_kind()
//   {
//       return kind_of<Lift>("lift", "the rest shape, lifted",
//                            OptionFields<LiftOptions>("lift").add("height_m", &LiftOptions::height_m, {.unit = "m",
//                            .meaning = "by how much"}));
//   }
#pragma once

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/option_fields.hpp"

#include <algorithm>
#include <type_traits>

namespace experiments {

// The weights of the initial guess StartShape::smooth_dqs, solved from the springs that hold the flesh by default.
pbs::Weights smooth_weights_of(const pbs::Character& character);

// The argument is a deformer whose frames begin at a blend (its options have a member `start`); start_from replaces
// this blend. Where the first foreseen pose turns a joint by more than 90 degrees from rest, a blend collapses or
// inverts the flesh there, and what projects or minimises from it stays caught, in every frame; so it does where the
// first frame keeps more than 5e-4 of the tets inside out. The motion of a rigged model is then followed from rest
// instead, in steps in which a bone turns by at most 45 degrees, as the reference follows it: each step begins at the
// last positions, which the bones carry along by dual quaternions. This holds for a whole motion or not at all, and
// never for a deformer with a memory of its own, as of jiggling. Named bodies, with which the paper is reproduced,
// begin each frame as published, whatever their first pose.
std::unique_ptr<Deformer> following(std::unique_ptr<Deformer> deformer);

// The traits that options state themselves: members named order, precision, packed, iterations and threads. Iterations
// count only for options with threads: the others' steps of smoothing are no iterations of a solver.
template <typename Options>
DeformerTraits traits_from(const Options& options, const DeformerSpec& spec)
{
    DeformerTraits traits;
    if constexpr (requires { options.order; }) {
        traits.order = name_of(options.order);
        traits.packed = options.order == pbs::Order::ordered;
    }
    if constexpr (requires { options.precision; }) traits.precision = name_of(options.precision);
    if constexpr (requires { options.packed; }) traits.packed = options.packed;
    if constexpr (requires { options.threads; }) {
        traits.iterations = options.iterations;
        traits.threads = spec.threads;
    }
    return traits;
}

// For keys that contradict each other, or name a variant; may change the options.
template <typename Options>
using CheckOptions = void (*)(const SceneValues& values, const std::string& table, Options& options,
                              DeformerSpec& spec);

// Made is constructed from Options, whose member `threads` has the number of the spec. void: the caller sets `make`.
template <typename Made, typename Options>
DeformerKind kind_of(const std::string& name, const std::string& meaning, const OptionFields<Options>& fields,
                     CheckOptions<Options> check = nullptr)
{
    DeformerKind kind{.name = name,
                      .meaning = meaning,
                      .options = Options{},
                      .keys = fields.keys(),
                      .renamed_keys = fields.renamed_keys()};
    if constexpr (!std::is_void_v<Made>)
        kind.make = [](const DeformerSpec& spec) -> std::unique_ptr<Deformer> {
            Options options = options_of<Options>(spec);
            if constexpr (requires { options.threads; }) options.threads = spec.threads;
            if constexpr (requires { options.start; }) return following(std::make_unique<Made>(options));
            return std::make_unique<Made>(options);
        };
    kind.has_list = std::any_of(kind.keys.begin(), kind.keys.end(), [](const SceneKey& key) { return key.in_list; });
    kind.read = [fields, check, in_list = kind.has_list](const SceneValues& values, const std::string& of_scene,
                                                         DeformerSpec& spec) {
        if (in_list && of_scene == spec.kind) return;  // not from a list: the defaults
        const std::string table = in_list ? of_scene : fields.table();
        Options options = fields.read(values, table);
        if constexpr (requires { options.packed; }) agree_on_code(values, table, options.precision, options.packed);
        if (check) check(values, table, options, spec);
        spec.options = options;
    };
    kind.options_json = [fields](const DeformerSpec& spec) { return fields.json(options_of<Options>(spec)); };
    kind.traits = [](const DeformerSpec& spec) { return traits_from(options_of<Options>(spec), spec); };
    return kind;
}

}  // namespace experiments
