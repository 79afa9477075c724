#include "experiments/characters/skinning_weights.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>

namespace pbs {
namespace {

constexpr double sum_tolerance = 1e-6;

Weights smooth_weights(const Character& character)
{
    std::vector<int> held(character.blended.size());
    for (std::size_t v = 0; v < held.size(); ++v) held[v] = character.blended[v] ? -1 : character.binding.bone[v];
    return harmonic_weights(character.mesh, held, static_cast<int>(character.skeleton.bones.size()));
}

struct Entry {
    int bone;
    double weight;
};

struct Row {
    int vertex;
    Entry entry;
};

template <typename Number>
bool read_number(const std::string& text, Number& number)
{
    const char* end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, number);
    return error == std::errc() && stopped == end;
}

std::vector<std::string> split(const std::string& line)
{
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    return fields;
}

Row read_row(const std::vector<std::string>& fields, const Skeleton& skeleton, int vertices, const std::string& file,
             int line)
{
    if (fields.size() != 3) throw InputError(file, line, "", "", "expected three fields: vertex,joint,weight");
    Row row{};
    if (!read_number(fields[0], row.vertex) || row.vertex < 0 || row.vertex >= vertices)
        throw InputError(file, line, "vertex", fields[0], expected_whole("a vertex", 0, vertices - 1));
    row.entry.bone = find_bone(skeleton, fields[1]);
    if (row.entry.bone < 0) {
        std::vector<std::string> names;
        for (const Bone& bone : skeleton.bones) names.push_back(bone.name);
        throw InputError(file, line, "joint", fields[1],
                         "no such joint; the nearest is '" + nearest_name(fields[1], names) + "'");
    }
    if (!read_number(fields[2], row.entry.weight) || !(row.entry.weight >= 0.0 && row.entry.weight <= 1.0))
        throw InputError(file, line, "weight", fields[2], "expected 0 <= weight <= 1");
    return row;
}

// The entries of each vertex and the last line that has one, 0 where none has.
struct Rows {
    std::vector<std::vector<Entry>> entries;
    std::vector<int> line;
};

Rows read_rows(const std::string& csv, const std::string& path, const Skeleton& skeleton, int vertices)
{
    std::istringstream text(csv);
    Rows rows{std::vector<std::vector<Entry>>(vertices), std::vector<int>(vertices, 0)};
    int number = 0;
    for (std::string line; std::getline(text, line);) {
        ++number;
        line.resize(line.find_last_not_of(" \t\r") + 1);
        // a byte-order mark, as spreadsheets write it
        if (number == 1 && line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);
        if (number == 1 && line != "vertex,joint,weight")
            throw InputError(path, 1, "", "", "expected the header vertex,joint,weight");
        if (number == 1 || line.empty()) continue;
        const Row row = read_row(split(line), skeleton, vertices, path, number);
        for (const Entry& entry : rows.entries[row.vertex])
            if (entry.bone == row.entry.bone)
                throw InputError(path, number, "joint", skeleton.bones[entry.bone].name,
                                 "vertex " + std::to_string(row.vertex) + " has this joint already");
        rows.entries[row.vertex].push_back(row.entry);
        rows.line[row.vertex] = number;
    }
    if (number == 0) throw InputError(path, 1, "", "", "expected the header vertex,joint,weight");
    return rows;
}

void check_sum(const std::vector<Entry>& entries, std::size_t vertex, int line, const std::string& path)
{
    if (entries.empty()) throw InputError(path, 0, "vertex", std::to_string(vertex), "has no weights");
    double sum = 0.0;
    for (const Entry& entry : entries) sum += entry.weight;
    if (std::abs(sum - 1.0) > sum_tolerance)
        throw InputError(path, line, "vertex " + std::to_string(vertex), std::to_string(sum),
                         "its weights must sum to one within 1e-6");
}

}  // namespace

bool has_artist_weights(const Character& character)
{
    return character.artist && character.artist->weights.vertices() > 0;
}

std::optional<WeightKind> weights_named(const std::string& name)
{
    const auto file = weight_names.end() - 1, found = std::find(weight_names.begin(), file, name);
    if (found == file) return {};
    return static_cast<WeightKind>(found - weight_names.begin());
}

Weights weights_by(WeightKind kind, const Character& character)
{
    switch (kind) {
        case WeightKind::paper:
            return paper_weights(character.binding, character.skeleton);
        case WeightKind::rigid:
            return rigid_weights(character.binding);
        case WeightKind::smooth:
            return smooth_weights(character);
        case WeightKind::diffused:
            return diffused_weights(character.mesh, paper_weights(character.binding, character.skeleton));
        case WeightKind::either_end:
            return either_end_weights(character.binding, character.skeleton);
        case WeightKind::artist:
            if (has_artist_weights(character)) return character.artist->weights;
            break;
        case WeightKind::file:
            if (character.weight_kind == WeightKind::file) return character.weights;
            break;
    }
    throw InputError(character.name, 0, "skinning.weights", name_of(kind),
                     "expected a character that brings such weights");
}

Character with_weights(WeightKind kind, Character character)
{
    character.weights = weights_by(kind, character);
    character.weight_kind = kind;
    return character;
}

namespace {

// Whether a vertex is on a cut through the flesh, and not on the skin: faces of the boundary come in pairs at one place
// there.
std::vector<bool> vertices_at_cuts(const TetMesh& mesh)
{
    using Corner = std::array<double, 3>;
    using Face = std::array<Corner, 3>;
    const auto place_of = [&](const auto& triangle) {
        Face place;
        for (int k = 0; k < 3; ++k)
            Eigen::RowVector3d::Map(place[static_cast<std::size_t>(k)].data()) = mesh.rest.row(triangle(k));
        std::ranges::sort(place);
        return place;
    };
    const Triangles boundary = boundary_of(mesh.tets);
    std::map<Face, int> faces;
    for (const auto& triangle : boundary.rowwise()) ++faces[place_of(triangle)];
    std::vector<bool> at_cut(static_cast<std::size_t>(mesh.rest.rows()), false);
    for (const auto& triangle : boundary.rowwise())
        if (faces.at(place_of(triangle)) > 1)
            for (const int v : triangle) at_cut[static_cast<std::size_t>(v)] = true;
    return at_cut;
}

}  // namespace

TransferredWeights transfer_weights(const TetMesh& mesh, const Positions& surface, const Triangles& triangles,
                                    const Weights& skin, int bones,
                                    const std::function<bool(Eigen::Index, const SurfacePoint&)>& may_move)
{
    const SurfaceTree tree(surface, triangles);
    const std::vector<bool> on_boundary = boundary_vertices(mesh.tets, mesh.rest.rows()),
                            at_cut = vertices_at_cuts(mesh);
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(mesh.rest.rows(), bones);
    TransferredWeights transferred;
    for (Eigen::Index v = 0; v < mesh.rest.rows(); ++v) {
        if (!on_boundary[static_cast<std::size_t>(v)]) continue;
        const Vec3 point = mesh.rest.row(v);
        SurfacePoint nearest = tree.nearest(point);
        if (may_move && !may_move(v, nearest)) {  // at a cut, which lies in the flesh
            const SurfacePoint other =
                tree.nearest(point, [&](const SurfacePoint& candidate) { return may_move(v, candidate); });
            if (other.triangle >= 0) nearest = other;
        } else if (!at_cut[static_cast<std::size_t>(v)]) {
            transferred.largest_distance_m = std::max(transferred.largest_distance_m, nearest.distance_m);
        }
        for (int corner = 0; corner < 3; ++corner) {
            const int point = triangles(nearest.triangle, corner);
            for (int e = skin.first[point]; e < skin.first[point + 1]; ++e)
                weights(v, skin.bone[e]) += nearest.barycentric(corner) * skin.weight[e];
        }
    }
    transferred.weights = harmonic_extension(mesh, on_boundary, weights);
    return transferred;
}

CarriedWeight carried_weight(const Weights& skin, const Weights& in_tets, const EmbeddedSurface& surface,
                             const Tets& tets, int bones)
{
    CarriedWeight weight{std::vector<double>(bones, 0.0), std::vector<double>(bones, 0.0),
                         std::vector<double>(skin.vertices(), 0.0)};
    for (int point = 0; point < skin.vertices(); ++point) {
        std::map<int, double> of_tets;
        for (int corner = 0; corner < 4; ++corner) {
            const int v = tets(surface.tet(point), corner);
            for (int e = in_tets.first[v]; e < in_tets.first[v + 1]; ++e)
                of_tets[in_tets.bone[e]] += surface.barycentric(point, corner) * in_tets.weight[e];
        }
        for (int e = skin.first[point]; e < skin.first[point + 1]; ++e) {
            const double carried = std::clamp(of_tets[skin.bone[e]], 0.0, skin.weight[e]);
            weight.of_artist[skin.bone[e]] += skin.weight[e];
            weight.carried[skin.bone[e]] += carried;
            weight.at_point[point] += carried;
        }
    }
    return weight;
}

double CarriedWeight::share_pct() const
{
    const double whole = std::accumulate(of_artist.begin(), of_artist.end(), 0.0);
    return whole > 0.0 ? 100.0 * std::accumulate(carried.begin(), carried.end(), 0.0) / whole : 0.0;
}

Weights parse_weights(const std::string& text, const std::string& name, const Skeleton& skeleton, int vertices)
{
    std::vector<int> all(static_cast<std::size_t>(vertices));
    std::iota(all.begin(), all.end(), 0);
    return parse_weights(text, name, skeleton, vertices, all);
}

Weights parse_weights(const std::string& text, const std::string& name, const Skeleton& skeleton, int file_vertices,
                      const std::vector<int>& file_vertex)
{
    const auto [entries, line] = read_rows(text, name, skeleton, file_vertices);
    Weights weights;
    weights.first.push_back(0);
    for (const int number : file_vertex) {
        const auto vertex = static_cast<std::size_t>(number);
        check_sum(entries[vertex], vertex, line[vertex], name);
        for (const Entry& entry : entries[vertex])
            if (entry.weight != 0.0) weights.add(entry.bone, entry.weight);
        weights.end_vertex();
    }
    return weights;
}

}  // namespace pbs
