// Checks of a BVH file's header that assimp omits, done before assimp reads the file.
#pragma once

#include <string>

namespace pbs {

// By the file's extension or its first word, HIERARCHY, as assimp tells it; white space and a byte-order mark may stand before that.
bool is_bvh(const std::string& text, const std::string& path);

// Throws an InputError where Frames or Frame Time is no positive number, more frames are announced than the text can hold, or joints are
// nested deeper than a reader's stack. A header that is not there is left to the reader to refuse.
void check_bvh_header(const std::string& text, const std::string& path);

}  // namespace pbs
