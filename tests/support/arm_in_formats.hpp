// The rig of two_joint_rig.hpp, whose elbow turns by 90 degrees about z within 1 s, as COLLADA and as FBX: seeds of the
// fuzzer. The files' unit is the centimetre.
#pragma once

#include "pbs/system/files.hpp"

#include <string>
#include <utility>

namespace test_support {

// bind_shape: the scale of the bind shape matrix, and the inverse one of the points; 1 or 2.
inline std::string collada_arm(int bind_shape = 1)
{
    std::string text = pbs::read_text_file(PBS_RIG_SEEDS "/collada");
    if (bind_shape == 1) return text;
    for (const auto& [one, two] :
         {std::pair<std::string, std::string>("1 0 0 1 2 0 1 4 0 2 2 0", "0.5 0 0 0.5 1 0 0.5 2 0 1 1 0"),
          {"1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1<", "2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1<"}})
        text.replace(text.find(one), one.size(), two);
    return text;
}

inline std::string fbx_arm()
{
    return pbs::read_text_file(PBS_RIG_SEEDS "/fbx");
}

}  // namespace test_support
