// Bones as rigid capsules in the flesh and the springs that hold flesh by them (bone_capsules, sample_points,
// smooth_density, bone_springs), and the paper's jiggling zone on a body (zone_contents).

#include "experiments/characters/bone_capsules.hpp"

#include "experiments/characters/skinning_weights.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>

namespace pbs {
namespace {

constexpr double middle_begin = 1.0 / 6.0, middle_end = 5.0 / 6.0;  // Eq. 2

struct Mean {
    double sum = 0.0;
    int count = 0;

    void add(double value)
    {
        sum += value;
        ++count;
    }
    double value() const { return sum / count; }
};

// Mean distances of skin vertices to their nearest bones [m].
struct LimbRadii {
    std::vector<Mean> on_middle;  // #bones; over the vertices that project on the middle of the bone
    std::vector<Mean> on_bone;    // #bones; over all vertices that are nearest to the bone
    Mean on_skeleton;             // over all vertices
};

LimbRadii limb_radii(const Character& character)
{
    const BoneBinding& binding = character.binding;
    const std::vector<bool> skin = boundary_vertices(character.mesh.tets, character.mesh.rest.rows());
    const std::size_t bones = character.skeleton.bones.size();
    LimbRadii radii{std::vector<Mean>(bones), std::vector<Mean>(bones), {}};
    for (std::size_t v = 0; v < skin.size(); ++v) {
        if (!skin[v]) continue;
        const double distance = binding.distance(v);
        const double parameter = binding.parameter(v);
        radii.on_skeleton.add(distance);
        radii.on_bone[binding.bone[v]].add(distance);
        if (parameter >= middle_begin && parameter <= middle_end) radii.on_middle[binding.bone[v]].add(distance);
    }
    return radii;
}

// The vertices of a zone, grouped by the edges inside it, with the largest piece first.
std::vector<std::vector<int>> pieces_of(const std::vector<bool>& zone, const Tets& tets)
{
    const Adjacency edges = adjacency_of(tets, static_cast<int>(zone.size()));
    std::vector<bool> seen(zone.size(), false);
    std::vector<std::vector<int>> pieces;
    for (int start = 0; start < static_cast<int>(zone.size()); ++start) {
        if (!zone[start] || seen[start]) continue;
        std::vector<int> piece = {start};
        seen[start] = true;
        for (std::size_t next = 0; next < piece.size(); ++next)
            for (int i = edges.first[piece[next]]; i < edges.first[piece[next] + 1]; ++i) {
                const int neighbour = edges.neighbour[i];
                if (!zone[neighbour] || seen[neighbour]) continue;
                seen[neighbour] = true;
                piece.push_back(neighbour);
            }
        pieces.push_back(std::move(piece));
    }
    std::stable_sort(pieces.begin(), pieces.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
    return pieces;
}

// The bones with vertices in the zone. The bone that has the largest share of the zone is the first one.
std::vector<BoneInZone> bones_of(const std::vector<bool>& zone, const Character& character)
{
    std::vector<int> bound(character.skeleton.bones.size(), 0);  // vertices that are bound to each bone
    std::vector<int> inside(bound);                              // those of them in the zone
    for (std::size_t v = 0; v < zone.size(); ++v) {
        ++bound[character.binding.bone[v]];
        inside[character.binding.bone[v]] += zone[v];
    }
    const double in_zone = static_cast<double>(std::count(zone.begin(), zone.end(), true));
    std::vector<BoneInZone> bones;
    for (std::size_t b = 0; b < bound.size(); ++b)
        if (inside[b] > 0)
            bones.push_back(
                {character.skeleton.bones[b].name, inside[b] / in_zone, static_cast<double>(inside[b]) / bound[b]});
    std::stable_sort(bones.begin(), bones.end(),
                     [](const auto& a, const auto& b) { return a.share_of_zone > b.share_of_zone; });
    return bones;
}

// Collects springs one by one. end() writes them into `held`.
class SpringList {
public:
    explicit SpringList(CapsuleSprings& held) : held_(held) {}

    void add(const Vec3& point, int bone, double density, double stiffness_m)
    {
        points_.push_back(point);
        stiffness_m_.push_back(stiffness_m);
        held_.springs.bone.push_back(bone);
        held_.density.push_back(density);
    }
    const std::vector<Vec3>& points() const { return points_; }
    void end()
    {
        const auto springs = static_cast<Eigen::Index>(stiffness_m_.size());
        held_.springs.points.resize(springs, 3);
        for (Eigen::Index s = 0; s < springs; ++s) held_.springs.points.row(s) = points_[static_cast<std::size_t>(s)];
        held_.springs.stiffness = Eigen::VectorXd::Map(stiffness_m_.data(), springs);
    }

private:
    CapsuleSprings& held_;
    std::vector<Vec3> points_;
    std::vector<double> stiffness_m_;
};

// Barycentric coordinates of the quadrature rule of degree 2 in a tet (Hammer, Marlowe, Stroud 1956): each point is
// near one corner and equally far from the three others.
constexpr double near = 0.585410196624968515;  // (5 + 3 sqrt 5) / 20
constexpr double far = 0.138196601125010504;   // (5 - sqrt 5) / 20

// The four points of the rule [m], 4 x 3.
Eigen::Matrix<double, 4, 3> quadrature_points(const TetMesh& mesh, Eigen::Index tet)
{
    Eigen::Matrix<double, 4, 3> corners;
    for (int i = 0; i < 4; ++i) corners.row(i) = mesh.rest.row(mesh.tets(tet, i));
    return ((near - far) * corners).rowwise() + far * corners.colwise().sum();
}

// The stiffness of the spring at each of the four points in a tet that a bone holds rigidly, over Young's modulus [m].
double rigid_stiffness_m(const BoneCapsule& capsule, double volume_m3)
{
    return rigid_spring_factor / (capsule.radius_m * capsule.radius_m) * volume_m3 / 4.0;
}

// Adds stiff springs throughout the tets that one bone alone moves.
void hold_what_one_bone_moves(const Character& coarse, const std::vector<BoneCapsule>& rigid, SpringList& springs)
{
    const std::vector<int> alone = bones_that_move_alone(coarse);
    const Eigen::VectorXd volumes_m3 = tet_volumes(coarse.mesh.rest, coarse.mesh.tets);
    for (std::size_t tet = 0; tet < alone.size(); ++tet) {
        if (alone[tet] < 0) continue;
        const double stiffness_m = rigid_stiffness_m(rigid[alone[tet]], volumes_m3(tet));
        const Eigen::Matrix<double, 4, 3> points = quadrature_points(coarse.mesh, tet);
        for (int i = 0; i < 4; ++i) springs.add(points.row(i), alone[tet], 1.0, stiffness_m);
    }
}

// The separate parts that could turn freely, since their springs do not span a plane. part: the part of each tet
// (parts_of), #T.
std::set<int> loose_parts(const TetMesh& mesh, const std::vector<int>& part, const SpringList& springs)
{
    constexpr double rounding = 1e-12;
    struct PointMoments {
        double points = 0.0;
        Vec3 sum = Vec3::Zero();
        Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    };
    std::map<int, PointMoments> moments_of_part;
    const PointLocation location(mesh);
    for (const Vec3& point : springs.points())
        if (const Eigen::Index tet = location.locate(point).tet; tet >= 0) {
            PointMoments& moments = moments_of_part[part[static_cast<std::size_t>(tet)]];
            ++moments.points;
            moments.sum += point;
            moments.squares += point * point.transpose();
        }
    std::set<int> loose(part.begin(), part.end());
    for (const auto& [held_part, moments] : moments_of_part) {
        const Eigen::Matrix3d scatter = moments.squares - moments.sum * moments.sum.transpose() / moments.points;
        const Vec3 spread =
            Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter, Eigen::EigenvaluesOnly).eigenvalues();
        if (spread(1) > rounding * moments.squares.trace()) loose.erase(held_part);
    }
    return loose;
}

// The artist's weight of each bone at the quadrature point of a tet that is near the given corner.
std::map<int, double> weights_at_point(const Weights& weights, const Tets& tets, Eigen::Index tet, int near_corner)
{
    std::map<int, double> weight_of_bone;
    for (int corner = 0; corner < 4; ++corner) {
        const int vertex = tets(tet, corner);
        for (int e = weights.first[vertex]; e < weights.first[vertex + 1]; ++e)
            weight_of_bone[weights.bone[e]] += (corner == near_corner ? near : far) * weights.weight[e];
    }
    return weight_of_bone;
}

// Adds springs that let each loose part follow linear blend skinning: several springs at one point, from each of its
// bones and with a stiffness proportional to the weight of the bone, act as one spring to the point's place by linear
// blend skinning.
void hold_loose_parts(const Character& coarse, const std::vector<BoneCapsule>& rigid, SpringList& springs,
                      CapsuleSprings& held)
{
    const std::vector<int> part = parts_of(coarse.mesh.tets);
    if (std::ranges::count(part, 0) == std::ranges::ssize(part)) return;
    const std::set<int> loose = loose_parts(coarse.mesh, part, springs);
    const Eigen::VectorXd volumes_m3 = tet_volumes(coarse.mesh.rest, coarse.mesh.tets);
    const Weights& weights = coarse.artist->weights;
    for (Eigen::Index tet = 0; tet < coarse.mesh.tets.rows(); ++tet) {
        if (!loose.contains(part[static_cast<std::size_t>(tet)])) continue;
        held.loose_share += volumes_m3(tet) / volumes_m3.sum();
        const Eigen::Matrix<double, 4, 3> points = quadrature_points(coarse.mesh, tet);
        for (int i = 0; i < 4; ++i) {
            const std::map<int, double> weight_of_bone = weights_at_point(weights, coarse.mesh.tets, tet, i);
            const int heaviest =
                std::ranges::max_element(weight_of_bone, {}, [](const auto& entry) { return entry.second; })->first;
            const double stiffness_m = rigid_stiffness_m(rigid[heaviest], volumes_m3(tet));
            for (const auto& [bone, weight] : weight_of_bone)
                if (weight > 0.0) springs.add(points.row(i), bone, weight, weight * stiffness_m);
        }
    }
    held.loose_parts = static_cast<int>(loose.size());
}

}  // namespace

bool BoneCapsule::contains(const Vec3& point) const
{
    const Vec3 axis = end - start;
    const double parameter = (point - start).dot(axis) / axis.squaredNorm();
    return parameter >= 0.0 && parameter <= 1.0 && (point - start - parameter * axis).norm() <= radius_m;
}

double BoneCapsule::volume_m3() const
{
    return std::numbers::pi * radius_m * radius_m * (end - start).norm();
}

std::vector<BoneCapsule> bone_capsules(const Character& character, double core_radius)
{
    if (character.unrefined) return bone_capsules(*character.unrefined, core_radius);
    const LimbRadii radii = limb_radii(character);
    std::vector<BoneCapsule> capsules;
    for (std::size_t j = 0; j < character.skeleton.bones.size(); ++j) {
        const Bone& bone = character.skeleton.bones[j];
        const Vec3 axis = bone.tail - bone.head;
        if (!(axis.norm() > 0.0)) throw InputError(character.name, 0, "bone", bone.name, "expected a length above 0");
        BoneCapsule capsule{bone.head + middle_begin * axis, bone.head + middle_end * axis, 0.0, "skin on its middle"};
        Mean radius = radii.on_middle[j];
        if (radius.count == 0) {
            radius = radii.on_bone[j];
            capsule.radius_from = "skin nearest to it";
        }
        if (radius.count == 0) {
            radius = radii.on_skeleton;
            capsule.radius_from = "the whole skin";
        }
        capsule.radius_m = core_radius * radius.value();
        capsules.push_back(capsule);
    }
    return capsules;
}

Positions sample_points(const BoneCapsule& capsule, int samples)
{
    if (samples < 1)
        throw std::invalid_argument("sample_points: expected samples of at least 1, not " + std::to_string(samples));
    const int stations = 40 * samples;
    const int rings = 8 * samples;
    const int spokes = 24 * samples;
    const int points_per_disc = 1 + rings * spokes;
    const Vec3 axis = capsule.end - capsule.start;
    const Vec3 across = axis.unitOrthogonal();
    const Vec3 binormal = axis.normalized().cross(across);
    Positions points(stations * points_per_disc, 3);
    Eigen::Index next = 0;
    for (int station = 0; station < stations; ++station) {
        const Vec3 centre = capsule.start + (station + 0.5) / stations * axis;
        points.row(next++) = centre;
        for (int ring = 0; ring < rings; ++ring) {
            // The points further in and half of this ring's own points lie within this radius, and so does their share
            // of the area.
            const double radius = capsule.radius_m * std::sqrt((1.0 + spokes * (ring + 0.5)) / points_per_disc);
            for (int spoke = 0; spoke < spokes; ++spoke) {
                const double angle = 2.0 * std::numbers::pi * spoke / spokes;
                points.row(next++) = centre + radius * (std::cos(angle) * across + std::sin(angle) * binormal);
            }
        }
    }
    return points;
}

double smooth_density(const BoneCapsule& capsule, AttachmentKernel kernel, double ends, const Vec3& point)
{
    const double length = (capsule.end - capsule.start).norm();
    const double along = (point - capsule.start).dot(capsule.end - capsule.start) / length;
    const double from_end = std::min(along, length - along);
    const double s = (point - capsule.start).cross(capsule.end - capsule.start).norm() / (length * capsule.radius_m);
    if (from_end <= 0.0 || s >= 1.0) return 0.0;
    const double t = std::min(1.0, from_end / std::min(ends * capsule.radius_m, length / 2.0));
    switch (kernel) {
        case AttachmentKernel::biweight:
            return std::pow(1.0 - s * s, 2) * (3.0 - 2.0 * t) * t * t;
        case AttachmentKernel::wendland:
            return std::pow(1.0 - s, 4) * (4.0 * s + 1.0) * ((6.0 * t - 15.0) * t + 10.0) * t * t * t;
    }
    return 0.0;
}

std::vector<int> bones_that_move_alone(const Character& character)
{
    Weights weights = character.artist ? character.artist->weights : weights_by(WeightKind::diffused, character);
    if (!character.moves_with.empty())
        for (int& bone : weights.bone) bone = character.moves_with[static_cast<std::size_t>(bone)];
    std::vector<int> bone_of_tet;
    for (const auto corners : character.mesh.tets.rowwise()) {
        const auto is_moved_alone_by = [&](int bone) {
            return std::ranges::all_of(corners, [&](int v) { return weights.of(v, bone) > weight_alone; });
        };
        const int first = corners(0);
        const auto begin = weights.bone.begin() + weights.first[first];
        const auto end = weights.bone.begin() + weights.first[first + 1];
        const auto bone = std::find_if(begin, end, is_moved_alone_by);
        bone_of_tet.push_back(bone == end ? -1 : *bone);
    }
    return bone_of_tet;
}

CapsuleSprings bone_springs(const Character& character, SpringPlacement placement, const SmoothSpringOptions& options)
{
    CapsuleSprings held{.capsules = bone_capsules(character, options.core_radius), .springs = {}, .density = {}};
    SpringList springs(held);
    const PointLocation location(character.mesh);
    // Where the flesh is cut between parts, a bone has no springs in tets that it does not move.
    const auto may_hold = [&](const Vec3& point, int bone) {
        if (!character.artist || !character.artist->is_cut) return true;
        const Eigen::Index tet = location.locate(point).tet;
        const Weights& weights = character.artist->weights;
        return tet < 0 ||
               std::ranges::any_of(character.mesh.tets.row(tet), [&](int v) { return weights.of(v, bone) >= 0.25; });
    };
    for (std::size_t j = 0; j < held.capsules.size(); ++j) {
        const BoneCapsule& capsule = held.capsules[j];
        const Positions points = sample_points(capsule, options.samples);
        const double on_axis = options.spring_factor / (capsule.radius_m * capsule.radius_m);
        for (const auto& row : points.rowwise()) {
            const Vec3 point = row.transpose();
            if (!may_hold(point, static_cast<int>(j))) continue;
            const double density = placement == SpringPlacement::embedded
                                       ? 1.0
                                       : smooth_density(capsule, options.kernel, options.ends, point);
            springs.add(point, static_cast<int>(j), density,
                        on_axis * density * capsule.volume_m3() / static_cast<double>(points.rows()));
        }
    }
    if (placement == SpringPlacement::held) {
        const Character& coarse = character.unrefined ? *character.unrefined : character;
        const std::vector<BoneCapsule> rigid = bone_capsules(coarse, rigid_core_radius);
        hold_what_one_bone_moves(coarse, rigid, springs);
        if (has_artist_weights(coarse)) hold_loose_parts(coarse, rigid, springs, held);
    }
    springs.end();
    return held;
}

ZoneContents zone_contents(const Character& character)
{
    const std::vector<bool> zone = jiggle_zone(character.binding);
    const std::vector<bool> skin = boundary_vertices(character.mesh.tets, character.mesh.rest.rows());
    ZoneContents contents;
    contents.pieces = pieces_of(zone, character.mesh.tets);
    contents.bones = bones_of(zone, character);
    double inside = 0.0;   // vertices in the zone
    double on_skin = 0.0;  // those of them on the skin
    for (std::size_t v = 0; v < zone.size(); ++v) {
        inside += zone[v];
        on_skin += zone[v] && skin[v];
    }
    contents.share = zone.empty() ? 0.0 : inside / static_cast<double>(zone.size());
    contents.skin_share = inside > 0.0 ? on_skin / inside : 0.0;
    return contents;
}

}  // namespace pbs
