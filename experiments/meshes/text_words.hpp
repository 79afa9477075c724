// The words of a text, which blanks and line ends separate, and the line of each: for formats of keywords and numbers.
//   TextWords words("arm.mesh", as_utf8(read_text_file("arm.mesh")), '#');
//   while (!words.at_end()) if (words.next("keyword") == "Vertices") count = words.whole("Vertices", 0, most);
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace pbs {

// Text without the byte order mark that programs of Windows write; UTF-16 with such a mark becomes UTF-8. Other bytes
// stay as they are.
std::string as_utf8(std::string bytes);

// A number as C, Fortran (2.9D-01) and Python write it, whatever the locale; nan and inf are numbers. Nothing: the word
// is none, as 1.#QNAN or 1,5.
std::optional<double> number_in(std::string_view word);

std::string in_lower_case(std::string text);

class TextWords {
public:
    // comment: begins a remark that ends with its line; '\0': there are none.
    TextWords(std::string path, std::string text, char comment = '\0');

    bool at_end() { return peek().empty(); }
    std::string_view peek();                   // the next word, which remains the next one; empty at the end
    std::string_view next(const char* field);  // InputError at the end. A text in quotation marks is one word.
    double number(const char* field);
    long long whole(const char* field, long long low, long long high);
    // at the last word
    [[noreturn]] void fail(const std::string& field, const std::string& value, const std::string& rule) const;

    // For formats that mix words and bytes.
    void go_to(std::size_t byte) { at_ = begin_ = byte; }
    void skip_line();                                              // to the byte behind the next line end
    std::string_view bytes(std::size_t count, const char* field);  // InputError where fewer follow
    const std::string& text() const { return text_; }

private:
    std::string path_, text_;
    char comment_;
    std::size_t at_ = 0, begin_ = 0;  // the next byte, and the first one of the last word
};

}  // namespace pbs
