// Every reader of a file from outside: how it reads, and a sound file of a few points, bones or frames. The contract
// that all of them pass is in tests/robustness/pbs/readers/contract.cpp, and what each of them refuses besides is in
// bad_files.cpp.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace readers {

struct Reader {
    std::string name;                                          // of its tests
    std::string file;                                          // of the sound file
    std::string text;                                          // its content; {x=1}: a place for numbers that cannot be
    std::function<std::string(const std::string& path)> read;  // what was read, in a few numbers
    std::string beside = {}, text_beside = {};                 // a file that belongs to it
    bool has_an_end = true;                                    // a part of the file is none
    int refused_dialects = 1;                                  // at most, such as that with a byte-order mark
};

inline void PrintTo(const Reader& reader, std::ostream* out)
{
    *out << reader.name;
}

const std::vector<Reader>& all_readers();
const Reader& reader_named(const std::string& name);

// The text with the sound number in each of its places, and with another one in the place of that name.
std::string sound(const std::string& text);
std::string with_number(const std::string& text, const std::string& place, const std::string& number);

// The text with its first `what` replaced, which it has to hold.
std::string replaced(std::string text, const std::string& what, const std::string& by);

// "read: ...", or the message with which it was refused, which has to begin with the folder and the name without its
// extension. Nothing is printed, nothing is left in the folder, and the answer comes within five seconds; it takes one
// on an idle machine.
std::string answer_of(const Reader& reader, const std::string& path);

}  // namespace readers
