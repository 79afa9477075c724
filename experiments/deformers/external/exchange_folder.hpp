// The files through which pbskin and an external program exchange data. README.md of this folder specifies them.
#pragma once

#include "pbs/character/character.hpp"
#include "pbs/skinning/pose.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// The weights as a dense array by rows, #V x #bones.
std::vector<double> dense_weights(const pbs::Weights& weights, std::size_t bones);

// The upper three rows of each bone's transform, #bones x 3 x 4.
std::vector<double> transform_rows(const pbs::Pose& pose);

// character.json, rest.f64, tets.i32, weights.f64 and poses.f64. Numbers are little-endian, arrays by rows.
void write_exchange(const std::string& folder, const pbs::Character& character, const std::vector<pbs::Pose>& poses, double time_step_s);

// positions.f64 of so many poses, and seconds.f64 if the program wrote it. An InputError, which names the file without its folder, if
// positions.f64 is missing, a file has another size, or a time is negative or not finite. Positions may be not finite.
struct ExchangedPositions {
    std::vector<pbs::Positions> positions;       // [m], #poses of #V x 3
    std::optional<std::vector<double>> seconds;  // of each pose
};
ExchangedPositions read_exchange(const std::string& folder, Eigen::Index vertices, std::size_t poses);

}  // namespace experiments
