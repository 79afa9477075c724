// LBS and DQS, plain (blend.hpp) and packed (blend_skinning.hpp), in ns a vertex; what is held against them is a copy of as many bytes.
// Read ratios from one run; absolute times are the machine's of that moment.
//   paper: two bones and Eq. 2's weights, long runs of equal ones    mixed: the same, vertices in random order
//   smooth: four bones of twenty and weights of its own for every vertex
//   build/release/tests/benchmark_blend --benchmark_filter=paper
#include "pbs/skinning/blend.hpp"
#include "pbs/skinning/blend_skinning.hpp"
#include "tests/support/random_points.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>
#include <random>

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

const PosedBody& body_of(const std::string& kind, int vertices)
{
    static std::map<std::pair<std::string, int>, PosedBody> bodies;
    const auto place = bodies.find({kind, vertices});
    if (place != bodies.end()) return place->second;
    return bodies[{kind, vertices}] = kind == "smooth" ? smooth_body(vertices) : paper_body(vertices, kind == "mixed");
}

// Seconds a vertex, which the console prints as e.g. 0.52n.
void count_vertices(benchmark::State& state)
{
    using benchmark::Counter;
    state.counters["s_per_vertex"] = Counter(static_cast<double>(state.range(0)), Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void plain(benchmark::State& state, const std::string& kind, decltype(linear_blend_skinning) blend)
{
    const PosedBody& body = body_of(kind, static_cast<int>(state.range(0)));
    Positions posed;
    for (auto _ : state) blend(body.rest, body.weights, body.pose, posed);
    count_vertices(state);
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
    count_vertices(state);
}

// Reads and writes what a blend must at least: rest and posed positions.
template <class Scalar>
void copy(benchmark::State& state)
{
    const std::vector<Scalar> from(3 * state.range(0), Scalar(1));
    std::vector<Scalar> to(from.size());
    for (auto _ : state) {
        std::ranges::copy(from, to.begin());
        benchmark::ClobberMemory();
    }
    count_vertices(state);
    state.SetBytesProcessed(state.iterations() * 2 * sizeof(Scalar) * from.size());
}

const std::vector<std::int64_t> sizes = {2'000, 20'000, 1'000'000};

template <class Scalar>
void register_packed(const std::string& kind, const std::string& precision)
{
    const RawBlend<Scalar> linear = &BlendSkinning<Scalar>::linear, dual = &BlendSkinning<Scalar>::dual_quaternion;
    benchmark::RegisterBenchmark((kind + "/lbs/packed_" + precision).c_str(), packed<Scalar>, kind, linear)->ArgsProduct({sizes});
    benchmark::RegisterBenchmark((kind + "/dqs/packed_" + precision).c_str(), packed<Scalar>, kind, dual)->ArgsProduct({sizes});
}

void register_all()
{
    for (const std::string kind : {"paper", "mixed", "smooth"}) {
        benchmark::RegisterBenchmark((kind + "/lbs/plain_f64").c_str(), plain, kind, linear_blend_skinning)->ArgsProduct({sizes});
        benchmark::RegisterBenchmark((kind + "/dqs/plain_f64").c_str(), plain, kind, dual_quaternion_skinning)->ArgsProduct({sizes});
        register_packed<float>(kind, "f32");
        register_packed<double>(kind, "f64");
    }
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
