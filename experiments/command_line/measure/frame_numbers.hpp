// Which number in a frame's name counts: frame_0007_v2.vtu is the seventh where its neighbours end in _v2 too.
//   for (const NumberedFile& file : numbered("out", {"out/frame_7_v2.vtu", "out/frame_8_v2.vtu"})) ...
#pragma once

#include <string>
#include <vector>

namespace experiments {

// The number that counts, and the path around it. No digits: a file that stands for itself.
struct NumberedFile {
    std::string path, before, digits, after;
};

constexpr std::size_t longest_number = 15;  // digits; what is longer is taken for text

// Of names of one form (folder and texts between the numbers) the number that differs counts; of a single one its last. InputError, which
// names the argument, where several differ.
std::vector<NumberedFile> numbered(const std::string& argument, const std::vector<std::string>& paths);

}  // namespace experiments
