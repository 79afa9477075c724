#include "experiments/characters/separated_parts.hpp"

#include "pbs/geometry/extent.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

namespace pbs {
namespace {

const double moved_by_30_deg = 2.0 * std::sin(M_PI / 12.0);  // the way of a point over its distance from the joint
constexpr int least_places = 5, most_places = 1000;          // on a bone, at least two per tet
constexpr double longest_way = 3.0;  // along the skin, over the straight one; around an arm it is pi / 2

// The difference of the weights at two points, by bone.
using WeightDifference = std::map<int, double>;

void add_weights(const RiggedBody& body, const SurfacePoint& point, double sign, WeightDifference& difference)
{
    for (int corner = 0; corner < 3; ++corner) {
        const int vertex = body.triangles(point.triangle, corner);
        for (int e = body.skin.first[vertex]; e < body.skin.first[vertex + 1]; ++e)
            difference[body.skin.bone[e]] += sign * point.barycentric(corner) * body.skin.weight[e];
    }
}

// The triangles with one number for all points at a place that move alike, as along a seam of the texture. Lips that
// touch stay two points.
Triangles joined_skin(const RiggedBody& body)
{
    std::map<std::vector<double>, int> first;
    std::vector<int> number;
    for (Eigen::Index v = 0; v < body.surface.rows(); ++v) {
        std::map<int, double> weights;
        for (int e = body.skin.first[static_cast<std::size_t>(v)]; e < body.skin.first[static_cast<std::size_t>(v) + 1];
             ++e)
            weights[body.skin.bone[static_cast<std::size_t>(e)]] += body.skin.weight[static_cast<std::size_t>(e)];
        std::vector<double> key = {body.surface(v, 0), body.surface(v, 1), body.surface(v, 2)};
        for (const auto& [bone, weight] : weights) key.insert(key.end(), {double(bone), weight});
        number.push_back(first.try_emplace(key, static_cast<int>(v)).first->second);
    }
    return body.triangles.unaryExpr([&](int vertex) { return number[static_cast<std::size_t>(vertex)]; });
}

// Faces that two tets share, each once.
struct SharedFace {
    int first, second;  // tets
    std::array<int, 3> vertices;
};

std::vector<SharedFace> shared_faces(const Tets& tets)
{
    const std::vector<TetFace> faces = sorted_faces(tets);
    std::vector<SharedFace> shared;
    for (std::size_t f = 1; f < faces.size(); ++f)
        if (faces[f].sorted == faces[f - 1].sorted) shared.push_back({faces[f - 1].tet, faces[f].tet, faces[f].sorted});
    return shared;
}

std::vector<int> parts_without(const std::vector<SharedFace>& faces, const std::vector<bool>& is_cut, std::size_t tets)
{
    Classes classes(tets);
    for (std::size_t f = 0; f < faces.size(); ++f)
        if (!is_cut[f]) classes.unite(faces[f].first, faces[f].second);
    std::map<int, int> number;
    std::vector<int> part;
    for (std::size_t t = 0; t < tets; ++t)
        part.push_back(
            number.try_emplace(classes.find(static_cast<int>(t)), static_cast<int>(number.size())).first->second);
    return part;
}

int corner_of(const Tets& tets, int tet, int vertex)
{
    int corner = 0;
    while (tets(tet, corner) != vertex) ++corner;
    return 4 * tet + corner;
}

// A piece without a bone that moves its skin stays with the piece that it shares most faces with.
void keep_pieces_without_bone(const TetMesh& mesh, const SkinParts& parts, const std::vector<SurfacePoint>& skin,
                              const Skeleton& skeleton, const std::vector<SharedFace>& faces, std::vector<bool>& is_cut)
{
    const auto moves_skin = [&](int tet, int bone) {
        return parts.weight_at(skin[static_cast<std::size_t>(tet)], bone) > 0.0;
    };
    while (true) {  // each pass joins pieces
        const std::vector<int> part = parts_without(faces, is_cut, static_cast<std::size_t>(mesh.tets.rows()));
        const std::vector<bool> has_bone = has_bone_inside(mesh, part, skeleton, moves_skin);
        std::map<int, std::map<int, int>> shared;  // faces of a piece without a bone with each other piece
        const auto of = [&](int tet) { return part[static_cast<std::size_t>(tet)]; };
        for (const auto& [first, second, vertices] : faces)
            for (const auto& [own, other] : {std::pair(of(first), of(second)), std::pair(of(second), of(first))})
                if (own != other && !has_bone[static_cast<std::size_t>(own)]) ++shared[own][other];
        if (shared.empty()) return;
        std::map<int, int> joins;
        for (const auto& [own, others] : shared)
            joins[own] = std::ranges::max_element(others, {}, [](const auto& one) { return one.second; })->first;
        const auto is_joined = [&](int own, int other) { return joins.contains(own) && joins.at(own) == other; };
        for (std::size_t f = 0; f < faces.size(); ++f)
            if (const int one = of(faces[f].first), other = of(faces[f].second);
                is_joined(one, other) || is_joined(other, one))
                is_cut[f] = false;
    }
}

// Each vertex once for every group of tets around it that are joined by faces without a cut.
TetMesh split(const TetMesh& mesh, const std::vector<SharedFace>& faces, const std::vector<bool>& is_cut)
{
    Classes corners(static_cast<std::size_t>(mesh.tets.size()));
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (const int vertex : faces[f].vertices)
            if (!is_cut[f])
                corners.unite(corner_of(mesh.tets, faces[f].first, vertex),
                              corner_of(mesh.tets, faces[f].second, vertex));
    TetMesh made = mesh;
    std::map<int, int> vertex_of_class;
    std::vector<bool> is_taken(static_cast<std::size_t>(mesh.rest.rows()));
    std::vector<int> copied;
    for (int at = 0; at < static_cast<int>(mesh.tets.size()); ++at) {
        int& vertex = made.tets.data()[at];
        const auto [found, is_new] = vertex_of_class.try_emplace(corners.find(at), vertex);
        if (is_new && is_taken[static_cast<std::size_t>(vertex)]) {
            found->second = static_cast<int>(mesh.rest.rows() + static_cast<Eigen::Index>(copied.size()));
            copied.push_back(vertex);
        }
        is_taken[static_cast<std::size_t>(vertex)] = true;
        vertex = found->second;
    }
    made.rest.conservativeResize(mesh.rest.rows() + static_cast<Eigen::Index>(copied.size()), 3);
    for (std::size_t c = 0; c < copied.size(); ++c)
        made.rest.row(mesh.rest.rows() + static_cast<Eigen::Index>(c)) = mesh.rest.row(copied[c]);
    return made;
}

std::vector<Cut> cuts_of(const TetMesh& mesh, const SkinParts& parts, const std::vector<SurfacePoint>& skin,
                         const std::vector<SharedFace>& faces, const std::vector<bool>& is_cut)
{
    std::map<std::pair<int, int>, double> areas;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (!is_cut[f]) continue;
        const auto& [a, b, c] = faces[f].vertices;
        const auto skin_of = [&](int tet) { return skin[static_cast<std::size_t>(tet)]; };
        const auto bones = parts.bones_between(skin_of(faces[f].first), skin_of(faces[f].second));
        areas[std::minmax(bones.first, bones.second)] +=
            triangle_area(mesh.rest.row(a), mesh.rest.row(b), mesh.rest.row(c));
    }
    std::vector<Cut> cuts;
    for (const auto& [bones, area] : areas) cuts.push_back({bones.first, bones.second, area});
    std::ranges::stable_sort(cuts, std::ranges::greater{}, &Cut::area_m2);
    return cuts;
}

}  // namespace

SkinParts::SkinParts(const RiggedBody& body, std::vector<Pose> poses)
    : body_(body),
      poses_(std::move(poses)),
      tree_(body.surface, body.triangles),
      joined_(joined_skin(body)),
      ways_(static_cast<std::size_t>(body.surface.rows())),
      vertices_(static_cast<std::size_t>(body.surface.rows())),
      diagonal_m_(diagonal_m(body.surface))
{
    for (Eigen::Index t = 0; t < body.triangles.rows(); ++t)
        for (int corner = 0; corner < 3; ++corner) {
            const int from = joined_(t, corner), to = joined_(t, (corner + 1) % 3);
            const double length_m = (body.surface.row(from) - body.surface.row(to)).norm();
            ways_[static_cast<std::size_t>(from)].push_back({to, length_m});
            ways_[static_cast<std::size_t>(to)].push_back({from, length_m});
            vertices_[static_cast<std::size_t>(body.triangles(t, corner))] = {static_cast<int>(t), Vec3::Unit(corner),
                                                                              0.0};
        }
    Classes shells(ways_.size());
    for (const auto& triangle : joined_.rowwise())
        for (const int vertex : triangle) shells.unite(triangle(0), vertex);
    for (int vertex = 0; vertex < std::ssize(ways_); ++vertex) shell_.push_back(shells.find(vertex));
}

SurfacePoint SkinParts::at_vertex(Eigen::Index vertex) const
{
    return vertices_[static_cast<std::size_t>(vertex)];
}

Vec3 SkinParts::place(const SurfacePoint& point) const
{
    Vec3 place = Vec3::Zero();
    for (int corner = 0; corner < 3; ++corner)
        place += point.barycentric(corner) * body_.surface.row(body_.triangles(point.triangle, corner)).transpose();
    return place;
}

int SkinParts::bone_at(const SurfacePoint& point) const
{
    WeightDifference weights;
    add_weights(body_, point, 1.0, weights);
    return std::ranges::max_element(weights, {}, [](const auto& one) { return one.second; })->first;
}

double SkinParts::weight_at(const SurfacePoint& point, int bone) const
{
    WeightDifference weights;
    add_weights(body_, point, 1.0, weights);
    return weights[bone];
}

std::pair<int, int> SkinParts::bones_between(const SurfacePoint& a, const SurfacePoint& b) const
{
    WeightDifference difference;
    add_weights(body_, a, 1.0, difference);
    add_weights(body_, b, -1.0, difference);
    const auto [least, most] = std::ranges::minmax_element(difference, {}, [](const auto& one) { return one.second; });
    return {most->first, least->first};
}

bool SkinParts::are_apart(const SurfacePoint& a, const SurfacePoint& b) const
{
    if (a.triangle < 0 || b.triangle < 0) return false;
    return moved_apart_m(a, b) > least_apart * diagonal_m_ && !are_near_along_skin(a, b);
}

// sum_j (w_j(a) - w_j(b)) T_j x at the middle x of the two points. If joint k alone turns, T_j differs from the
// identity for k and the bones below it.
double SkinParts::moved_apart_m(const SurfacePoint& a, const SurfacePoint& b) const
{
    WeightDifference difference, below;
    add_weights(body_, a, 1.0, difference);
    add_weights(body_, b, -1.0, difference);
    const Vec3 middle = 0.5 * (place(a) + place(b));
    const std::vector<Bone>& bones = body_.skeleton.bones;
    for (const auto& [bone, weight] : difference)
        for (int joint = bone; joint >= 0; joint = bones[static_cast<std::size_t>(joint)].parent)
            below[joint] += weight;
    double most_m = 0.0;
    for (const auto& [joint, weight] : below)
        most_m = std::max(
            most_m, std::abs(weight) * moved_by_30_deg * (middle - bones[static_cast<std::size_t>(joint)].head).norm());
    for (const Pose& pose : poses_) {
        Vec3 apart = Vec3::Zero();
        for (const auto& [bone, weight] : difference) apart += weight * (pose[static_cast<std::size_t>(bone)] * middle);
        most_m = std::max(most_m, apart.norm());
    }
    return most_m;
}

// Dijkstra's algorithm over the edges, from the corners of the point's triangle.
const SkinParts::Ways& SkinParts::ways_from(const SurfacePoint& point, double longest_m) const
{
    Ways& ways = last_ways_;
    if (ways.from.triangle != point.triangle || ways.from.barycentric != point.barycentric) {
        ways = {.from = point, .least_m = {}, .next = {}};
        for (int corner = 0; corner < 3; ++corner) {
            const int vertex = joined_(point.triangle, corner);
            ways.next.emplace(ways.least_m[vertex] = (body_.surface.row(vertex).transpose() - place(point)).norm(),
                              vertex);
        }
    }
    while (!ways.next.empty() && ways.next.top().first <= longest_m) {
        const auto [way_m, vertex] = ways.next.top();
        ways.next.pop();
        if (way_m > ways.least_m.at(vertex)) continue;
        for (const Way& way : ways_[static_cast<std::size_t>(vertex)]) {
            const auto [known, is_new] = ways.least_m.try_emplace(way.to, way_m + way.length_m);
            if (!is_new && known->second <= way_m + way.length_m) continue;
            known->second = way_m + way.length_m;
            ways.next.emplace(known->second, way.to);
        }
    }
    return ways;
}

// From the corners of one triangle to those of the other. Edges make a way longer than it is, by up to about an edge at
// its ends.
bool SkinParts::are_near_along_skin(const SurfacePoint& a, const SurfacePoint& b) const
{
    const auto shell_of = [&](const SurfacePoint& point) {
        return shell_[static_cast<std::size_t>(joined_(point.triangle, 0))];
    };
    if (shell_of(a) != shell_of(b)) return false;
    const Vec3 to = place(b);
    std::map<int, double> after_m;
    double edge_m = 0.0;
    for (int corner = 0; corner < 3; ++corner) {
        const int of_a = joined_(a.triangle, corner), of_b = joined_(b.triangle, corner);
        after_m[of_b] = (body_.surface.row(of_b).transpose() - to).norm();
        for (const auto& [triangle, vertex] : {std::pair(a.triangle, of_a), std::pair(b.triangle, of_b)})
            edge_m += (body_.surface.row(vertex) - body_.surface.row(joined_(triangle, (corner + 1) % 3))).norm() / 6.0;
    }
    for (int corner = 0; corner < 3; ++corner)
        if (after_m.contains(joined_(a.triangle, corner))) return true;  // neighbours
    const double longest_m = longest_way * (place(a) - to).norm() + edge_m;
    const Ways& ways = ways_from(a, longest_m);
    return std::ranges::any_of(after_m, [&](const auto& end) {
        const auto way = ways.least_m.find(end.first);
        return way != ways.least_m.end() && way->second + end.second <= longest_m;
    });
}

SeparatedFlesh separate_parts(const TetMesh& mesh, const SkinParts& parts, const Skeleton& skeleton)
{
    SeparatedFlesh made;
    for (const auto& tet : mesh.tets.rowwise()) {
        Vec3 centre = Vec3::Zero();
        for (const int vertex : tet) centre += 0.25 * mesh.rest.row(vertex).transpose();
        made.skin_of_tet.push_back(parts.nearest(centre));
    }
    const std::vector<SharedFace> faces = shared_faces(mesh.tets);
    std::vector<bool> is_cut;
    for (const SharedFace& face : faces)
        is_cut.push_back(parts.are_apart(made.skin_of_tet[static_cast<std::size_t>(face.first)],
                                         made.skin_of_tet[static_cast<std::size_t>(face.second)]));
    keep_pieces_without_bone(mesh, parts, made.skin_of_tet, skeleton, faces, is_cut);
    made.cuts = cuts_of(mesh, parts, made.skin_of_tet, faces, is_cut);
    made.mesh = split(mesh, faces, is_cut);
    made.tet_at.resize(made.mesh.rest.rows());
    for (Eigen::Index t = made.mesh.tets.rows(); t-- > 0;)
        for (const int vertex : made.mesh.tets.row(t)) made.tet_at(vertex) = static_cast<int>(t);
    return made;
}

Carrier carrier_of(const Character& character, Eigen::Index vertex)
{
    const RiggedBody& body = character.artist->model->body;
    const SkinParts parts(body, {});
    const Weights& in_tets = character.artist->weights;
    std::map<int, double> of_flesh;
    for (int corner = 0; corner < 4; ++corner) {
        const int v = character.mesh.tets(character.surface->tet(vertex), corner);
        for (int e = in_tets.first[static_cast<std::size_t>(v)]; e < in_tets.first[static_cast<std::size_t>(v) + 1];
             ++e)
            of_flesh[in_tets.bone[static_cast<std::size_t>(e)]] +=
                character.surface->barycentric(vertex, corner) * in_tets.weight[static_cast<std::size_t>(e)];
    }
    Carrier carrier{.bone = parts.bone_at(parts.at_vertex(vertex))};
    carrier.of_flesh = std::ranges::max_element(of_flesh, {}, [](const auto& one) { return one.second; })->first;
    const Vec3 point = body.surface.row(vertex);
    carrier.gap_m =
        parts.nearest(point, [&](const SurfacePoint& other) { return parts.bone_at(other) == carrier.of_flesh; })
            .distance_m;
    return carrier;
}

std::vector<std::pair<int, int>> bones_in_tets(const TetMesh& mesh, const Skeleton& skeleton, double margin)
{
    const PointLocation location(mesh);
    const double size_m = std::cbrt(tet_volumes(mesh.rest, mesh.tets).sum() / static_cast<double>(mesh.tets.rows()));
    std::vector<std::pair<int, int>> found;
    for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
        const Vec3 way = skeleton.bones[b].tail - skeleton.bones[b].head;
        const int places =
            std::clamp(static_cast<int>(std::ceil(2.0 * way.norm() / size_m)), least_places, most_places);
        for (int k = 0; k < places; ++k) {
            const double along = margin + (1.0 - 2.0 * margin) * (k + 0.5) / places;
            if (const int tet = location.locate(skeleton.bones[b].head + along * way).tet; tet >= 0)
                found.emplace_back(static_cast<int>(b), tet);
        }
    }
    return found;
}

std::vector<bool> has_bone_inside(const TetMesh& mesh, const std::vector<int>& part, const Skeleton& skeleton,
                                  const std::function<bool(int, int)>& may_count)
{
    std::vector<bool> has_bone(part.empty() ? 0 : static_cast<std::size_t>(1 + *std::ranges::max_element(part)));
    for (const auto& [bone, tet] : bones_in_tets(mesh, skeleton, 0.25))
        if (!may_count || may_count(tet, bone))
            has_bone[static_cast<std::size_t>(part[static_cast<std::size_t>(tet)])] = true;
    return has_bone;
}

}  // namespace pbs
