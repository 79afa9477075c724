#include "experiments/rigs/fbx_transform.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace pbs {
namespace {

constexpr std::array<std::array<int, 3>, 6> axes_in_order = {
    {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}, {1, 0, 2}, {2, 0, 1}, {2, 1, 0}}};

// x(t) = 3 a (1-t)^2 t + 3 (1-b) (1-t) t^2 + t^3 rises for weights a, b in [0, 1], so that bisection finds the one t
// with x(t) = share.
double bezier_parameter(double share, double a, double b)
{
    double low = 0.0, high = 1.0;
    for (int halving = 0; halving < 60; ++halving) {
        const double t = 0.5 * (low + high), u = 1.0 - t;
        (3.0 * a * u * u * t + 3.0 * (1.0 - b) * u * t * t + t * t * t < share ? low : high) = t;
    }
    return 0.5 * (low + high);
}

double cubic_value(const FbxKey& key, const FbxKey& next, double time_s)
{
    const double duration_s = next.time_s - key.time_s,
                 t = bezier_parameter((time_s - key.time_s) / duration_s, key.weight, key.next_weight);
    const double after = key.value + key.slope * key.weight * duration_s,
                 before = next.value - key.next_slope * key.next_weight * duration_s;
    const double u = 1.0 - t;
    return u * u * u * key.value + 3.0 * u * u * t * after + 3.0 * u * t * t * before + t * t * t * next.value;
}

}  // namespace

Eigen::Matrix3d euler_rotation(const Vec3& degrees, int order)
{
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    for (const int axis : axes_in_order[static_cast<std::size_t>(order)])
        rotation = Eigen::AngleAxisd(degrees(axis) * std::numbers::pi / 180.0, Vec3::Unit(axis)) * rotation;
    return rotation;
}

FbxPlacement placed_below(const FbxPlacement& parent, const FbxTransform& node)
{
    const auto& [translation, rotation_deg, scale] = node.lcl;
    const Eigen::Matrix3d rotation = euler_rotation(node.pre_rotation_deg, 0) *
                                     euler_rotation(rotation_deg, node.rotation_order) *
                                     euler_rotation(node.post_rotation_deg, 0).transpose();
    const Vec3 behind_rotation =
        // Rp^-1 Soff Sp S Sp^-1 0
        node.scaling_offset + node.scaling_pivot - scale.cwiseProduct(node.scaling_pivot) - node.rotation_pivot;
    const Vec3 place = translation + node.rotation_offset + node.rotation_pivot + rotation * behind_rotation;

    FbxPlacement placed;
    placed.rotation = parent.rotation * rotation;
    placed.own_scale = scale;
    placed.world.translation() = parent.world * place;
    Eigen::Matrix3d axes = parent.world.linear() * rotation;  // RSrs
    if (node.inheritance == FbxInheritance::Rrs)              // what the parent scales to nothing stays nothing
        axes = parent.world.linear() *
               parent.own_scale.unaryExpr([](double s) { return s != 0.0 ? 1.0 / s : 0.0; }).asDiagonal() * rotation;
    else if (node.inheritance == FbxInheritance::RrSs)
        axes = placed.rotation * parent.rotation.transpose() * parent.world.linear();
    placed.world.linear() = axes * scale.asDiagonal();
    return placed;
}

double value_at(const FbxCurve& curve, double time_s)
{
    const auto next = std::ranges::upper_bound(curve, time_s, {}, &FbxKey::time_s);
    if (next == curve.begin()) return next->value;
    const FbxKey& key = *std::prev(next);
    if (next == curve.end() || key.interpolation == FbxInterpolation::constant) return key.value;
    if (key.interpolation == FbxInterpolation::cubic) return cubic_value(key, *next, time_s);
    const double share = (time_s - key.time_s) / (next->time_s - key.time_s);
    if (key.interpolation == FbxInterpolation::constant_next) return share > 0.0 ? next->value : key.value;
    return key.value + share * (next->value - key.value);
}

FbxTransform transform_at(FbxTransform node, const FbxTracks& tracks, double time_s)
{
    for (std::size_t property = 0; property < 3; ++property)
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (const auto& curve = tracks[property][axis])
                node.lcl[property](static_cast<int>(axis)) = value_at(*curve, time_s);
    return node;
}

}  // namespace pbs
