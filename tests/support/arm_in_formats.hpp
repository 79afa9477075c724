// The rig of two_joint_rig.hpp, whose elbow turns by 90 degrees about z within 1 s, as COLLADA and as FBX (tests/support/arm). The files'
// unit is the centimetre.
#pragma once

#include "generated/test_data_texts.hpp"

#include <string>
#include <utility>

namespace test_support {

inline std::string collada_arm()
{
    return test_data::arm_dae;
}

// The same arm with points of half the size and a bind shape matrix that doubles them.
inline std::string collada_arm_with_bind_shape()
{
    std::string text = collada_arm();
    for (const auto& [part, other] : {std::pair<std::string, std::string>{"1 0 0 1 2 0 1 4 0 2 2 0", "0.5 0 0 0.5 1 0 0.5 2 0 1 1 0"},
                                      {"<bind_shape_matrix>1 0 0 0 0 1 0 0 0 0 1 0", "<bind_shape_matrix>2 0 0 0 0 2 0 0 0 0 2 0"}})
        text.replace(text.find(part), part.size(), other);
    return text;
}

inline std::string fbx_arm()
{
    return test_data::arm_fbx;
}

}  // namespace test_support
