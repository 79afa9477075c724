// LBS and DQS, plain (blend.hpp) and packed (blend.hpp), in ns per vertex, compared with a copy of the same number of bytes.
// Ratios of one run are meaningful; absolute times depend on the machine and its state.
//   limb, human: the built-in characters    paper: two bones and Eq. 2's weights, ordered along them    mixed: the same in random order
//   smooth: four bones of twenty and weights of its own for every vertex
//   build/release/tests/benchmark_blend --benchmark_filter=paper
#include "pbs/character/bodies.hpp"
#include "pbs/skinning/blend.hpp"
#include "tests/support/random_points.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>

namespace {

using namespace pbs;

struct PosedBody {
    Positions rest;
    Weights weights;
    Pose pose;
};

PosedBody paper_body(int vertices, bool mixed)
{
    const Skeleton skeleton = {{{"upper", -1, {-1, 0, 0}, {0, 0, 0}}, {"forearm", 0, {0, 0, 0}, {1, 0, 0}}}};
    test_support::RandomPoints random(1);
    PosedBody body;
    body.rest.resize(vertices, 3);
    for (int i = 0; i < vertices; ++i) {
        body.rest.row(i) = random.point(1.0).cwiseProduct(Vec3(1.0, 0.15, 0.15));
        if (!mixed) body.rest(i, 0) = 2.0 * i / vertices - 1.0;
    }
    body.weights = paper_weights(bind_to_nearest_bone(body.rest, skeleton), skeleton);
    body.pose = joint_sweep(skeleton, 1, Vec3::UnitZ(), 60.0, 2, 0.01).steps[1];
    return body;
}

PosedBody smooth_body(int vertices)
{
    test_support::RandomPoints random(2);
    PosedBody body{Positions(vertices, 3), {{0}, {}, {}}, {}};
    for (int bone = 0; bone < 20; ++bone) body.pose.push_back(random.rigid_motion(1.0));
    for (int i = 0; i < vertices; ++i) {
        body.rest.row(i) = random.point(1.0);
        const double along = 17.0 * i / vertices, part = along - static_cast<int>(along);
        const double weights[] = {0.4 * (1.0 - part), 0.3, 0.3, 0.4 * part};
        for (int k = 0; k < 4; ++k) {
            body.weights.bone.push_back(static_cast<int>(along) + k);
            body.weights.weight.push_back(weights[k]);
        }
        body.weights.first.push_back(4 * (i + 1));
    }
    return body;
}

PosedBody character_body(const std::string& name)
{
    const Character character = make_character({.body = name});
    test_support::RandomPoints random(3);
    PosedBody body{character.mesh.rest, character.weights, {}};
    for (std::size_t bone = 0; bone < character.skeleton.bones.size(); ++bone) body.pose.push_back(random.rigid_motion(1.0));
    return body;
}

const PosedBody& body_of(const std::string& kind, int vertices)
{
    static std::map<std::pair<std::string, int>, PosedBody> bodies;
    const auto place = bodies.find({kind, vertices});
    if (place != bodies.end()) return place->second;
    PosedBody& body = bodies[{kind, vertices}];
    if (kind == "limb" || kind == "human") return body = character_body(kind);
    return body = kind == "smooth" ? smooth_body(vertices) : paper_body(vertices, kind == "mixed");
}

// Seconds per vertex, which the console prints as e.g. 0.52n.
void count_vertices(benchmark::State& state, std::int64_t vertices)
{
    using benchmark::Counter;
    state.counters["s_per_vertex"] = Counter(static_cast<double>(vertices), Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void plain(benchmark::State& state, const std::string& kind, decltype(linear_blend_skinning) blend)
{
    const PosedBody& body = body_of(kind, static_cast<int>(state.range(0)));
    Positions posed;
    for (auto _ : state) blend(body.rest, body.weights, body.pose, posed);
    count_vertices(state, body.rest.rows());
}

template <class Scalar>
using RawBlend = void (BlendSkinning<Scalar>::*)(const Pose&, const Vec3&, Scalar*);

template <class Scalar>
void packed(benchmark::State& state, const std::string& kind, RawBlend<Scalar> blend)
{
    const PosedBody& body = body_of(kind, static_cast<int>(state.range(0)));
    BlendSkinning<Scalar> skinning(body.rest, body.weights);
    std::vector<Scalar> posed(body.rest.size());
    for (auto _ : state) {
        (skinning.*blend)(body.pose, Vec3::Zero(), posed.data());
        benchmark::ClobberMemory();
    }
    count_vertices(state, body.rest.rows());
}

// Copies the minimum that a blend must read and write: rest and posed positions.
template <class Scalar>
void copy(benchmark::State& state)
{
    const std::vector<Scalar> from(3 * state.range(0), Scalar(1));
    std::vector<Scalar> to(from.size());
    for (auto _ : state) {
        std::ranges::copy(from, to.begin());
        benchmark::ClobberMemory();
    }
    count_vertices(state, state.range(0));
    state.SetBytesProcessed(state.iterations() * 2 * sizeof(Scalar) * from.size());
}

using Sizes = std::vector<std::int64_t>;

template <class Scalar>
void register_packed(const std::string& kind, const std::string& precision, const Sizes& sizes)
{
    const RawBlend<Scalar> linear = &BlendSkinning<Scalar>::linear_rows, dual = &BlendSkinning<Scalar>::dual_quaternion_rows;
    benchmark::RegisterBenchmark((kind + "/lbs/packed_" + precision).c_str(), packed<Scalar>, kind, linear)->ArgsProduct({sizes});
    benchmark::RegisterBenchmark((kind + "/dqs/packed_" + precision).c_str(), packed<Scalar>, kind, dual)->ArgsProduct({sizes});
}

void register_kind(const std::string& kind, const Sizes& sizes)
{
    benchmark::RegisterBenchmark((kind + "/lbs/plain_f64").c_str(), plain, kind, linear_blend_skinning)->ArgsProduct({sizes});
    benchmark::RegisterBenchmark((kind + "/dqs/plain_f64").c_str(), plain, kind, dual_quaternion_skinning)->ArgsProduct({sizes});
    register_packed<float>(kind, "f32", sizes);
    register_packed<double>(kind, "f64", sizes);
}

void register_all()
{
    const Sizes sizes = {2'000, 20'000, 1'000'000}, its_own = {0};
    for (const std::string kind : {"limb", "human"}) register_kind(kind, its_own);
    for (const std::string kind : {"paper", "mixed", "smooth"}) register_kind(kind, sizes);
    benchmark::RegisterBenchmark("copy/f32", copy<float>)->ArgsProduct({sizes});
    benchmark::RegisterBenchmark("copy/f64", copy<double>)->ArgsProduct({sizes});
}

}  // namespace

int main(int argc, char** argv)
{
    register_all();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
}
