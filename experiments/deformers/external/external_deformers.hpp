// A user's own deformer: a program that reads poses and writes positions, or a shared library with the functions of
// pbskin_deformer.h.
#pragma once

#include "experiments/characters/character.hpp"
#include "experiments/deformers/deformer.hpp"
#include "pbs/skinning/pose.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace experiments {

// The options of an [[external]] table, which has either a command or a library.
struct ExternalOptions {
    std::vector<std::string> command = {};  // the program and its arguments, files with their absolute paths
    std::string library = {};               // path
    bool has_memory = false;                // it gets every time step, not only the frames
    // of each word of the command, empty if it is no file; or of the library
    std::vector<std::string> file_hashes = {};
    // the scene file with the table, and the deformer's name there, for messages
    std::string scene = {}, name = {};
};

// Throws the InputError `SCENE: NAME.KEY = VALUE: RULE`; the key is command or library.
[[noreturn]] void refuse_external(const ExternalOptions& options, const std::string& rule);

// A program runs once for all poses that the run foresees, and again where a pose was not foreseen. An InputError if it
// cannot be started, does not end with status 0, or writes files of another size.
std::unique_ptr<Deformer> make_program_deformer(const ExternalOptions& options);

// Loads the library into this process, where it stays. Returns why it cannot be used, or an empty text if it can.
std::string why_library_not_usable(const std::string& library);

// The files through which pbskin and an external program exchange data. README.md of this folder specifies them.

// character.json, rest.f64, tets.i32, weights.f64 and poses.f64. Numbers are little-endian, arrays by rows.
void write_exchange(const std::string& folder, const pbs::Character& character, const std::vector<pbs::Pose>& poses,
                    double time_step_s);
// the upper three rows of each bone's transform, #bones x 3 x 4
std::vector<double> transform_rows(const pbs::Pose& pose);

// positions.f64 of so many poses, and seconds.f64 if the program wrote it. An InputError, which names the file without
// its folder, if positions.f64 is missing, a file has another size, or a time is negative or not finite. Positions may
// be not finite.
struct ExchangedPositions {
    std::vector<pbs::Positions> positions;       // [m], #poses of #V x 3
    std::optional<std::vector<double>> seconds;  // of each pose
};
ExchangedPositions read_exchange(const std::string& folder, Eigen::Index vertices, std::size_t poses);

}  // namespace experiments
