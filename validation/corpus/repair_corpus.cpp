/// \file Has every damaged file repaired: a table, a summary, exit code 0 when all files pass. usage: repair_corpus FOLDER [WORD]
#include <algorithm>
#include <iostream>

#include <fmt/format.h>

#include "geometry/base/installation.hpp"
#include "validation/corpus/judge.hpp"

using namespace cutterflow::validation;
namespace fs = std::filesystem;

namespace {

template <class Is>
long count(const std::vector<Verdict>& verdicts, Is&& is) {
    return std::count_if(verdicts.begin(), verdicts.end(), is);
}

void print_summary(const std::vector<Verdict>& verdicts) {
    const auto by_error = [](const Verdict& a, const Verdict& b) { return a.volume_error < b.volume_error; };
    const auto by_time = [](const Verdict& a, const Verdict& b) { return a.core_s < b.core_s; };
    const Verdict& worst = *std::max_element(verdicts.begin(), verdicts.end(), by_error);
    const Verdict& slowest = *std::max_element(verdicts.begin(), verdicts.end(), by_time);
    std::cout << fmt::format(
        "\n{} files: {} repaired, {} refused, {} crashes, {} hangs; {} passed, {} failed\n"
        "worst volume error {:.3g} % ({}); slowest {:.1f} s of processor time ({})\n",
        verdicts.size(), count(verdicts, [](const Verdict& v) { return v.repaired; }),
        count(verdicts, [](const Verdict& v) { return v.refused; }), count(verdicts, [](const Verdict& v) { return v.crashed; }),
        count(verdicts, [](const Verdict& v) { return v.hung; }), count(verdicts, [](const Verdict& v) { return v.passed; }),
        count(verdicts, [](const Verdict& v) { return !v.passed; }), 100.0 * worst.volume_error, worst.name, slowest.core_s, slowest.name);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::cerr << "usage: repair_corpus FOLDER [WORD]\n  FOLDER for the files, WORD in the names of those to run\n";
        return 2;
    }
    const fs::path folder = fs::absolute(argv[1]);
    const std::string word = argc > 2 ? argv[2] : "";
    fs::create_directories(folder);
    std::vector<Verdict> verdicts;
    std::cout << fmt::format("{:<46}{:>10}{:>14}{:>8}  {}\n", "file", "result", "volume error", "s", "");
    for (const DamagedFile& file : damaged_files()) {
        if (file.name.find(word) == std::string::npos) continue;
        const Verdict v = judge(file, cutterflow::installation().programs / "cutterflow", folder);
        const char* result = v.repaired ? "repaired" : v.refused ? "refused" : v.hung ? "HANG" : "CRASH";
        std::cout << fmt::format("{:<46}{:>10}{:>14}{:>8.1f}  {}{}\n", v.name, result,
                                 v.repaired ? fmt::format("{:.2g} %", 100.0 * v.volume_error) : "", v.core_s, v.passed ? "" : "FAILED ",
                                 v.note)
                  << std::flush;
        verdicts.push_back(v);
    }
    if (verdicts.empty()) {
        std::cerr << "no file's name contains " << word << "\n";
        return 2;
    }
    print_summary(verdicts);
    return std::all_of(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return v.passed; }) ? 0 : 4;
}
