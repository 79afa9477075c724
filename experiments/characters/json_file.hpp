// A JSON file of somebody else's making, read with an InputError for everything that is not as expected.
//   const JsonFile model("human_full_size.json");
//   const auto vertices = model.numbers<double>("vertices");
#pragma once

#include "experiments/characters/body_cache.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace pbs {

// Every error is an InputError that names file and key.
class JsonFile {
public:
    // Reads it whole; an InputError by line where it is no JSON or cut short.
    explicit JsonFile(const std::string& path) : path_(path)
    {
        const std::string text = read_text_file(path);
        hash_ = content_hash(text);
        try {
            json_ = nlohmann::json::parse(text);
        } catch (const nlohmann::json::parse_error& error) {
            throw InputError(path, line_at(text, error.byte), "", "",
                             "no JSON, or cut short, at byte " + std::to_string(error.byte));
        }
    }

    const std::string& path() const { return path_; }  // as it was given
    const std::string& hash() const { return hash_; }  // of its bytes

    // The entry of a key of the whole, or of one of its parts.
    const nlohmann::json& at(const std::string& key) const { return at(json_, key); }
    // An InputError where the key is missing.
    const nlohmann::json& at(const nlohmann::json& part, const std::string& key) const
    {
        if (!part.is_object() || !part.contains(key)) refuse(key, "missing");
        return part.at(key);
    }

    // An array of numbers; whole ones where Number is an integer.
    template <typename Number>
    std::vector<Number> numbers(const std::string& key) const
    {
        return numbers<Number>(at(key), key);
    }
    // Likewise of an array; `field` stands for it in errors.
    template <typename Number>
    std::vector<Number> numbers(const nlohmann::json& array, const std::string& field) const
    {
        if (!array.is_array()) refuse(field, "expected an array of numbers");
        constexpr bool whole = std::is_integral_v<Number>;
        std::vector<Number> values;
        values.reserve(array.size());
        for (const auto& value : array) {
            if (!(whole ? value.is_number_integer() : value.is_number()))
                refuse(field + "[" + std::to_string(values.size()) + "]",
                       whole ? "expected a whole number" : "expected a number");
            values.push_back(value.template get<Number>());
        }
        return values;
    }

    [[noreturn]] void refuse(const std::string& field, const std::string& rule) const
    {
        throw InputError(path_, 0, field, "", rule);
    }

private:
    std::string path_, hash_;
    nlohmann::json json_;
};

}  // namespace pbs
