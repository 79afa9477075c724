// The skin weights of a mesh while its points are read one after another.
#pragma once

#include "pbs/skinning/weights.hpp"

#include <string>
#include <vector>

namespace pbs {

struct JointShare {
    int joint = 0;  // index into RigMesh::joints
    double weight = 0.0;
};

class SkinWeights {
public:
    // One joint may occur several times; its weights are added.
    void add_point(const std::vector<JointShare>& shares);

    // Sums of one. Points whose weights are all zero follow joint 0, and sums that are not one within 1e-3 are counted: both are remarks.
    // An InputError names a weight that is negative or not finite.
    Weights normalised(const std::string& file, const std::string& mesh, std::vector<std::string>& remarks) const;

private:
    std::vector<std::vector<JointShare>> points_;
};

}  // namespace pbs
