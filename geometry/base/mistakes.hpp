#pragma once
/// \file Collects the rules that an input breaks, so that all of them are reported at once.
#include <cmath>
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

}  // namespace cutterflow
