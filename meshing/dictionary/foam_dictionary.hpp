#pragma once
/// \file Text of OpenFOAM dictionaries: guarantees the syntax (brackets, quotes, semicolons, numbers), not the content.
#include <array>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <iterator>
#include <string>
#include <type_traits>
#include <vector>

#include "geometry/base/vec3.hpp"

namespace cutterflow::meshing {

class FoamValue;
struct FoamEntry;

/// Entries in the order in which they were added.
class FoamDictionary {
public:
    FoamDictionary();
    FoamDictionary(const FoamDictionary&);
    FoamDictionary(FoamDictionary&&) noexcept;
    FoamDictionary& operator=(const FoamDictionary&);
    FoamDictionary& operator=(FoamDictionary&&) noexcept;
    ~FoamDictionary();

    /// Adds `key value;` (`key { ... }` when the value is a dictionary). The key is written as it is: `div(phi,U)` is a keyword, not a
    /// pattern. \throws std::invalid_argument  when the key is no OpenFOAM word or is there already
    FoamDictionary& add(const std::string& key, FoamValue value);

    /// Adds `"pattern" value;`: OpenFOAM matches quoted keys as regular expressions.
    FoamDictionary& add_pattern(const std::string& pattern, FoamValue value);

    /// Adds an entry whose key has no value: `key;`.
    FoamDictionary& add_flag(const std::string& key);

    bool empty() const;
    const std::vector<FoamEntry>& entries() const { return entries_; }

    /// The entries as text, each line indented by `indent` spaces, without enclosing braces. Always the same for the same entries.
    std::string text(std::size_t indent = 0) const;

private:
    FoamDictionary& append(std::string written_key, FoamValue value);
    std::vector<FoamEntry> entries_;
};

/// The value of a key.
class FoamValue {
public:
    FoamValue(double number);  ///< shortest text that reads back as the same number; \throws std::invalid_argument unless finite
    FoamValue(int number);
    FoamValue(std::int64_t number);
    FoamValue(std::size_t number);
    /// `true` or `false`. A template, so that pointers do not turn into it.
    template <class Bool, std::enable_if_t<std::is_same_v<Bool, bool>, int> = 0>
    FoamValue(Bool yes) : plain_(yes ? "true" : "false") {}
    FoamValue(const Vec3& vector);  ///< `(x y z)`
    FoamValue(
        const std::string& word);  ///< one word, unquoted; \throws std::invalid_argument when it is none (paths and phrases: quoted())
    FoamValue(const char* word);
    FoamValue(FoamDictionary dictionary);

    /// `"text"` with quotes and backslashes escaped.
    static FoamValue quoted(const std::string& text);
    /// `(a b c)`; one item per line when that would be too long.
    static FoamValue list(std::vector<FoamValue> items);
    /// list() of anything that can be iterated over.
    template <class Range>
    static FoamValue list_of(const Range& range) {
        return list(std::vector<FoamValue>(std::begin(range), std::end(range)));
    }
    /// Items one after the other: `hex (0 1 2 3) (4 4 4)`, `uniform 0`, `name { ... }`.
    static FoamValue sequence(std::vector<FoamValue> items);
    /// `[kg m s K mol A cd]`.
    static FoamValue dimensions(const std::array<int, 7>& exponents);
    /// Several tokens as they are, for schemes: `Gauss linearUpwind grad(U)`.
    /// \throws std::invalid_argument  when brackets are not balanced, or on a semicolon, brace or line end
    static FoamValue raw(const std::string& tokens);

    bool is_dictionary() const { return kind_ == Kind::dictionary; }

    /// The value as text; lines after the first are indented by `indent` spaces.
    std::string text(std::size_t indent = 0) const;

private:
    enum class Kind { plain, list, sequence, dictionary };
    FoamValue(Kind kind, std::vector<FoamValue> items);
    Kind kind_ = Kind::plain;
    std::string plain_;
    std::vector<FoamValue> items_;
    FoamDictionary dictionary_;
};

struct FoamEntry {
    std::string key;                ///< as written, with quotes for a pattern
    std::vector<FoamValue> values;  ///< one, or none for a flag
};

/// Text of a file with the FoamFile header that OpenFOAM demands.
/// \param foam_class  `dictionary`, `volVectorField`, ...
/// \param object      the file's name
std::string foam_file_text(const std::string& foam_class, const std::string& object, const FoamDictionary& contents);

/// Writes `contents` as the OpenFOAM file `path` (object = its name) and makes its folder.
/// \throws NotWritten
void write_foam_file(const std::filesystem::path& path, const std::string& foam_class, const FoamDictionary& contents);

}  // namespace cutterflow::meshing
