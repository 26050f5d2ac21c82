#pragma once
/// \file Mutated files put before the program's own readers, in processes that may die.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace cutterflow::validation {

/// A good file, from which inputs are made.
struct FuzzSeed {
    std::string file;  ///< name in the kind's folder
    std::string content;
};

/// A kind of file and who reads it.
struct FuzzKind {
    std::string name;
    std::vector<FuzzSeed> seeds;
    std::vector<std::string> words;                                   ///< that mean something in these files
    std::function<void(const std::filesystem::path& folder)> around;  ///< writes what the reader needs beside the input; may be empty
    /// Calls the entry functions of the commands on the files of the folder, which throw what the commands throw.
    std::function<void(const std::filesystem::path& folder, const std::string& file)> read;
    double weight = 1.0;  ///< share of the inputs, relative
};

/// Exit code of a process that a sanitizer ended; no importer's process ends so by itself.
inline constexpr int k_sanitizer_exit_code = 86;

/// How an input ended.
enum class FuzzEnd : std::uint8_t {
    untried,
    done,              ///< exit 0
    defect,            ///< exit 1: an exception that is no Failure
    user_input,        ///< exit 2
    external_program,  ///< exit 3
    check_failed,      ///< exit 4
    importer_died,     ///< exit 2 after assimp died in a process of its own
    input_changed,     ///< the file is another than before
    died,              ///< by a signal, a sanitizer or an exit
    hung               ///< beyond its time
};
const char* fuzz_end_name(FuzzEnd end);
bool is_finding(FuzzEnd end);

struct FuzzLimits {
    double core_s = 10.0;                ///< of one input; 10 times that by the clock
    std::size_t memory = 2'000'000'000;  ///< address space of the process [bytes]; 0: none, as AddressSanitizer needs it
};

struct FuzzFinding {
    std::uint64_t index = 0;
    FuzzEnd end = FuzzEnd::untried;
    std::string input;   ///< content of the file
    std::string file;    ///< its name
    std::string output;  ///< last part of what the process wrote
};

struct FuzzCounts {
    std::map<FuzzEnd, std::uint64_t> ends;
    std::vector<FuzzFinding> findings;
};

/// The input of a kind: the same for the same seed and index.
FuzzSeed fuzz_input(const FuzzKind& kind, std::uint64_t seed, std::uint64_t index);

/// Tries the inputs first, first + 1, ... of a kind in forked processes, many in each; a process that dies is replaced for the next input.
/// \param folder    emptied and used; it must not exist or be one of these
/// \param progress  called now and then with the number of inputs done; may be empty
FuzzCounts try_inputs(const FuzzKind& kind, std::uint64_t seed, std::uint64_t first, std::uint64_t count, const FuzzLimits& limits,
                      const std::filesystem::path& folder, const std::function<void(std::uint64_t)>& progress = {});

}  // namespace cutterflow::validation
