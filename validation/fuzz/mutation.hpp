#pragma once
/// \file Files as damage, editors and wrong programs leave them: changes at random places, the same for the same seed.
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace cutterflow::validation {

/// Whole numbers below a bound, the same with every standard library.
class FuzzDice {
public:
    /// \param seed   of the whole run
    /// \param kind   name of the kind of file
    /// \param index  of the input
    FuzzDice(std::uint64_t seed, const std::string& kind, std::uint64_t index);
    std::size_t below(std::size_t bound) { return engine_() % bound; }

private:
    std::mt19937_64 engine_;
};

/// A copy of `content` with one to four changes: a bit or a byte, a cut, a piece left out or doubled, a line left out, doubled or moved, a
/// word replaced by another of the file or by one of `words` or by an extreme number, a word put in, the head of one file with the tail of
/// another. Every second change of a JSON document leaves one: a value becomes another, is left out or doubled.
/// \param other  a second file of the kind, for the last one
/// \param words  that mean something in files of the kind
std::string mutated(const std::string& content, const std::string& other, const std::vector<std::string>& words, FuzzDice& dice);

}  // namespace cutterflow::validation
