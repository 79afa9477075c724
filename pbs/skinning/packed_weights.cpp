#include "pbs/skinning/blend.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <span>
#include <utility>

namespace pbs {
namespace {

std::span<const int> bones_of(const Weights& weights, int vertex)
{
    return {weights.bone.data() + weights.first[vertex], weights.bone.data() + weights.first[vertex + 1]};
}

std::span<const double> weights_of(const Weights& weights, int vertex)
{
    return {weights.weight.data() + weights.first[vertex], weights.weight.data() + weights.first[vertex + 1]};
}

Weights without_zeros(const Weights& weights)
{
    Weights kept{{0}, {}, {}};
    for (int vertex = 0; vertex < weights.vertices(); ++vertex) {
        for (int entry = weights.first[vertex]; entry < weights.first[vertex + 1]; ++entry) {
            if (weights.weight[entry] == 0.0) continue;
            kept.bone.push_back(weights.bone[entry]);
            kept.weight.push_back(weights.weight[entry]);
        }
        kept.first.push_back(static_cast<int>(kept.bone.size()));
    }
    return kept;
}

bool is_rigid(const Weights& weights, int vertex)
{
    return std::ranges::equal(weights_of(weights, vertex), std::array{1.0});
}

bool row_less(const Weights& weights, int a, int b)
{
    if (!std::ranges::equal(bones_of(weights, a), bones_of(weights, b)))
        return std::ranges::lexicographical_compare(bones_of(weights, a), bones_of(weights, b));
    return std::ranges::lexicographical_compare(weights_of(weights, a), weights_of(weights, b));
}

// Appends rows of weights and the turned bones that they use.
template <class Scalar>
class RowWriter {
public:
    RowWriter(const Weights& weights, PackedWeights<Scalar>& packed) : weights_(weights), packed_(packed) {}

    void append(WeightRows<Scalar>& rows, int vertex)
    {
        const auto bones = bones_of(weights_, vertex);
        const auto weights = weights_of(weights_, vertex);
        const auto heaviest = std::ranges::max_element(weights) - weights.begin();
        for (std::size_t entry = 0; entry < bones.size(); ++entry) {
            rows.bone.push_back(bones[entry]);
            rows.turned_bone.push_back(turned_bone({bones[entry], bones[heaviest]}));
            rows.weight.push_back(static_cast<Scalar>(weights[entry]));
        }
        rows.first.push_back(static_cast<int>(rows.bone.size()));
    }

private:
    int turned_bone(const TurnedBone& bone)
    {
        const auto [place, is_new] = index_.try_emplace({bone.bone, bone.pivot}, static_cast<int>(packed_.turned_bones.size()));
        if (is_new) packed_.turned_bones.push_back(bone);
        return place->second;
    }

    const Weights& weights_;
    PackedWeights<Scalar>& packed_;
    std::map<std::pair<int, int>, int> index_;
};

// Vertices of several bones, equal rows side by side.
std::vector<int> vertices_by_row(const Weights& weights)
{
    std::vector<int> vertices(weights.vertices());
    std::iota(vertices.begin(), vertices.end(), 0);
    std::erase_if(vertices, [&](int vertex) { return is_rigid(weights, vertex); });
    std::ranges::stable_sort(vertices, [&](int a, int b) { return row_less(weights, a, b); });
    return vertices;
}

template <class Scalar>
void share_rows(const Weights& weights, RowWriter<Scalar>& writer, PackedWeights<Scalar>& packed)
{
    const std::vector<int> vertices = vertices_by_row(weights);
    for (auto begin = vertices.begin(); begin != vertices.end();) {
        const auto end = std::find_if(begin, vertices.end(), [&](int vertex) { return row_less(weights, *begin, vertex); });
        if (end - begin > 1) {
            for (auto vertex = begin; vertex != end; ++vertex) packed.matrix[*vertex] = packed.bones + packed.shared.rows();
            writer.append(packed.shared, *begin);
        }
        begin = end;
    }
}

// A loop of its own pays from some 30 vertices on: it saves 0.2 ns each, and the branch into it, mispredicted, costs some 5 ns.
constexpr int shortest_run = 32;

template <class Scalar>
void cut_into_stretches(PackedWeights<Scalar>& packed)
{
    using enum VertexStretch::Kind;
    const std::vector<int>& matrix = packed.matrix;
    int rows = 0;  // number of own rows that precede these vertices
    for (auto run = matrix.begin(); run != matrix.end();) {
        const auto end = std::find_if(run, matrix.end(), [&](int other) { return other != *run; });
        const auto kind = *run < 0 ? own_rows : end - run < shortest_run ? matrix_each : one_matrix;
        const int first = static_cast<int>(run - matrix.begin()), last = static_cast<int>(end - matrix.begin());
        if (kind == matrix_each && !packed.stretches.empty() && packed.stretches.back().kind == matrix_each)
            packed.stretches.back().last = last;
        else
            packed.stretches.push_back({kind, first, last, rows});
        if (kind == own_rows) rows += last - first;
        run = end;
    }
}

}  // namespace

template <class Scalar>
PackedWeights<Scalar> pack_weights(const Weights& all_weights)
{
    const Weights weights = without_zeros(all_weights);
    PackedWeights<Scalar> packed;
    packed.bones = weights.bone.empty() ? 0 : 1 + *std::ranges::max_element(weights.bone);
    packed.matrix.assign(weights.vertices(), -1);
    for (int vertex = 0; vertex < weights.vertices(); ++vertex)
        if (is_rigid(weights, vertex)) packed.matrix[vertex] = weights.bone[weights.first[vertex]];
    RowWriter<Scalar> writer(weights, packed);
    share_rows(weights, writer, packed);
    for (int vertex = 0; vertex < weights.vertices(); ++vertex)
        if (packed.matrix[vertex] < 0) writer.append(packed.own, vertex);
    cut_into_stretches(packed);
    return packed;
}

template PackedWeights<float> pack_weights(const Weights&);
template PackedWeights<double> pack_weights(const Weights&);

}  // namespace pbs
