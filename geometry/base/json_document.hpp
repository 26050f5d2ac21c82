#pragma once
/// \file JSON files that an earlier stage or run wrote, read with a check of every value that is used later.
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace cutterflow {

enum class JsonKind {
    object,
    text,
    truth,
    number,
    number_or_null,
    whole,  ///< 0 to 2147483647, written without a decimal point
    whole_or_null
};

/// A value of a document. Its place is the path of keys from the root; * stands for every item of an array: "gates/*/name".
struct JsonField {
    std::string place;
    JsonKind kind;
    bool required = false;  ///< it and what it belongs to; arrays may be empty
};

/// Reads a file whose root is an object.
/// \param remedy  of every mistake
/// \throws UserError  with all mistakes: the file cannot be read, is no JSON object, is nested more than 100 deep, or a value is missing or
/// of another kind
nlohmann::json read_json_document(const std::filesystem::path& file, const std::vector<JsonField>& fields, const std::string& remedy);

}  // namespace cutterflow
