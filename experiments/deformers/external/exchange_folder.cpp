#include "experiments/deformers/external/external_deformers.hpp"

#include "analysis/records/record_files.hpp"
#include "pbs/geometry/files.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little);

template <typename Number>
void write_numbers(const std::string& file, const Number* numbers, std::size_t count)
{
    pbs::write_atomically(file, std::string(reinterpret_cast<const char*>(numbers), count * sizeof(Number)));
}

std::vector<double> read_numbers(const fs::path& folder, const std::string& file, std::size_t count, const std::string& shape)
{
    if (!fs::is_regular_file(folder / file)) throw pbs::InputError(file, 0, "", "", "missing: expected the program to write it");
    if (const auto bytes = fs::file_size(folder / file); bytes != count * sizeof(double))
        throw pbs::InputError(file, 0, "bytes", std::to_string(bytes),
                              fmt::format("expected {}: {} numbers of 8 bytes", count * sizeof(double), shape));
    const std::string bytes = pbs::read_text_file(folder / file, pbs::most_mesh_bytes);
    std::vector<double> numbers(count);
    if (count > 0) std::memcpy(numbers.data(), bytes.data(), bytes.size());
    return numbers;
}

nlohmann::json character_json(const pbs::Character& character, std::size_t poses, double time_step_s)
{
    nlohmann::json bones = nlohmann::json::array();
    const auto point = [](const pbs::Vec3& p) { return nlohmann::json{p.x(), p.y(), p.z()}; };
    for (const pbs::Bone& bone : character.skeleton.bones)
        bones.push_back({{"name", bone.name}, {"parent", bone.parent}, {"head_m", point(bone.head)}, {"tail_m", point(bone.tail)}});
    return {{"schema", 1},
            {"name", character.name},
            {"vertices", character.mesh.rest.rows()},
            {"tets", character.mesh.tets.rows()},
            {"poses", poses},
            {"time_step_s", time_step_s},
            {"bones", bones}};
}

}  // namespace

std::vector<double> dense_weights(const pbs::Weights& weights, std::size_t bones)
{
    std::vector<double> rows(static_cast<std::size_t>(weights.vertices()) * bones, 0.0);
    for (int v = 0; v < weights.vertices(); ++v)
        for (int e = weights.first[v]; e < weights.first[v + 1]; ++e)
            rows[static_cast<std::size_t>(v) * bones + static_cast<std::size_t>(weights.bone[e])] += weights.weight[e];
    return rows;
}

std::vector<double> transform_rows(const pbs::Pose& pose)
{
    std::vector<double> numbers;
    for (const Eigen::Isometry3d& bone : pose)
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column) numbers.push_back(bone.matrix()(row, column));
    return numbers;
}

void write_exchange(const std::string& folder, const pbs::Character& character, const std::vector<pbs::Pose>& poses, double time_step_s)
{
    const pbs::TetMesh& mesh = character.mesh;
    write_numbers(folder + "/rest.f64", mesh.rest.data(), static_cast<std::size_t>(mesh.rest.size()));
    write_numbers(folder + "/tets.i32", mesh.tets.data(), static_cast<std::size_t>(mesh.tets.size()));
    const std::vector<double> weights = dense_weights(character.weights, character.skeleton.bones.size());
    std::vector<double> transforms;
    for (const pbs::Pose& pose : poses) {
        const std::vector<double> rows = transform_rows(pose);
        transforms.insert(transforms.end(), rows.begin(), rows.end());
    }
    write_numbers(folder + "/weights.f64", weights.data(), weights.size());
    write_numbers(folder + "/poses.f64", transforms.data(), transforms.size());
    pbs::write_atomically(folder + "/character.json", analysis::record_text(character_json(character, poses.size(), time_step_s)));
}

ExchangedPositions read_exchange(const std::string& folder, Eigen::Index vertices, std::size_t poses)
{
    const std::size_t per_pose = static_cast<std::size_t>(3 * vertices);
    const std::vector<double> numbers =
        read_numbers(folder, "positions.f64", poses * per_pose, fmt::format("{} poses x {} vertices x 3", poses, vertices));
    ExchangedPositions read;
    for (std::size_t pose = 0; pose < poses; ++pose)
        read.positions.emplace_back(Eigen::Map<const pbs::Positions>(numbers.data() + pose * per_pose, vertices, 3));
    if (!fs::exists(folder + "/seconds.f64")) return read;
    read.seconds = read_numbers(folder, "seconds.f64", poses, fmt::format("{} poses x 1", poses));
    for (const double seconds : *read.seconds)
        if (!(seconds >= 0.0 && std::isfinite(seconds)))
            throw pbs::InputError("seconds.f64", 0, "time", fmt::format("{}", seconds), "expected a finite time of at least 0 s");
    return read;
}

}  // namespace experiments
