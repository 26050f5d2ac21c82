#include "validation/fuzz/mutation.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include <nlohmann/json.hpp>

namespace cutterflow::validation {
namespace {

constexpr std::size_t k_largest = 1'000'000;  // bytes; doubling does not go on beyond it

/// Numbers at and beyond the ends of what programs count and measure with.
const std::vector<std::string> k_extremes{"0",
                                          "-0.0",
                                          "-1",
                                          "1",
                                          "255",
                                          "256",
                                          "65536",
                                          "2147483647",
                                          "2147483648",
                                          "-2147483648",
                                          "4294967295",
                                          "4294967296",
                                          "1e-300",
                                          "1e-6",
                                          "1e300",
                                          "1e999",
                                          "-1e300",
                                          "1e20",
                                          "-1e20",
                                          "nan",
                                          "-nan",
                                          "inf",
                                          "-inf",
                                          "9223372036854775807",
                                          "9223372036854775808",
                                          "18446744073709551616",
                                          "0x7fffffff",
                                          "1.7976931348623157e308",
                                          "5e-324",
                                          "0.1",
                                          "1,5",
                                          "-"};

struct Span {
    std::size_t begin = 0, length = 0;
};

bool is_space(char c) {
    return c == ' ' || c == '\n' || c == '\t' || c == '\r';
}

/// What stands between spaces, and between the marks of CSV, JSON and TOML.
std::vector<Span> words_of(const std::string& text) {
    const std::string marks = ",:[]{}\"=";
    std::vector<Span> found;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t end = at;
        while (end < text.size() && !is_space(text[end]) && marks.find(text[end]) == std::string::npos) ++end;
        if (end > at) found.push_back({at, end - at});
        at = end + 1;
    }
    return found;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines(1);
    for (const char c : text) {
        lines.back() += c;
        if (c == '\n') lines.emplace_back();
    }
    return lines;
}

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += line;
    return text;
}

Span any_piece(const std::string& text, FuzzDice& dice) {
    const std::size_t begin = dice.below(text.size());
    return {begin, 1 + dice.below(std::min<std::size_t>(64, text.size() - begin))};
}

void change_byte(std::string& text, FuzzDice& dice) {
    char& byte = text[dice.below(text.size())];
    byte = dice.below(2) == 0 ? static_cast<char>(byte ^ (1 << dice.below(8))) : static_cast<char>(dice.below(256));
}

void leave_out_piece(std::string& text, FuzzDice& dice) {
    const Span piece = any_piece(text, dice);
    text.erase(piece.begin, piece.length);
}

void double_piece(std::string& text, FuzzDice& dice) {
    const Span piece = any_piece(text, dice);
    text.insert(dice.below(text.size()), text.substr(piece.begin, piece.length));
}

void change_lines(std::string& text, FuzzDice& dice) {
    std::vector<std::string> lines = lines_of(text);
    const std::size_t from = dice.below(lines.size()), to = dice.below(lines.size());
    switch (dice.below(3)) {
        case 0:
            lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(from));
            break;
        case 1:
            lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(to), std::string(lines[from]));
            break;
        default:
            std::swap(lines[from], lines[to]);
    }
    text = joined(lines);
}

std::string any_word(const std::string& text, const std::vector<Span>& found, const std::vector<std::string>& words, FuzzDice& dice) {
    const std::size_t source = dice.below(3);
    if (source == 0 && !words.empty()) return words[dice.below(words.size())];
    if (source == 1) return k_extremes[dice.below(k_extremes.size())];
    const Span word = found[dice.below(found.size())];
    return text.substr(word.begin, word.length);
}

void change_word(std::string& text, const std::vector<std::string>& words, FuzzDice& dice) {
    const std::vector<Span> found = words_of(text);
    if (found.empty()) return;
    const Span place = found[dice.below(found.size())];
    const std::string word = any_word(text, found, words, dice);
    text.replace(place.begin, dice.below(4) == 0 ? 0 : place.length, word);
}

/// Counts and coordinates of binary files.
void change_number_of_bytes(std::string& text, FuzzDice& dice) {
    static const std::array<std::uint64_t, 9> patterns{0,
                                                       1,
                                                       0xffffffffull,
                                                       0x7fffffffull,
                                                       0x7fc000007fc00000ull,
                                                       0x7f8000007f800000ull,
                                                       0x0800000000000000ull,
                                                       0xffffffffffffffffull,
                                                       0x7fefffffffffffffull};
    const std::size_t length = dice.below(2) == 0 ? 4 : 8;
    if (text.size() < length) return;
    const std::size_t at = dice.below(text.size() / 4) * 4;
    const std::uint64_t value = patterns[dice.below(patterns.size())];
    for (std::size_t i = 0; i < length && at + i < text.size(); ++i) text[at + i] = static_cast<char>(value >> (8 * i));
}

/// Every value of a document: the root, then what it holds.
void collect(nlohmann::json& value, std::vector<nlohmann::json*>& found) {
    found.push_back(&value);
    if (value.is_structured())
        for (nlohmann::json& item : value) collect(item, found);
}

/// A value of another kind or beyond a range, or one of the document's own.
nlohmann::json any_value(const std::vector<nlohmann::json*>& found, FuzzDice& dice) {
    static const std::vector<nlohmann::json> values{nullptr,
                                                    true,
                                                    0,
                                                    -1,
                                                    2.5,
                                                    2147483648,
                                                    -2147483649,
                                                    18446744073709551615ull,
                                                    1e300,
                                                    -1e300,
                                                    5e-324,
                                                    "",
                                                    "text",
                                                    nlohmann::json::array(),
                                                    nlohmann::json::array({1}),
                                                    nlohmann::json::object(),
                                                    nlohmann::json::object({{"name", "text"}})};
    return dice.below(4) == 0 ? *found[dice.below(found.size())] : values[dice.below(values.size())];
}

/// Changes, leaves out or doubles a value of a JSON document, which stays one. \return whether the text is a document
bool change_json(std::string& text, FuzzDice& dice) {
    nlohmann::json document = nlohmann::json::parse(text, nullptr, false);
    if (!document.is_structured()) return false;
    std::vector<nlohmann::json*> found;
    collect(document, found);
    nlohmann::json& value = *found[dice.below(found.size())];
    const std::size_t how = value.empty() || !value.is_structured() ? 0 : dice.below(3);
    if (how == 0)
        value = nlohmann::json(any_value(found, dice));
    else if (how == 1)
        value.erase(std::next(value.begin(), static_cast<std::ptrdiff_t>(dice.below(value.size()))));
    else if (value.is_array())
        value.push_back(nlohmann::json(value[dice.below(value.size())]));
    text = document.dump(1, ' ', false, nlohmann::json::error_handler_t::replace);
    return true;
}

void change(std::string& text, const std::string& other, const std::vector<std::string>& words, FuzzDice& dice) {
    if (text.empty()) {
        text = other.substr(0, dice.below(other.size() + 1));
        return;
    }
    if (text.front() == '{' && dice.below(2) == 0 && change_json(text, dice)) return;
    switch (dice.below(16)) {
        case 0:
            text.resize(dice.below(text.size()));
            break;
        case 1:
            leave_out_piece(text, dice);
            break;
        case 2:
            double_piece(text, dice);
            break;
        case 3:
            text = text.substr(0, dice.below(text.size() + 1)) + other.substr(dice.below(other.size() + 1));
            break;
        case 4:
        case 5:
            change_number_of_bytes(text, dice);
            break;
        case 6:
        case 7:
        case 8:
            change_byte(text, dice);
            break;
        case 9:
        case 10:
            change_lines(text, dice);
            break;
        default:
            change_word(text, words, dice);
    }
}

std::uint64_t hash_of(const std::string& text) {  // FNV-1a
    std::uint64_t hash = 14695981039346656037ull;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
    return hash;
}

}  // namespace

FuzzDice::FuzzDice(std::uint64_t seed, const std::string& kind, std::uint64_t index) {
    const std::uint64_t name = hash_of(kind);
    std::seed_seq sequence{static_cast<std::uint32_t>(seed),  static_cast<std::uint32_t>(seed >> 32),
                           static_cast<std::uint32_t>(name),  static_cast<std::uint32_t>(name >> 32),
                           static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32)};
    engine_.seed(sequence);
}

std::string mutated(const std::string& content, const std::string& other, const std::vector<std::string>& words, FuzzDice& dice) {
    std::string text = content;
    for (std::size_t left = 1 + dice.below(4); left > 0; --left) change(text, other, words, dice);
    if (text.size() > k_largest) text.resize(k_largest);
    return text;
}

}  // namespace cutterflow::validation
