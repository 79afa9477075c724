// How the curves of an FBX file run between their keys, which assimp does not report: it reads all of them as linear.
//   const FbxCurves curves = count_fbx_curves(read_text_file("hero.fbx"));
#pragma once

#include <string>

namespace pbs {

struct FbxCurves {
    int curves = 0;      // whose keys are marked as constant, linear or cubic
    int not_linear = 0;  // with a constant or cubic key
};

// bytes: of a binary or a text file. Damaged curves are not counted.
FbxCurves count_fbx_curves(const std::string& bytes);

}  // namespace pbs
