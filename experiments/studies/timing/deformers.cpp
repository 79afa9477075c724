#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/scene_values.hpp"
#include "experiments/studies/timing/bench.hpp"
#include "pbs/geometry/input_error.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace experiments {
namespace {

constexpr double time_step_s = 0.01;
// The largest meshes that are timed: the scalar deformers take more than a tenth of a second per frame beyond 30,000
// tets, the first solve of linear elements takes seconds at 150,000, and a frame of nonlinear ones some twenty such
// solves.
constexpr Eigen::Index most_blend_tets = 1'000'000, most_deformer_tets = 30'000, most_fem_tets = 150'000,
                       most_newton_tets = 12'000;
// The keys without a default, because the paper does not state their values. These values are those of the built-in
// scenes of the limb.
const std::vector<std::string> stated_in_every_scene = {"pbs.k_stretch=0.2", "pbs.k_volume=1.0", "pbs.k_bind=1.0",
                                                        "pbs.gravity_m_s2=[0.0, 0.0, 0.0]"};

// The values of one timed round, in this order.
enum FrameSample { frame_s, iteration_s };

const SceneKey* key_of(const DeformerKind& kind, const std::string& name)
{
    const auto found = std::find_if(kind.keys.begin(), kind.keys.end(),
                                    [&](const SceneKey& key) { return key.table == kind.name && key.name == name; });
    return found == kind.keys.end() ? nullptr : &*found;
}

// {""} for a key that the kind does not have: it is not set.
std::vector<std::string> choices_of(const DeformerKind& kind, const std::string& name)
{
    const SceneKey* key = key_of(kind, name);
    return key && !key->choices.empty() ? key->choices : std::vector<std::string>{""};
}

// As a scene would set it, with these KEY=VALUE of the kind's table. A kind without keys for any choice has its
// defaults.
DeformerSpec spec_with(const DeformerKind& kind, const std::vector<std::string>& keys)
{
    DeformerSpec spec = default_spec(kind.name);
    if (keys.empty() || !kind.read) return spec;
    const bool in_list = scene_schema().is_list(kind.name);
    std::vector<std::string> overrides = stated_in_every_scene;
    for (const std::string& key : keys) overrides.push_back(kind.name + "." + key);
    const std::string list = in_list ? "[[" + kind.name + "]]\nname = \"" + kind.name + "\"\n" : "";
    const SceneValues values("schema = 1\n" + list, "bench", overrides, scene_schema());
    kind.read(values, in_list ? kind.name + ".0" : kind.name, spec);
    return spec;
}

// Seconds of one frame, away from rest and back, repeated so often that reading the clock does not count.
double frame_seconds(Deformer& deformer, const BenchBody& body)
{
    constexpr double shortest_sample_s = 2e-4;
    const pbs::Pose rest(body.pose.size(), Eigen::Isometry3d::Identity());
    int frames = 0;
    double took = 0.0;
    while (took < shortest_sample_s) {
        const int pairs = std::max(frames, 2) / 2;
        took += cpu_seconds([&] {
            for (int pair = 0; pair < pairs; ++pair) {
                deformer.advance(body.pose, time_step_s);
                deformer.advance(rest, time_step_s);
            }
        });
        frames += 2 * pairs;
    }
    return took / frames;
}

// All have been reset and posed once. What LBS and the set-up of a frame take is in the frame with twice the iterations
// too, so that the difference is that of further iterations. Without it, or where a disturbance hides it, an iteration
// is an equal share of the frame.
struct Timed {
    const DeformerSetting* setting;
    std::unique_ptr<Deformer> once, twice;
    int iterations = 0;
    double first_s = 0.0;  // reset and first frame

    std::vector<double> round(const BenchBody& body) const
    {
        const double frame = frame_seconds(*once, body);
        const double share = frame / std::max(iterations, 1);
        const double further = twice ? (frame_seconds(*twice, body) - frame) / iterations : share;
        return {frame, further > 0.0 ? further : share};
    }
};

double first_frame_seconds(Deformer& deformer, const BenchBody& body)
{
    return cpu_seconds([&] {
        deformer.reset(body.character);
        deformer.advance(body.pose, time_step_s);
    });
}

nlohmann::json entry_of(const Timed& timed, const Samples& own, const BenchBody& body)
{
    const DeformerSetting& setting = *timed.setting;
    const Spread step = spread_of(own[iteration_s]);
    nlohmann::json entry = {{"deformer", setting.spec.kind},
                            {"order", setting.order},
                            {"precision", setting.precision},
                            {"threads", 1},
                            {"ms_first", 1e3 * timed.first_s}};
    put_spread(entry, "ms_frame", scaled(spread_of(own[frame_s]), 1e3));
    if (timed.iterations > 0) {
        entry["iterations"] = timed.iterations;
        put_spread(entry, "ms_iteration", scaled(step, 1e3));
    }
    put_spread(entry, "ns_tet", scaled(step, 1e9 / double(body.mesh().tets.rows())));
    put_spread(entry, "ns_vertex", scaled(step, 1e9 / double(body.mesh().rest.rows())));
    return entry;
}

void append_settings(nlohmann::json& entries, const std::vector<DeformerSetting>& settings, const BenchBody& body,
                     const Rounds& rounds)
{
    std::vector<Timed> timed;
    for (const DeformerSetting& setting : settings) {
        timed.push_back(
            {&setting, make_deformer(setting.spec), nullptr, traits_of(setting.spec).iterations.value_or(0)});
        timed.back().first_s = first_frame_seconds(*timed.back().once, body);
        if (!setting.twice || timed.back().iterations == 0) continue;
        timed.back().twice = make_deformer(*setting.twice);
        first_frame_seconds(*timed.back().twice, body);
    }
    std::vector<TimedVariant> turns;
    for (const Timed& deformer : timed) turns.push_back([&deformer, &body] { return deformer.round(body); });
    const std::vector<Samples> samples = take_turns(turns, rounds);
    for (std::size_t i = 0; i < timed.size(); ++i) {
        entries.push_back(entry_of(timed[i], samples[i], body));
        put_spread(entries.back(), "ratio_to_plain",
                   spread_of_ratios(samples[settings[i].plain][iteration_s], samples[i][iteration_s]));
    }
}

// Linear tets, bones held by smooth springs. A frame is solved from the rest pose; an iteration of nonlinear elements
// is a Newton step. The finite elements have no plain implementation, so there is no ratio.
void append_finite_elements(nlohmann::json& entries, reference_fem::Model model, const BenchBody& body,
                            const Rounds& rounds)
{
    DeformerSetting setting{default_spec("fem"), {}, "", "f64"};
    auto& options = options_of<FemOptions>(setting.spec);
    options.element_order = 1;
    options.model = model;
    Timed timed{&setting, make_deformer(setting.spec), nullptr};
    timed.first_s = first_frame_seconds(*timed.once, body);
    const pbs::Pose rest(body.pose.size(), Eigen::Isometry3d::Identity());
    pbs::StepSummary last;
    const TimedVariant frame = [&] {
        timed.once->advance(rest, time_step_s);
        const double seconds = cpu_seconds([&] { last = timed.once->advance(body.pose, time_step_s); });
        return std::vector{seconds, seconds / std::max(last.iterations, 1)};
    };
    const Samples samples = take_turns({frame}, rounds)[0];
    timed.iterations = last.iterations;
    entries.push_back(entry_of(timed, samples, body));
    entries.back()["model"] = name_of(model);
    entries.back()["reached"] = last.outcome == pbs::Outcome::finished;
}

// The order `plain` in the same precision where there is one; else plain code in f64; else code in f64 (a kind with one
// implementation); else the first.
std::size_t place_of_plain(const std::vector<DeformerSetting>& settings, const std::string& precision)
{
    const auto place_where = [&](const auto& is_plain) {
        return static_cast<std::size_t>(std::find_if(settings.begin(), settings.end(), is_plain) - settings.begin());
    };
    const std::size_t candidates[] = {
        place_where([&](const DeformerSetting& deformer_setting) {
            return deformer_setting.order == "plain" && deformer_setting.precision == precision;
        }),
        place_where([](const DeformerSetting& deformer_setting) {
            return deformer_setting.order == "plain" && deformer_setting.precision == "f64";
        }),
        place_where([](const DeformerSetting& deformer_setting) { return deformer_setting.precision == "f64"; })};
    for (const std::size_t place : candidates)
        if (place < settings.size()) return place;
    return 0;
}

}  // namespace

std::vector<DeformerSetting> deformer_settings(const DeformerKind& kind)
{
    std::vector<DeformerSetting> settings;
    const bool has_packed = key_of(kind, "packed") != nullptr;
    for (const std::string& order : choices_of(kind, "order"))
        for (const std::string& precision : choices_of(kind, "precision"))
            for (const std::string packed : {"true", "false"}) {
                if (packed == "false" && (!has_packed || precision == "f32")) continue;  // plain code is in f64
                std::vector<std::string> keys;
                if (!order.empty()) keys.push_back("order=" + order);
                if (!precision.empty()) keys.push_back("precision=" + precision);
                if (has_packed) keys.push_back("packed=" + packed);
                DeformerSetting setting{spec_with(kind, keys), {}, order, precision};
                const DeformerTraits traits = traits_of(setting.spec);
                if (precision.empty()) setting.precision = traits.precision;
                if (has_packed) setting.order = traits.packed ? "packed" : "plain";
                if (key_of(kind, "iterations") && traits.iterations.value_or(0) > 0) {
                    keys.push_back("iterations=" + std::to_string(2 * *traits.iterations));
                    setting.twice = spec_with(kind, keys);
                }
                settings.push_back(std::move(setting));
            }
    for (DeformerSetting& setting : settings) setting.plain = place_of_plain(settings, setting.precision);
    return settings;
}

nlohmann::json time_deformers(const BenchBody& body, const Rounds& rounds)
{
    nlohmann::json entries = nlohmann::json::array();
    const auto append = [&](const std::string& deformer, Eigen::Index most_tets, const auto& timings) {
        if (body.mesh().tets.rows() > most_tets) return;
        try {
            timings();
        } catch (const pbs::InputError& error) {
            entries.push_back({{"deformer", deformer}, {"left_out", error.what()}});
        }
    };
    for (const DeformerKind& kind : deformer_kinds()) {
        if (kind.needs_list) continue;  // there is none without a table in a scene
        append(kind.name, kind.name == "lbs" || kind.name == "dqs" ? most_blend_tets : most_deformer_tets,
               [&] { append_settings(entries, deformer_settings(kind), body, rounds); });
    }
    const Rounds of_solves = {
        .seconds = 4.0 * rounds.seconds, .fewest = std::min(rounds.fewest, 2), .most = std::min(rounds.most, 11)};
    using enum reference_fem::Model;
    for (const auto& [model, most_tets] :
         {std::pair(linear, most_fem_tets), std::pair(stable_neo_hookean, most_newton_tets)})
        append("fem", most_tets, [&, model = model] { append_finite_elements(entries, model, body, of_solves); });
    return entries;
}

}  // namespace experiments
