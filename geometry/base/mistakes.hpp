#pragma once
/// \file Collects the rules that an input breaks, so that all of them are reported at once.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "geometry/base/error.hpp"

namespace cutterflow {

class Mistakes {
public:
    /// \param where  the file, in front of every mistake that does not say where it is
    explicit Mistakes(std::string where = {}) : where_(std::move(where)) {}

    void add(Mistake mistake) {
        if (mistake.where.empty()) mistake.where = where_;
        mistakes_.push_back(std::move(mistake));
    }
    void add(std::string what, std::string rule, std::string remedy) { add({"", std::move(what), std::move(rule), std::move(remedy)}); }
    void add(const std::vector<Mistake>& mistakes) {
        for (const Mistake& mistake : mistakes) add(mistake);
    }
    void require(bool kept, const std::string& what, const std::string& rule, const std::string& remedy) {
        if (!kept) add(what, rule, remedy);
    }
    void require(bool kept, const std::string& key, double value, const std::string& rule, const std::string& remedy) {
        if (!kept) add(fmt::format("{} = {}", key, value), rule, remedy);
    }
    void positive(const std::string& key, double value) {
        require(std::isfinite(value) && value > 0.0, key, value, "It must be above 0", "Correct the value");
    }
    void not_negative(const std::string& key, double value) {
        require(std::isfinite(value) && value >= 0.0, key, value, "It must not be negative", "Correct the value");
    }

    /// Adds what `work()` refuses. \return whether it refused nothing
    template <class Work>
    bool gather(Work work) {
        try {
            work();
            return true;
        } catch (const UserError& error) {
            add(error.mistakes());
            return false;
        }
    }
    bool empty() const { return mistakes_.empty(); }
    std::vector<Mistake> take() { return std::move(mistakes_); }
    /// \throws UserError  with all mistakes, when there are any
    void refuse() {
        if (!mistakes_.empty()) throw UserError(take());
    }

private:
    std::string where_;
    std::vector<Mistake> mistakes_;
};

/// As the user's file has them, from above; those without a line ("file:line") go last.
inline std::vector<Mistake> in_order_of_lines(std::vector<Mistake> mistakes) {
    const auto line_of = [](const Mistake& mistake) {
        const std::size_t colon = mistake.where.rfind(':');
        const std::string digits = colon == std::string::npos ? "" : mistake.where.substr(colon + 1);
        const bool is_line = !digits.empty() && digits.size() < 9 && digits.find_first_not_of("0123456789") == std::string::npos;
        return is_line ? std::stoi(digits) : std::numeric_limits<int>::max();
    };
    std::stable_sort(mistakes.begin(), mistakes.end(), [&](const Mistake& a, const Mistake& b) { return line_of(a) < line_of(b); });
    return mistakes;
}

}  // namespace cutterflow
