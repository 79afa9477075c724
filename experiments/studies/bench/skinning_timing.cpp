#include "experiments/studies/bench/skinning_timing.hpp"

#include "pbs/skinning/blend.hpp"
#include "pbs/skinning/blend_skinning.hpp"

#include <nlohmann/json.hpp>

#include <functional>

namespace experiments {
namespace {

constexpr double shortest_sample_s = 2e-4;  // several poses a sample, so that reading the clock does not count

struct BlendVariant {
    std::string blend, variant, precision;
    double scalar_bytes;
    std::function<void()> pose_once;
};

using PlainBlend = decltype(pbs::linear_blend_skinning);

BlendVariant plain_blend(const BenchBody& body, const char* name, PlainBlend* blend)
{
    const auto posed = std::make_shared<pbs::Positions>();
    return {name, "plain", "f64", 8.0, [&body, blend, posed] { blend(body.mesh().rest, body.character.weights, body.pose, *posed); }};
}

template <typename Scalar>
BlendVariant packed_blend(const BenchBody& body, const char* name,
                          void (pbs::BlendSkinning<Scalar>::*blend)(const pbs::Pose&, const pbs::Vec3&, Scalar*))
{
    const auto skinning = std::make_shared<pbs::BlendSkinning<Scalar>>(body.mesh().rest, body.character.weights);
    const auto posed = std::make_shared<std::vector<Scalar>>(body.mesh().rest.size());
    return {name, "packed", sizeof(Scalar) == 4 ? "f32" : "f64", double(sizeof(Scalar)),
            [&body, blend, skinning, posed] { ((*skinning).*blend)(body.pose, pbs::Vec3::Zero(), posed->data()); }};
}

std::vector<BlendVariant> blend_variants(const BenchBody& body)
{
    using Single = pbs::BlendSkinning<float>;
    using Double = pbs::BlendSkinning<double>;
    return {
        plain_blend(body, "lbs", &pbs::linear_blend_skinning),           packed_blend<float>(body, "lbs", &Single::linear_rows),
        packed_blend<double>(body, "lbs", &Double::linear_rows),         plain_blend(body, "dqs", &pbs::dual_quaternion_skinning),
        packed_blend<float>(body, "dqs", &Single::dual_quaternion_rows), packed_blend<double>(body, "dqs", &Double::dual_quaternion_rows)};
}

// Seconds of one pose.
double time_poses(const BlendVariant& variant)
{
    variant.pose_once();
    int poses = 0;
    const double start = thread_cpu_s();
    double took = 0.0;
    for (int repeats = 1; took < shortest_sample_s; repeats *= 2) {
        for (int i = 0; i < repeats; ++i) variant.pose_once();
        poses += repeats;
        took = thread_cpu_s() - start;
    }
    return took / poses;
}

}  // namespace

std::vector<SkinningTiming> time_skinning(const BenchBody& body, const MachineLimits& limits, const Rounds& rounds)
{
    const std::vector<BlendVariant> variants = blend_variants(body);
    std::vector<TimedVariant> turns;
    for (const BlendVariant& variant : variants) turns.push_back([&variant] { return std::vector<double>{time_poses(variant)}; });
    const auto samples = take_turns(turns, rounds);

    std::vector<SkinningTiming> timings;
    std::size_t plain = 0;  // of the same blend: it stands first
    for (std::size_t i = 0; i < variants.size(); ++i) {
        const BlendVariant& variant = variants[i];
        if (variant.variant == "plain") plain = i;
        const double vertices = double(body.mesh().rest.rows()), bytes = 2.0 * 3.0 * variant.scalar_bytes * vertices;
        const Spread seconds = spread_of(samples[i][0]);
        const double gb_s = 1e-9 * bytes / seconds.median;
        timings.push_back({variant.blend, variant.variant, variant.precision, scaled(seconds, 1e9 / vertices),
                           spread_of_ratios(samples[plain][0], samples[i][0]), gb_s, gb_s / bandwidth_at(limits, bytes)});
    }
    return timings;
}

void to_json(nlohmann::json& json, const SkinningTiming& timing)
{
    json = {{"blend", timing.blend}, {"variant", timing.variant}, {"precision", timing.precision},          {"threads", 1},
            {"clock", "thread_cpu"}, {"gb_s", timing.gb_s},       {"share_of_limit", timing.share_of_limit}};
    put_spread(json, "ns_vertex", timing.ns_vertex);
    put_spread(json, "ratio_to_plain", timing.ratio_to_plain);
}

}  // namespace experiments
